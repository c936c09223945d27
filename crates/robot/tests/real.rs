//! Robots that others describe: every URDF in the folder that CLOUDTOUCH_ROBOTS names, or in
//! target/robots, where unpacked packages may lie. Skipped where there is none.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::path::{Path, PathBuf};

use crate::support::{query, wall};
use cloudtouch::geom::{Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, CloudSettings, Undecided};
use cloudtouch_robot::{Joint, Robot, RobotChecker, RobotFault, Touching};
use nalgebra::{Matrix4, matrix};

fn urdfs(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            urdfs(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "urdf") {
            found.push(path);
        }
    }
}

/// At zero, or as near to it as its limits allow.
fn rest(joints: &[Joint]) -> BTreeMap<String, f64> {
    let at = |joint: &Joint| joint.limits.map_or(0.0, |[low, high]| 0.0_f64.clamp(low, high));
    joints
        .iter()
        .filter(|joint| joint.is_free())
        .map(|joint| (joint.name.clone(), at(joint)))
        .collect()
}

/// The folder to look in, and what is there.
fn robots() -> (String, Vec<PathBuf>) {
    let usual = concat!(env!("CARGO_MANIFEST_DIR"), "/../../target/robots").to_owned();
    let folder = std::env::var("CLOUDTOUCH_ROBOTS").unwrap_or(usual);
    let mut paths = Vec::new();
    urdfs(Path::new(&folder), &mut paths);
    paths.sort();
    (folder, paths)
}

/// Where the maker's table of Denavit-Hartenberg parameters puts the flange of a Panda that is ready.
#[test]
fn the_flange_of_a_panda_is_where_its_maker_says() {
    let (folder, paths) = robots();
    let Some(path) = paths.iter().find(|path| path.ends_with("panda_description/urdf/panda.urdf"))
    else {
        println!("skipped: no panda_description/urdf/panda.urdf in {folder}");
        return;
    };
    let robot = Robot::from_urdf(path, &[]).unwrap();
    let ready = [0.0, -FRAC_PI_4, 0.0, -3.0 * FRAC_PI_4, 0.0, FRAC_PI_2, FRAC_PI_4];
    let mut joints = rest(robot.joints());
    for (k, angle) in ready.into_iter().enumerate() {
        joints.insert(format!("panda_joint{}", k + 1), angle);
    }
    // a, d, alpha of each frame against the one before (Craig), m and rad.
    let table = [
        [0.0, 0.333, 0.0],
        [0.0, 0.0, -FRAC_PI_2],
        [0.0, 0.316, FRAC_PI_2],
        [0.0825, 0.0, FRAC_PI_2],
        [-0.0825, 0.384, -FRAC_PI_2],
        [0.0, 0.0, FRAC_PI_2],
        [0.088, 0.0, FRAC_PI_2],
    ];
    let mut flange = Matrix4::<f64>::identity();
    for ([a, d, alpha], theta) in table.into_iter().zip(ready) {
        let ((sa, ca), (st, ct)) = (alpha.sin_cos(), theta.sin_cos());
        flange *= matrix![
            ct, -st, 0.0, a;
            st * ca, ct * ca, -sa, -d * sa;
            st * sa, ct * sa, ca, d * ca;
            0.0, 0.0, 0.0, 1.0
        ];
    }
    flange *= Matrix4::new_translation(&Vector3::new(0.0, 0.0, 0.107));
    let found = robot.link_poses(&joints).unwrap()["panda_link8"].isometry().to_homogeneous();
    // URDFs write right angles with few digits.
    assert!((found - flange).amax() < 1e-3, "{found}{flange}");
}

/// Each is read or refused with a reason that names its remedy; what is read can be asked, and is free
/// of a wall 5 m away.
#[test]
fn real_robots_are_read_and_asked_or_refused_with_the_reason() {
    let (folder, paths) = robots();
    if paths.is_empty() {
        println!(
            "skipped: no .urdf in {folder}; unpack one such as the wheel example-robot-data there"
        );
        return;
    }
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
    let (mut read, mut collada, mut tiny) = (0, 0, 0);
    let mut others = Vec::new();
    for path in &paths {
        let robot = match Robot::from_urdf(path, &[]) {
            Ok(robot) => robot,
            Err(error) => {
                match *error.fault {
                    RobotFault::Collada { .. } => collada += 1,
                    _ => others.push(error.to_string()),
                }
                continue;
            }
        };
        let joints = rest(robot.joints());
        let cloud = Body::from(Cloud::prepare(&wall(5.0), &settings).unwrap());
        let checker =
            RobotChecker::new(robot, cloud, Pose::identity(), Touching::Surroundings).unwrap();
        match checker.check(&query(), &joints) {
            Ok(found) => {
                for pair in &found.pairs {
                    // A link of a millimetre fits between the points of the wall, which is said.
                    let by = pair.answer.as_ref().unwrap().undecided_by;
                    assert_eq!(by, Some(Undecided::Sparse), "{}: {pair:?}", path.display());
                    tiny += 1;
                }
            }
            Err(error) => {
                others.push(format!("{}: at rest: {error}", path.display()));
                continue;
            }
        }
        read += 1;
    }
    println!(
        "{read} of {} read and asked, {tiny} links too small to be decided; {collada} have .dae; others:",
        paths.len()
    );
    others.iter().for_each(|reason| println!("  {reason}"));
    assert!(read > 0, "none of {} robots in {folder} could be read", paths.len());
}
