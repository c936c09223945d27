//! Families of real meshes, where the files are at hand.

use std::{error::Error, fs::File, io::BufReader, path::Path};

use cloudtouch_geom::{Point3, TriangleMesh};
use cloudtouch_testkit::{
    exact::Touch,
    family::{Family, Real, RealMeshes},
};

fn stl(path: &Path) -> Result<TriangleMesh, Box<dyn Error>> {
    let mesh = stl_io::read_stl(&mut BufReader::new(File::open(path)?))?;
    let vertices = mesh.vertices.iter().map(|v| Point3::from(v.0.map(f64::from))).collect();
    let triangles = mesh.faces.iter().map(|f| f.vertices.map(|i| i as u32)).collect();
    Ok(TriangleMesh::new(vertices, triangles)?)
}

fn obj(path: &Path) -> Result<TriangleMesh, Box<dyn Error>> {
    let (models, _) = tobj::load_obj(path, &tobj::GPU_LOAD_OPTIONS)?;
    let [model] = models.as_slice() else { return Err("more models than one".into()) };
    let corners = model.mesh.positions.chunks(3);
    let vertices = corners.map(|v| Point3::from([v[0], v[1], v[2]].map(f64::from))).collect();
    let triangles = model.mesh.indices.chunks(3).map(|t| [t[0], t[1], t[2]]).collect();
    Ok(TriangleMesh::new(vertices, triangles)?.merged())
}

fn meshes(folder: &Path) -> Result<RealMeshes, Box<dyn Error>> {
    Ok(RealMeshes {
        piano: stl(&folder.join("piano_m.stl"))?,
        room: stl(&folder.join("room_m.stl"))?,
        pr2_gripper: stl(&folder.join("pr2_gripper_lowres.stl"))?,
        panda_hand: obj(&folder.join("panda_hand.obj"))?,
    })
}

#[test]
fn names_are_unlike_one_another() {
    let real = Real::ALL.iter().map(|r| r.name());
    let mut names: Vec<&str> = Family::ALL.iter().map(|f| f.name()).chain(real).collect();
    names.sort_unstable();
    let all = names.len();
    names.dedup();
    assert_eq!(names.len(), all);
}

#[test]
fn real_bodies_meet_ours_and_one_another() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/meshes");
    if !folder.is_dir() {
        println!("skipped: there are no real meshes in {}", folder.display());
        return;
    }
    let meshes = meshes(&folder).unwrap();
    for &real in Real::ALL {
        let scene = real.scene(&meshes, 1);
        let closed = [&scene.a, &scene.b].map(|body| body.mesh().open_edges() == 0);
        assert!(scene.touch == Touch::Surfaces || closed == [true; 2], "{real:?} is open");
        let poses = scene.poses(8, 1);
        assert_eq!(poses.iter().filter(|p| p.in_collision).count(), 4, "{real:?}");
        for pose in poses {
            let place = &pose.scene_from_object;
            assert_eq!(pose.in_collision, scene.a.touches(&scene.b, place, scene.touch));
        }
    }
}
