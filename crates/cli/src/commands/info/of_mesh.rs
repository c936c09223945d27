//! What a mesh encloses, if anything.

use cloudtouch::geom::TriangleMesh;
use cloudtouch::{Mesh, PrepareError};

use crate::load::SUSPICIOUS_MESH_SIZE;

use super::triple::triple;

pub(super) fn describe_mesh(mesh: &TriangleMesh) -> String {
    let merged = mesh.merged().without_repeats();
    let open = merged.open_edges();
    let prepared = Mesh::prepare(mesh);
    let closed = match prepared {
        Err(error @ PrepareError::CoordinateRange { .. }) => format!("refused: {error}"),
        Err(_) => "none: no triangle has an area, nothing collides with it".to_owned(),
        Ok(mesh) if mesh.is_watertight() => "watertight: inside and outside are defined".to_owned(),
        Ok(_) if open == 0 => {
            "closed, but part of it encloses no volume; only its surface collides".to_owned()
        }
        Ok(mesh) if mesh.is_closed() => format!(
            "closed: inside and outside are defined; its parts touch along {open} edges that join more than two \
             triangles"
        ),
        Ok(mesh) if mesh.has_solids() => format!(
            "partly closed: what its closed parts enclose is inside; of the rest, with {open} edges that do not \
             join two triangles, only the surface collides"
        ),
        Ok(_) => format!("open: {open} edges do not join two triangles; only its surface collides"),
    };
    let mut lines = vec![
        format!(
            "triangles   {} over {} vertices ({} after merging)",
            mesh.triangles().len(),
            mesh.vertices().len(),
            merged.vertices().len()
        ),
        format!("surface     {closed}"),
    ];
    if let Some((low, high)) = mesh.bounding_box() {
        lines.push(format!("box         {} to {} m", triple(&low), triple(&high)));
        if (high - low).norm() > SUSPICIOUS_MESH_SIZE {
            lines.push("unit        hundreds of metres across: --unit mm?".to_owned());
        }
    }
    lines.join("\n")
}
