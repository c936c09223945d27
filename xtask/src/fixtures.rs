//! `cargo xtask fixtures`: small generated scenes, the same bytes from the same seed.
//!
//! Coordinates are rounded to 0.1 mm and answers to 0.01 mm, so that the last bits in which
//! platforms differ do not reach the files; answers hold for the files as rounded.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use cloudtouch_evaluation::SEED;
use cloudtouch_geom::{Point3, Pose, TriangleMesh, seed};
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::poses::{LabelledPose, label, poses_near_contact};
use cloudtouch_testkit::scene;
use cloudtouch_testkit::surface::sample_surface;
use serde::Serialize;

use crate::tidy;

const COMMAND: &str = "cargo xtask fixtures";
/// Standard deviation of the clouds' noise, m; the cases state it as the sensor.
const NOISE: f64 = 0.002;
const SENSOR: &str = "iso:0.002";
/// The signed distances wanted of the cases, m: from clearly free to deep.
const WANTED: [f64; 12] =
    [0.3, 0.2, 0.1, 0.05, 0.025, 0.01, -0.01, -0.025, -0.05, -0.07, -0.09, -0.12];

/// The folders that hold nothing but what this task makes, and pages that describe it.
const FOLDERS: [&str; 2] = ["fixtures/piano-room", DEMO_FOLDER];
/// The tool carries a copy of the files of its demo: a package holds only what is below it.
const DEMO_FOLDER: &str = "crates/cli/demo";
const OF_DEMO: [&str; 3] = ["cases.json", "piano.pcd", "room.pcd"];

/// File contents by path in the project.
type Files = BTreeMap<String, Vec<u8>>;

/// Makes every file, and writes it or, to check, fails unless the stored files are the same, bit for
/// bit, and there are no others.
pub(crate) fn run(root: &Path, check: bool) -> Result<()> {
    let files = generate()?;
    if check { compare(root, &files) } else { store(root, &files) }
}

fn store(root: &Path, files: &Files) -> Result<()> {
    for (path, bytes) in files {
        let path = root.join(path);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).with_context(|| format!("make {}", folder.display()))?;
        }
        fs::write(&path, bytes).with_context(|| format!("write {}", path.display()))?;
        println!("{:>8} bytes  {}", bytes.len(), path.display());
    }
    Ok(())
}

fn compare(root: &Path, files: &Files) -> Result<()> {
    let mut wrong = Vec::new();
    for (path, bytes) in files {
        match fs::read(root.join(path)) {
            Ok(stored) if stored == *bytes => {}
            Ok(_) => wrong.push(format!("{path} differs")),
            Err(error) => wrong.push(format!("{path}: {error}")),
        }
    }
    for folder in FOLDERS {
        for path in tidy::files(root, &root.join(folder))? {
            if !files.contains_key(&path) && !path.ends_with("/README.md") {
                wrong.push(format!("{path} is not made by this task"));
            }
        }
    }
    let wrong = wrong.join("; ");
    ensure!(wrong.is_empty(), "{wrong}; run `{COMMAND}` and commit the result");
    println!("fixtures: {} files as stored", files.len());
    Ok(())
}

fn generate() -> Result<Files> {
    let room = rounded_mesh(&scene::room())?;
    let piano = rounded_mesh(&scene::piano())?;
    let mut files = Files::new();
    let mut add = |name: &str, bytes: Vec<u8>| {
        if OF_DEMO.contains(&name) {
            files.insert(format!("{DEMO_FOLDER}/{name}"), bytes.clone());
        }
        files.insert(format!("fixtures/piano-room/{name}"), bytes);
    };
    add("room.obj", obj("room", &room));
    add("piano.obj", obj("piano", &piano));
    // The outer faces of walls and floor are not in the cloud: no sensor in the room sees them.
    let inside = |p: &Point3| p.x.abs() < 2.6 && p.y.abs() < 2.1 && p.z > -0.05;
    add("room.pcd", pcd(&noisy(&room, 54_000, 1, inside)));
    add("piano.pcd", pcd(&noisy(&piano, 9_000, 2, |_| true)));
    let mut text = serde_json::to_vec_pretty(&cases(&room, &piano)?)?;
    text.push(b'\n');
    add("cases.json", text);
    Ok(files)
}

/// Points of the surface that pass the test, with noise.
fn noisy(
    mesh: &TriangleMesh,
    count: usize,
    stream: u64,
    keep: impl Fn(&Point3) -> bool,
) -> Vec<Point3> {
    let samples = sample_surface(mesh, count, seed::derive(SEED, stream, 0));
    let kept: Vec<_> = samples.iter().map(|s| s.position).filter(keep).collect();
    add_noise(&kept, NoiseKind::Gaussian, NOISE, seed::derive(SEED, stream, 1))
}

/// The case file of the tool, with the exact answers as further fields.
#[derive(Serialize)]
struct CaseFile {
    format: u32,
    length_unit: &'static str,
    pose: &'static str,
    signed_distance: &'static str,
    cases: Vec<Case>,
}

#[derive(Serialize)]
struct Case {
    id: String,
    scene: &'static str,
    object: &'static str,
    scene_sensor: &'static str,
    object_sensor: &'static str,
    pose: [[f64; 4]; 4],
    scene_mesh: &'static str,
    object_mesh: &'static str,
    in_collision: bool,
    signed_distance_m: f64,
}

