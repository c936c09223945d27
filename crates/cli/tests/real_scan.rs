//! A gripper at a mug in a real stereo scan, where the scan is there.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::path::Path;

use crate::support::Inputs;

/// Poses of the gripper (object to scene): 5.7 cm from the nearest point of the scan, 6 % of it outside
/// of what was measured, and with 6,474 of its points inside, up to 2.3 cm deep.
const FREE: &str = "\
    0.035338976 -0.510634671 -0.859071237 0.034550849 \
    0.510634671 0.748152274 -0.423698487 -0.125962708 \
    0.859071237 -0.423698487 0.287186703 0.486818557 \
    0.0 0.0 0.0 1.0";
const COLLISION: &str = "\
    -0.330152165 -0.57679854 -0.747196756 -0.06028067 \
    -0.875058017 0.483839422 0.01314838 0.208551107 \
    0.35393928 0.658181478 -0.66447282 0.677790212 \
    0.0 0.0 0.0 1.0";

#[test]
fn a_gripper_at_a_mug() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let scan = data.join("clouds/table_scene_mug_stereo_textured.pcd");
    let gripper = data.join("meshes/pr2_gripper.stl");
    if !scan.exists() || !gripper.exists() {
        println!("skipped: {} is not there", scan.display());
        return;
    }
    let inputs = Inputs::new();
    for (pose, unseen, code) in [(FREE, "0.05", 30), (FREE, "0.1", 0), (COLLISION, "0.05", 20)] {
        inputs.write("pose.txt", pose);
        let files = [scan.to_str().unwrap(), gripper.to_str().unwrap()];
        let options = ["--pose", "pose.txt", "--sensor", "iso:0.005", "--exit-code"];
        let options = [&options[..], &["--max-unseen", unseen]].concat();
        let run = inputs.run(&[&["query"][..], &files, &options].concat());
        assert_eq!(run.code(), code, "{}{}", run.stdout(), run.stderr());
    }
}
