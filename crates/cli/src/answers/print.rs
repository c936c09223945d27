//! Words and numbers of answers, and the way to standard output.

use std::io::{ErrorKind, Write as _};

use anyhow::{Context, Result};
use cloudtouch::geom::message::rounded;
use cloudtouch::{Clearance, StageReport};
use cloudtouch_page::words::across;
pub(crate) use cloudtouch_page::words::probability;

use crate::body::{Body, PreparedCloud};
use crate::load::{Input, Loaded};

/// Prints a whole answer.
///
/// A reader that has seen enough (`cloudtouch … | head`) is no error, and does not change the exit
/// code: a collision must not become a success.
pub(crate) fn to_stdout(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        outcome => outcome.context("standard output: cannot be written"),
    }
}

/// A margin as it was asked for.
pub(crate) fn margin(metres: f64) -> String {
    let (value, unit) = if metres < 1.0 { (1e3 * metres, "mm") } else { (metres, "m") };
    format!("{} {unit}", rounded(value))
}

/// A gap in millimetres with its standard deviation, or a dash when none was computed.
pub(crate) fn gap_mm(clearance: Option<Clearance>) -> String {
    clearance.map_or("-".to_owned(), |c| {
        let bound = if c.is_bound { "≤ " } else { "" };
        format!("{bound}{:+.1} ± {:.1}", 1e3 * c.mean, 1e3 * c.std)
    })
}

/// What a body is, what it was taken for and what the filter did to it, in a line with its name.
pub(crate) fn body<C: PreparedCloud>(name: &str, loaded: &Loaded<C>) -> String {
    format!("{name}: {}", about(loaded))
}

/// The same without its name.
pub(crate) fn about<C: PreparedCloud>(loaded: &Loaded<C>) -> String {
    let Input { unit, sensor, sensor_because, .. } = &loaded.input;
    match &loaded.body {
        Body::Cloud(cloud) => {
            let because = sensor_because.map_or(String::new(), |why| format!(" ({why})"));
            let sensor = sensor.as_deref().unwrap_or_default();
            let (kind, units) = match loaded.kinds.iter().all(|kind| kind.is_depth_image()) {
                true => ("depth image", "steps of "),
                false => ("cloud", ""),
            };
            format!(
                "{kind} of {} points in {units}{unit}, sensor {sensor}{because} ({})",
                cloud.count(),
                stages(cloud.stages())
            )
        }
        Body::Mesh(mesh) => {
            let kind = mesh.kind();
            let count = mesh.triangle_count();
            format!("{kind} mesh of {count} triangles in {unit}, {}", across(mesh.size()))
        }
    }
}

fn stages(stages: &[StageReport]) -> String {
    let removed: Vec<String> =
        stages.iter().map(|s| format!("{} removed {}", s.stage, s.removed)).collect();
    removed.join(", ")
}

/// A name of a case in one line of a table: what steers a terminal is spelled out.
pub(crate) fn one_line(name: &str) -> String {
    name.chars()
        .flat_map(|c| if c.is_control() { c.escape_default().collect() } else { vec![c] })
        .collect()
}
