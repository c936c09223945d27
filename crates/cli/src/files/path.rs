//! The poses of a path in a text: a JSON list of matrices, or a table of places and quaternions.

use anyhow::{Context as _, Result, bail};
use cloudtouch::geom::{Pose, Vector3};
use nalgebra::Matrix4;

/// No message quotes more of a word.
const EXCERPT: usize = 40;

/// The poses of a text, and what is to be doubted of them.
#[derive(Debug, Clone, PartialEq)]
pub struct PathText {
    /// Object to scene, m.
    pub poses: Vec<Pose>,
    /// The first row of a table without a header, with its line from 1, where every row is half a turn:
    /// where the real part is written last, as ROS does, none of them is turned about x.
    pub half_turns: Option<(usize, String)>,
}

/// Poses, object to scene, in metres: JSON where the text begins with a bracket, a list of 4×4
/// row-major matrices; else a table with a pose in each line, `x,y,z,qw,qx,qy,qz`, or in the order of
/// these names in its first line.
///
/// # Errors
/// Names the pose, from 1, or the line, from 1, that is none.
pub fn parse(text: &str) -> Result<PathText> {
    let text = text.trim_start_matches('\u{feff}').trim_start();
    if text.starts_with('{') {
        bail!("the path is an object: write the list of its poses alone, [[[...],...],...]");
    }
    if text.starts_with('[') {
        return Ok(PathText { poses: matrices(text)?, half_turns: None });
    }
    table(text)
}

fn matrices(text: &str) -> Result<Vec<Pose>> {
    let all: Vec<[[f64; 4]; 4]> = serde_json::from_str(text)
        .context("the path is not a list of poses, each four rows of four numbers")?;
    let pose = |(index, rows): (usize, [[f64; 4]; 4])| {
        let matrix = Matrix4::from_row_slice(rows.as_flattened());
        Pose::try_from_matrix(&matrix).with_context(|| format!("pose {} of the path", index + 1))
    };
    all.into_iter().enumerate().map(pose).collect()
}

/// What stays of a zero that was computed, or written with six digits.
const NO_REAL_PART: f64 = 1e-6;

/// The columns of a table.
const COLUMNS: [&str; 7] = ["x", "y", "z", "qw", "qx", "qy", "qz"];

fn table(text: &str) -> Result<PathText> {
    let mut poses = Vec::new();
    let mut first = None;
    let mut is_doubted = true;
    // Where in a line each of the columns is.
    let mut order = [0, 1, 2, 3, 4, 5, 6];
    for (line, content) in text.lines().enumerate() {
        let content = content.trim();
        let is_header = line == 0 && content.starts_with(|c: char| c.is_alphabetic() || c == '"');
        if content.is_empty() || content.starts_with('#') {
            continue;
        }
        let place = || format!("line {} of the path", line + 1);
        if is_header {
            order = header(content).with_context(place)?;
            is_doubted = false;
        } else {
            let pose = row(content, order).with_context(place)?;
            is_doubted &= pose.rotation().w.abs() < NO_REAL_PART;
            first.get_or_insert((line + 1, content));
            poses.push(pose);
        }
    }
    let first = first.filter(|_| is_doubted);
    let half_turns = first.map(|(line, row)| (line, row.chars().take(EXCERPT).collect()));
    Ok(PathText { poses, half_turns })
}

/// Where each column is: many write the real part of a quaternion last.
fn header(content: &str) -> Result<[usize; 7]> {
    let names: Vec<String> =
        content.split(',').map(|name| name.trim().trim_matches('"').to_lowercase()).collect();
    let mut order = [0; 7];
    for (place, column) in order.iter_mut().zip(COLUMNS) {
        match names.iter().position(|name| name == column) {
            Some(found) if names.len() == COLUMNS.len() => *place = found,
            _ => {
                let given: String = content.chars().take(EXCERPT).collect();
                bail!("`{given}`: name the columns {}, in any order", COLUMNS.join(","));
            }
        }
    }
    Ok(order)
}

fn row(content: &str, order: [usize; 7]) -> Result<Pose> {
    let number = |word: &str| -> Result<f64> {
        let word = word.trim();
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => {
                let word: String = word.chars().take(EXCERPT).collect();
                bail!("`{word}` is not a finite number; numbers are separated by commas")
            }
        }
    };
    let numbers = content.split(',').map(number).collect::<Result<Vec<f64>>>()?;
    let Ok(numbers) = <[f64; 7]>::try_from(numbers) else {
        bail!("write seven numbers, {}: metres and a quaternion, with commas", COLUMNS.join(","));
    };
    let [x, y, z, w, i, j, k] = order.map(|place| numbers[place]);
    Ok(Pose::try_from_quaternion(Vector3::new(x, y, z), [w, i, j, k])?)
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
        // Once read as if the real part came first.
        let real_last = "\"X\", y, z, qx, qy, qz, qw\n0.5,0,0.25,1,0,0,0\n0,0,0,0,0,0,1\n";
        let expected = parse(json).unwrap().poses;
        for text in [plain, &headed, real_last] {
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
            ("[[1,0,0,0]]", "each four rows of four numbers"),
            ("0,0,0,1,0,0,0\n0,0,0,1,0,0", "line 2 of the path: write seven numbers"),
            ("0,0,nan,1,0,0,0", "line 1 of the path: `nan` is not a finite number"),
            ("0,0,0,2,0,0,0", "line 1 of the path: the quaternion"),
            (
                "x,y,z,roll,pitch,yaw\n",
                "line 1 of the path: `x,y,z,roll,pitch,yaw`: name the columns",
            ),
            ("x,y,z,qx,qy,qz,w\n", "name the columns x,y,z,qw,qx,qy,qz"),
            ("0 0 0 1 0 0 0", "separated by commas"),
            ("{\"poses\": []}", "is an object: write the list of its poses alone"),
        ] {
            let error = format!("{:#}", parse(text).unwrap_err());
            assert!(error.contains(part), "{error}");
        }
    }
}
