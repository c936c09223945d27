//! Robots that others describe: every URDF in the folder that CLOUDTOUCH_ROBOTS names, or in
//! target/robots, where unpacked packages may lie. Skipped where there is none.
#![allow(clippy::unwrap_used, reason = "tests")]

mod support;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use cloudtouch::geom::Pose;
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, CloudSettings, Verdict};
use cloudtouch_robot::{Joint, Robot, RobotChecker, RobotFault, Touching};
use support::{query, wall};

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
    joints.iter().filter(|joint| joint.is_free()).map(|joint| (joint.name.clone(), at(joint))).collect()
}

/// Each is read or refused with a reason that names its remedy; what is read can be asked, and is free
/// of a wall 5 m away.
#[test]
fn real_robots_are_read_and_asked_or_refused_with_the_reason() {
    let usual = concat!(env!("CARGO_MANIFEST_DIR"), "/../../target/robots").to_owned();
    let folder = std::env::var("CLOUDTOUCH_ROBOTS").unwrap_or(usual);
    let mut paths = Vec::new();
    urdfs(Path::new(&folder), &mut paths);
    if paths.is_empty() {
        println!("skipped: no .urdf in {folder}; unpack one such as the wheel example-robot-data there");
        return;
    }
    paths.sort();
    let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
    let (mut read, mut collada) = (0, 0);
    let mut others = Vec::new();
    for path in &paths {
        let robot = match Robot::from_urdf(path, &[]) {
            Ok(robot) => robot,
            Err(error) => {
                match error.fault {
                    RobotFault::Collada { .. } => collada += 1,
                    _ => others.push(error.to_string()),
                }
                continue;
            }
        };
        let joints = rest(robot.joints());
        let cloud = Body::from(Cloud::prepare(&wall(5.0), &settings).unwrap());
        let checker = RobotChecker::new(robot, cloud, Pose::identity(), Touching::Surroundings).unwrap();
        match checker.check(&query(), &joints) {
            Ok(found) => assert_eq!(found.verdict(), Verdict::Free, "{}: {found:?}", path.display()),
            Err(error) => {
                others.push(format!("{}: at rest: {error}", path.display()));
                continue;
            }
        }
        read += 1;
    }
    println!("{read} of {} read and asked; {collada} have .dae; others:", paths.len());
    others.iter().for_each(|reason| println!("  {reason}"));
    assert!(read > 0, "none of {} robots in {folder} could be read", paths.len());
}
