//! The path before and after, from the side, and what is told along it.

use cloudtouch_evaluation::report::figure::{Axis, Figure, Panel, Place, Series};
use cloudtouch_geom::{Point3, Pose};

use crate::Along;
use crate::scene::{GRIPPER, SHELF};

const NAMES: [&str; 2] = ["before", "after"];

pub(crate) fn figure(told: [&[Along]; 2]) -> Figure {
    // Given, so that both pictures show the same to the same scale.
    let axis = |name: &str, range| {
        let mut axis = Axis::linear(name);
        axis.range = Some(range);
        axis
    };
    let from_the_side = |(name, told): (&str, &[Along])| {
        let boards = SHELF.iter().map(|[low, high]| outline([low, high], &Pose::identity()));
        let hands = told.iter().flat_map(|told| {
            GRIPPER.iter().map(|[low, high]| Series::line(name, outline([low, high], &told.pose)))
        });
        Panel {
            title: format!("{name}, from the side"),
            x: axis("y, m", -0.42..0.2),
            y: axis("z, m", -0.07..0.27),
            series: [Series::polygons("", boards)].into_iter().chain(hands).collect(),
        }
    };
    let along = |title: &str, y, of: fn(&Along) -> f64| {
        let curve = |(name, told): (&str, &[Along])| {
            Series::curve(name, told.iter().enumerate().map(|(k, told)| (k as f64, of(told))))
        };
        let series = NAMES.into_iter().zip(told).map(curve).collect();
        Panel { title: title.into(), x: Axis::linear("pose"), y, series }
    };
    let mut panels: Vec<Panel> = NAMES.into_iter().zip(told).map(from_the_side).collect();
    let likely = Axis::unit("upper bound on P");
    panels.push(along("probability of a collision", likely, |told| told.report.bounds[1]));
    let clear = "clearance, nineteen times of twenty at least";
    panels.push(along(clear, Axis::linear("mm"), |told| 1e3 * told.careful));
    let mut figure = Figure::new("A gripper pulled out of the board of a shelf", panels);
    figure.panel_size = (480, 310);
    figure
}

/// A box from the side.
fn outline([low, high]: [&[f64; 3]; 2], pose: &Pose) -> Vec<Place> {
    let corners = [(low, low), (high, low), (high, high), (low, high), (low, low)];
    corners
        .map(|(y, z)| pose.transform_point(&Point3::new(0.0, y[1], z[2])))
        .map(|place| (place.y, place.z))
        .to_vec()
}