/// For each distance wanted the nearest of many random poses that is not taken yet.
fn cases(room: &TriangleMesh, piano: &TriangleMesh) -> Result<CaseFile> {
    let (room, piano) = (ExactMesh::new(room), ExactMesh::new(piano));
    let mut drawn = poses_near_contact(&room, &piano, 100, seed::derive(SEED, 3, 0));
    let mut cases = Vec::new();
    for (i, wanted) in WANTED.into_iter().enumerate() {
        let off = |p: &LabelledPose| (p.signed_distance - wanted).abs();
        drawn.sort_by(|p, q| off(q).total_cmp(&off(p)));
        let nearest = drawn.pop().context("more cases are wanted than poses drawn")?;
        cases.push(case(format!("piano-room-{:02}", i + 1), &room, &piano, &nearest)?);
    }
    Ok(CaseFile {
        format: 1,
        length_unit: "m",
        pose: "4x4 row-major, maps object coordinates to scene coordinates",
        signed_distance: "between the meshes: distance when free, in overlap minus an upper bound \
                          on the penetration depth",
        cases,
    })
}

fn case(id: String, room: &ExactMesh, piano: &ExactMesh, drawn: &LabelledPose) -> Result<Case> {
    let matrix = drawn.scene_from_object.isometry().to_homogeneous().map(|v| rounded(v, 1e9));
    // What is true of the pose as it is in the file.
    let truth = label(room, piano, &Pose::try_from_matrix(&matrix)?);
    Ok(Case {
        id,
        scene: "room.pcd",
        object: "piano.pcd",
        scene_sensor: SENSOR,
        object_sensor: SENSOR,
        pose: std::array::from_fn(|row| std::array::from_fn(|column| matrix[(row, column)])),
        scene_mesh: "room.obj",
        object_mesh: "piano.obj",
        in_collision: truth.in_collision,
        signed_distance_m: rounded(truth.signed_distance, 1e5),
    })
}

/// To a multiple of 1/`per_unit`; never −0.
fn rounded(value: f64, per_unit: f64) -> f64 {
    (value * per_unit).round() / per_unit + 0.0
}

/// The mesh with coordinates as the file has them.
fn rounded_mesh(mesh: &TriangleMesh) -> Result<TriangleMesh> {
    let vertices = mesh.vertices().iter().map(|p| p.map(|v| rounded(v, 1e4))).collect();
    Ok(TriangleMesh::new(vertices, mesh.triangles().to_vec())?)
}

/// A Wavefront OBJ file.
fn obj(name: &str, mesh: &TriangleMesh) -> Vec<u8> {
    let mut text = format!("# Made by `{COMMAND}`; metres, z up.\no {name}\n");
    for p in mesh.vertices() {
        text += &format!("v {:.4} {:.4} {:.4}\n", p.x, p.y, p.z);
    }
    for t in mesh.triangles() {
        let [a, b, c] = t.map(|i| i + 1);
        text += &format!("f {a} {b} {c}\n");
    }
    text.into_bytes()
}

/// A binary PCD file of single-precision coordinates, rounded to 0.1 mm before.
fn pcd(points: &[Point3]) -> Vec<u8> {
    let n = points.len();
    let header = format!(
        "# .PCD v0.7 - made by `{COMMAND}`; metres, z up\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\n\
         TYPE F F F\nCOUNT 1 1 1\nWIDTH {n}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {n}\n\
         DATA binary\n"
    );
    let mut bytes = header.into_bytes();
    for value in points.iter().flat_map(|p| p.iter()) {
        bytes.extend((rounded(*value, 1e4) as f32).to_le_bytes());
    }
    bytes
}

#[cfg(test)]
mod tests {
    use std::sync::LazyLock;

    use super::*;

    /// Made once for all tests.
    static FILES: LazyLock<Files> = LazyLock::new(|| generate().unwrap());

    #[test]
    fn fixtures_are_small_closed_and_run_from_free_to_deep() {
        let once = FILES.iter().filter(|(path, _)| path.starts_with("fixtures/"));
        let total: usize = once.map(|(_, bytes)| bytes.len()).sum();
        assert!(total < 600_000, "{total} bytes");
        for mesh in [scene::room(), scene::piano()] {
            assert_eq!(rounded_mesh(&mesh).unwrap().merged().open_edges(), 0);
        }
        let cases: serde_json::Value =
            serde_json::from_slice(&FILES["fixtures/piano-room/cases.json"]).unwrap();
        let cases = cases["cases"].as_array().unwrap();
        assert_eq!(cases.len(), WANTED.len());
        for (case, wanted) in cases.iter().zip(WANTED) {
            let distance = case["signed_distance_m"].as_f64().unwrap();
            assert_eq!(case["in_collision"].as_bool().unwrap(), distance < 0.0);
            assert!((distance - wanted).abs() < 0.3 * wanted.abs(), "{distance} for {wanted}");
        }
    }

    #[test]
    fn a_changed_missing_or_stray_file_is_named() {
        let root = std::env::temp_dir().join(format!("xtask-fixtures-{}", std::process::id()));
        store(&root, &FILES).unwrap();
        compare(&root, &FILES).unwrap();
        fs::write(root.join("fixtures/piano-room/room.obj"), "v 0 0 0\n").unwrap();
        fs::remove_file(root.join("fixtures/piano-room/cases.json")).unwrap();
        fs::write(root.join("fixtures/piano-room/notes.txt"), "").unwrap();
        fs::write(root.join("crates/cli/demo/room.pcd"), "").unwrap();
        let error = compare(&root, &FILES).unwrap_err().to_string();
        fs::remove_dir_all(&root).unwrap();
        for part in [
            "room.obj differs",
            "cases.json: ",
            "notes.txt is not made",
            "crates/cli/demo/room.pcd differs",
        ] {
            assert!(error.contains(part), "{error}");
        }
    }
}
