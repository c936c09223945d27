//! What the tool itself doubts of its input: warnings beside those of a report, in their form.

use nalgebra::UnitQuaternion;
use serde::Serialize;
use serde_json::{Value, json};

/// In JSON as the warnings of a report; displayed on standard error too.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Doubt {
    code: &'static str,
    values: Value,
    pub words: String,
}

/// An order of quaternions that is rather not the one meant.
const ORDER: &str = "quaternion_order";

/// Other parts of a quaternion that are written as 0.
const NONE: f64 = 1e-6;

impl Doubt {
    /// Of a path without a header of which each row is half a turn; this is the first, with its line.
    pub(crate) fn half_turns(line: usize, row: &str) -> Self {
        Self {
            code: ORDER,
            values: json!({ "line": line, "row": row }),
            words: format!(
                "line {line}: `{row}` and all other rows are half a turn: without a header the columns \
                 are read as x,y,z,qw,qx,qy,qz; if w is last, begin the file with the line \
                 x,y,z,qx,qy,qz,qw, and if half turns are meant, with x,y,z,qw,qx,qy,qz"
            ),
        }
    }

    /// Of `--quaternion` where that reads as no turn in the order w,x,y,z: half a turn about x.
    pub(crate) fn of_option(turn: &UnitQuaternion<f64>) -> Option<Self> {
        let is_about_x = [turn.j, turn.k, turn.w].iter().all(|part| part.abs() < NONE);
        is_about_x.then(|| Self {
            code: ORDER,
            values: json!({ "quaternion": [turn.i, turn.j, turn.k, turn.w] }),
            words: format!(
                "--quaternion {},0,0,0 is half a turn about x, for w is last: give 0,0,0,1 if no turn is \
                 meant, and --rotate-deg 180,0,0 if this is",
                turn.i
            ),
        })
    }
}
