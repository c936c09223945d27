//! How large the files of a robot may be, and how they are encoded.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::Arm;
use cloudtouch_io::{ReadLimits, write_mesh_obj};
use cloudtouch_robot::{Robot, RobotError};
use cloudtouch_testkit::scene::cuboid;

const MESH: &str = "<robot name='r'><link name='a'><collision><geometry><mesh filename='cube.obj'/>\
    </geometry></collision></link></robot>";

/// Only the meshes were held to the limits: a URDF or SRDF without end filled the memory.
#[test]
fn descriptions_are_held_to_the_limit_on_bytes_as_their_meshes_are() {
    let arm = Arm::default();
    let [urdf, srdf] = ["r.urdf", "r.srdf"].map(|name| arm.path(name));
    std::fs::write(&urdf, MESH).unwrap();
    write_mesh_obj(arm.path("cube.obj"), &cuboid([0.1; 3])).unwrap();
    let of = |bytes: usize, triangles: usize| {
        let limits = ReadLimits { bytes: bytes as u64, triangles, ..ReadLimits::default() };
        Robot::from_urdf_within(&urdf, &[], &limits)
    };
    let told = |found: Result<Robot, RobotError>| found.unwrap_err().to_string();
    let error = told(of(MESH.len() - 1, 12));
    assert!(
        error.contains("r.urdf: has more than") && error.contains("raise the limit"),
        "{error}"
    );
    let size = std::fs::metadata(arm.path("cube.obj")).unwrap().len() as usize;
    assert!(size > MESH.len(), "the mesh is the larger of the two");
    let error = told(of(size - 1, 12));
    assert!(error.contains("link `a`") && error.contains("cube.obj: has more than"), "{error}");
    let error = told(of(size, 11));
    assert!(error.contains("cube.obj") && error.contains("11"), "{error}");
    let robot = of(size, 12).unwrap();
    std::fs::write(&srdf, "<robot name='r'/>").unwrap();
    let limits = ReadLimits { bytes: 16, ..ReadLimits::default() };
    let error = told(robot.clone().with_srdf_within(&srdf, &limits));
    assert!(error.contains("r.srdf: has more than 16 bytes"), "{error}");
    assert!(robot.with_srdf(&srdf).is_ok());
}

/// It was told that a stream has no valid UTF-8, and neither where nor what to do.
#[test]
fn a_description_in_another_encoding_is_told_with_its_place() {
    let arm = Arm::default();
    let urdf = arm.path("r.urdf");
    std::fs::write(&urdf, b"<robot name='b\xfcro'/>").unwrap();
    let error = Robot::from_urdf(&urdf, &[]).unwrap_err().to_string();
    assert!(error.contains("from byte 14 on") && error.contains("save it as UTF-8"), "{error}");
}
