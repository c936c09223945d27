//! What to do with a file that is not read.

/// By the extension, in lower case, as the end of a sentence.
pub(crate) fn remedy(extension: &str) -> &'static str {
    match extension {
        "npy" | "npz" => {
            "write its points as text (`numpy.savetxt(\"scan.xyz\", points)`), or give the array in Python"
        }
        "las" | "laz" | "e57" => "convert it to .ply or .pcd with CloudCompare or PDAL",
        "glb" | "gltf" | "dae" | "3mf" => {
            "convert it to .stl, .obj or .ply with MeshLab, assimp or trimesh"
        }
        "step" | "stp" | "iges" | "igs" => "export it as .stl from a CAD program such as FreeCAD",
        "png" => {
            "a depth image is read with the intrinsics of its camera; in Python give points of rows x columns x 3"
        }
        "tif" | "tiff" | "exr" | "pgm" => {
            "save a depth image as a 16-bit greyscale .png, which is read with the intrinsics of its camera"
        }
        "jpg" | "jpeg" | "bmp" | "webp" => {
            "a picture has no depths: give the depth image itself, a 16-bit greyscale .png"
        }
        "db3" | "bag" => "convert it to .mcap, and name a scan of it, such as run.mcap#/points@1.5",
        "json" | "toml" | "yaml" => {
            "it is neither a cloud nor a mesh: give the files that it names"
        }
        "urdf" | "srdf" | "xacro" => {
            "it is a whole robot: give a mesh of one link, or ask about the robot"
        }
        "asc" | "pts" | "xyzn" | "xyzrgb" | "tsv" | "dat" => {
            "rename it to .xyz if each of its lines is a point, and convert it otherwise"
        }
        "obj" | "stl" => "it is a mesh: read it as one, in Python with `Mesh.read`",
        "pcd" | "xyz" | "txt" | "csv" => {
            "it is a cloud: read it as one, in Python with `Cloud.read`"
        }
        "vtk" | "vtp" | "vtu" => "export it as .ply or .csv from ParaView",
        "" => "give it the extension of its format",
        _ => "convert it",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_binary_file_is_not_told_to_be_renamed() {
        for extension in
            ["npy", "las", "e57", "glb", "step", "png", "tiff", "jpg", "db3", "json", "urdf", "dae"]
        {
            let remedy = remedy(extension);
            assert!(!remedy.contains("rename") && remedy != "convert it", "{extension}: {remedy}");
        }
        assert!(remedy("asc").contains("rename it to .xyz"));
    }
}
