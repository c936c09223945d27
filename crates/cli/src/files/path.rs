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
    /// The first row of a table without a header, with its line from 1, where every row is half a turn or
    /// nearly: where the real part is written last, as ROS does, none of them is turned much about x.
    pub half_turns: Option<(usize, String)>,
}

/// Poses, object to scene, in metres: JSON where the text begins with a bracket, a list of 4×4
/// row-major matrices; else a table with a pose in each line, `x,y,z,qw,qx,qy,qz`, or in the order of
/// these names before its first row, behind a `#` or not; a column of times among them is passed over.
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

/// Real parts smaller than that are of half a turn, or of one that lacks some two degrees.
const NO_REAL_PART: f64 = 0.02;

/// The columns of a table.
const COLUMNS: [&str; 7] = ["x", "y", "z", "qw", "qx", "qy", "qz"];

/// What recorders put beside them.
const TIMES: [&str; 4] = ["t", "time", "timestamp", "stamp"];

/// Where in a line each of the columns is, and how many numbers it has.
struct Order {
    places: [usize; 7],
    count: usize,
}

fn table(text: &str) -> Result<PathText> {
    let mut poses = Vec::new();
    let mut first = None;
    let mut is_doubted = true;
    let mut order = Order { places: [0, 1, 2, 3, 4, 5, 6], count: COLUMNS.len() };
    for (line, content) in text.lines().enumerate() {
        let content = content.trim();
        let is_header = line == 0 && content.starts_with(|c: char| c.is_alphabetic() || c == '"');
        let place = || format!("line {} of the path", line + 1);
        if let Some(comment) = content.strip_prefix('#') {
            // So numpy writes a header.
            if let Some(named) = named(comment).filter(|_| poses.is_empty()) {
                (order, is_doubted) = (named, false);
            }
        } else if is_header {
            order = header(content).with_context(place)?;
            is_doubted = false;
        } else if !content.is_empty() {
            let pose = row(content, &order).with_context(place)?;
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
fn header(content: &str) -> Result<Order> {
    named(content).with_context(|| {
        let given: String = content.chars().take(EXCERPT).collect();
        format!("`{given}`: name the columns {}, in any order", COLUMNS.join(","))
    })
}

/// The columns where these are all that is named.
fn named(content: &str) -> Option<Order> {
    let names: Vec<String> =
        content.split(',').map(|name| name.trim().trim_matches('"').to_lowercase()).collect();
    let mut places = [0; 7];
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        *place = names.iter().position(|name| name == column)?;
    }
    let times = names.iter().filter(|name| TIMES.contains(&name.as_str())).count();
    (names.len() == COLUMNS.len() + times).then_some(Order { places, count: names.len() })
}

fn row(content: &str, order: &Order) -> Result<Pose> {
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
    if numbers.len() != order.count {
        let times = if order.count > COLUMNS.len() { " and a time, as the header has" } else { "" };
        let (count, columns) = (order.count, COLUMNS.join(","));
        bail!("write {count} numbers, {columns}{times}: metres and a quaternion, with commas");
    }
    let [x, y, z, w, i, j, k] = order.places.map(|place| numbers[place]);
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
        let commented = "# x,y,z,qx,qy,qz,qw\n0.5,0,0.25,1,0,0,0\n0,0,0,0,0,0,1\n";
        let timed = "time,x,y,z,qx,qy,qz,qw\n0.1,0.5,0,0.25,1,0,0,0\n0.2,0,0,0,0,0,0,1\n";
        // Once read as if the real part came first.
        let real_last = "\"X\", y, z, qx, qy, qz, qw\n0.5,0,0.25,1,0,0,0\n0,0,0,0,0,0,1\n";
        let expected = parse(json).unwrap().poses;
        for text in [plain, &headed, real_last, commented, timed] {
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
            ("0,0,0,1,0,0,0\n0,0,0,1,0,0", "line 2 of the path: write 7 numbers"),
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
