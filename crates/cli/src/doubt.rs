//! What the tool itself doubts of its input: warnings beside those of a report, in their form.

use cloudtouch_cli::files::pose_table::Unnamed;
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

/// How the columns of a path are read that have no names.
pub(crate) const READ_AS: &str = "x,y,z,qw,qx,qy,qz";

/// The order that ROS and most recorders write.
const ROS: &str = "x,y,z,qx,qy,qz,qw";

/// Other parts of a quaternion that are written as 0.
const NONE: f64 = 1e-6;

impl Doubt {
    /// Of a path whose columns have no names: their order is a guess.
    pub(crate) fn of_unnamed(path: &Unnamed) -> Self {
        let Unnamed { line, row, are_half_turns } = path;
        let (code, words) = if *are_half_turns {
            (
                ORDER,
                format!(
                    "line {line}: `{row}` and all other rows are half a turn: without a header the \
                     columns are read as {READ_AS}; if w is last, begin the file with the line \
                     {ROS}, and if half turns are meant, with {READ_AS}"
                ),
            )
        } else {
            (
                "unnamed_columns",
                format!(
                    "line {line}: `{row}` is read as {READ_AS}, for no line above names its columns: \
                     begin the file with that line, or, if w is last, with {ROS}"
                ),
            )
        };
        Self { code, values: json!({ "line": line, "row": row }), words }
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
