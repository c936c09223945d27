//! The poses of a path in a text: a JSON list of matrices, or a table of places and quaternions.

use anyhow::{Context as _, Result, bail};
use cloudtouch::geom::Pose;
use serde_json::Value;

use super::json::matrix;
use super::pose_table::{self, Unnamed};

/// The poses of a text, and what is to be doubted of them.
#[derive(Debug, Clone, PartialEq)]
pub struct PathText {
    /// Object to scene, m.
    pub poses: Vec<Pose>,
    /// How they begin, in a table that does not name its columns.
    pub unnamed: Option<Unnamed>,
}

/// Poses, object to scene, in metres: JSON where the text begins with a bracket, a list of 4×4
/// row-major matrices; else a table with a pose in each line, `x,y,z,qw,qx,qy,qz`, or in the order of
/// these names before its first row, behind a `#` or not. Named columns may be separated by semicolons,
/// spaces or tabs too and be called `tx,ty,tz`; one of times among them is passed over.
///
/// # Errors
/// Names the pose, from 1, or the line, from 1, that is none.
pub fn parse(text: &str) -> Result<PathText> {
    let text = text.trim_start_matches('\u{feff}').trim_start();
    if text.starts_with('{') {
        bail!("the path is an object: write the list of its poses alone, [[[...],...],...]");
    }
    if text.starts_with('[') {
        return Ok(PathText { poses: matrices(text)?, unnamed: None });
    }
    let (poses, unnamed) = pose_table::parse(text)?;
    Ok(PathText { poses, unnamed })
}

fn matrices(text: &str) -> Result<Vec<Pose>> {
    let all: Vec<Value> = serde_json::from_str(text).context("the path is not a list of poses")?;
    let of =
        |(index, pose)| matrix(pose).with_context(|| format!("pose {} of the path", index + 1));
    all.into_iter().enumerate().map(of).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn a_list_of_matrices_and_a_table_say_the_same() {
        let json = "[[[1,0,0,0.5],[0,-1,0,0],[0,0,-1,0.25],[0,0,0,1]],
                     [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]]";
        let plain = "0.5,0,0.25,0,1,0,0\n0, 0, 0, 1, 0, 0, 0\n";
        let headed = format!("x,y,z,qw,qx,qy,qz\n# a half turn first\n{plain}");
        let commented = "# x,y,z,qx,qy,qz,qw\n0.5,0,0.25,1,0,0,0\n0,0,0,0,0,0,1\n";
        let timed = "time,x,y,z,qx,qy,qz,qw\n0.1,0.5,0,0.25,1,0,0,0\n0.2,0,0,0,0,0,0,1\n";
        let of_tum = "#timestamp tx ty tz qx qy qz qw\n0.1 0.5 0 0.25 1 0 0 0\n0.2 0 0 0 0 0 0 1\n";
        let tabs = "x y z qw qx qy qz\n0.5 0 0.25 0 1 0 0\n0 0 0 1 0 0 0\n".replace(' ', "\t");
        let semicolons = tabs.replace('\t', ";");
        // Once read as if the real part came first.
        let real_last = "\"X\", y, z, qx, qy, qz, qw\n0.5,0,0.25,1,0,0,0\n0,0,0,0,0,0,1\n";
        let expected = parse(json).unwrap().poses;
        for text in [plain, &headed, real_last, commented, timed, of_tum, &tabs, &semicolons] {
            let found = parse(text).unwrap().poses;
            assert_eq!(found.len(), 2);
            for (p, q) in found.iter().zip(&expected) {
                assert!(
                    (p.isometry().to_homogeneous() - q.isometry().to_homogeneous()).norm() < 1e-12
                );
            }
        }
    }

    #[test]
    fn messages_say_which_pose_and_what_to_write() {
        for (text, part) in [
            ("[[[2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]]", "pose 1 of the path"),
            // They gave the words of the parser.
            (
                "[[1,0,0,0]]",
                "pose 1 of the path: row 0 of the pose is 1: write four rows of four numbers",
            ),
            ("[[[1,0,0]]]", "pose 1 of the path: row 0 of the pose has 3 numbers"),
            ("[0]", "pose 1 of the path: the pose is 0: write four rows of four numbers"),
            ("0,0,0,1,0,0,0\n0,0,0,1,0,0", "line 2 of the path: write 7 numbers"),
            ("0,0,nan,1,0,0,0", "line 1 of the path: `nan` is not a finite number"),
            ("0,0,0,2,0,0,0", "line 1 of the path: the quaternion"),
            (
                "x,y,z,roll,pitch,yaw\n",
                "line 1 of the path: `x,y,z,roll,pitch,yaw`: name the columns",
            ),
            ("x,y,z,qx,qy,qz,w\n", "name the columns x,y,z,qw,qx,qy,qz"),
            ("x,y,z,qx,qy,qz,w\n", "qx,qy,qz,qw: unknown `w`; missing `qw`"),
            ("x,y,z,qw,qx,qy,qz,gripper\n", ": unknown `gripper`"),
            ("tx,y,z,qw,qx,qy,qz,QZ\n", ": twice `qz`"),
            ("tx,x,y,z,qw,qx,qy,qz\n", ": twice `x`"),
            ("t,x,y,z,qw,qx,qy\n", ": missing `qz`"),
            (
                "0,0,0,1,0,0,0\n0,0,0,1,a,0,0",
                "line 2 of the path: `a` is not a finite number (column 5, qx)",
            ),
            ("t,z,y,x,qw,qx,qy,qz\n0,a,0,0,1,0,0,0", "`a` is not a finite number (column 2, z)"),
            ("t,z,y,x,qw,qx,qy,qz\na,0,0,0,1,0,0,0", "`a` is not a finite number (column 1)"),
            ("0,0,0,1,0,0", "a quaternion; 6 are given"),
            (
                "0 0 0 1 0 0 0",
                "separated by commas, or by spaces or semicolons below a line that names the columns",
            ),
            ("0 1 0 0 1 0 0 0", "such as `timestamp tx ty tz qx qy qz qw`"),
            ("0;0;0;1;0;0;0", "semicolons"),
            (
                "x;y;z;qw;qx;qy;qz\n0,5;0;0;1;0;0;0",
                "line 2 of the path: `0,5` is not a finite number",
            ),
            ("pos_x pos_y pos_z", "such as x,y,z,qx,qy,qz,qw"),
            ("{\"poses\": []}", "is an object: write the list of its poses alone"),
        ] {
            let error = format!("{:#}", parse(text).unwrap_err());
            assert!(error.contains(part), "{error}");
        }
    }
}
