//! The path before and after, from the side, and what is told along it.

use std::ops::Range;

use anyhow::Result;
use cloudtouch::geom::{Point3, Pose};
use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use crate::Along;
use crate::scene::{GRIPPER, SHELF};

type Place = (f64, f64);

const NAMES: [&str; 2] = ["before", "after"];
const COLORS: [RGBColor; 2] = [RGBColor(0, 114, 178), RGBColor(213, 94, 0)];
const BOARD: RGBColor = RGBColor(120, 120, 120);

/// Draws it as SVG.
pub(crate) fn svg(told: [&[Along]; 2]) -> Result<String> {
    let mut svg = String::new();
    {
        let whole = SVGBackend::with_string(&mut svg, (960, 654)).into_drawing_area();
        whole.fill(&WHITE)?;
        let below =
            whole.titled("A gripper pulled out of the board of a shelf", ("sans-serif", 20))?;
        let areas = below.split_evenly((2, 2));
        for which in 0..2 {
            from_the_side(&areas[which], which, told[which])?;
        }
        let likely = "upper bound on the probability of a collision";
        along(&areas[2], likely, told, -0.03..1.03, |told| told.report.bounds[1])?;
        let clear = "clearance, nineteen times of twenty at least, mm";
        along(&areas[3], clear, told, -2.0..150.0, |told| 1e3 * told.careful)?;
        whole.present()?;
    }
    Ok(svg)
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

fn chart<'a, 'b>(
    area: &'a Area<'b>,
    title: &str,
    axes: [&str; 2],
    [x, y]: [Range<f64>; 2],
) -> Result<Chart<'a, 'b>> {
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 17))
        .margin(8)
        .x_label_area_size(44)
        .y_label_area_size(56)
        .build_cartesian_2d(x, y)?;
    let font = ("sans-serif", 16);
    chart
        .configure_mesh()
        .x_desc(axes[0])
        .y_desc(axes[1])
        .label_style(font)
        .max_light_lines(0)
        .draw()?;
    Ok(chart)
}

/// The boards, and the gripper at every pose, to the same scale in both pictures.
fn from_the_side(area: &Area<'_>, which: usize, told: &[Along]) -> Result<()> {
    let title = format!("{}, from the side", NAMES[which]);
    let mut chart = chart(area, &title, ["y, m", "z, m"], [-0.42..0.2, -0.07..0.27])?;
    for [low, high] in &SHELF {
        chart.draw_series([Polygon::new(outline([low, high], &Pose::identity()), BOARD)])?;
    }
    for Along { pose, .. } in told {
        for [low, high] in &GRIPPER {
            let line = outline([low, high], pose);
            chart.draw_series([PathElement::new(line, COLORS[which].stroke_width(2))])?;
        }
    }
    Ok(())
}

/// A number at every pose, before and after.
fn along(
    area: &Area<'_>,
    title: &str,
    told: [&[Along]; 2],
    range: Range<f64>,
    of: fn(&Along) -> f64,
) -> Result<()> {
    let poses = told[0].len() as f64 - 1.0;
    let mut chart = chart(area, title, ["pose", ""], [-0.5..poses + 0.5, range])?;
    for ((told, name), color) in told.into_iter().zip(NAMES).zip(COLORS) {
        let places = || told.iter().enumerate().map(|(k, told)| (k as f64, of(told)));
        chart
            .draw_series(LineSeries::new(places(), color.stroke_width(2)))?
            .label(name)
            .legend(move |at| Circle::new(at, 4, color.filled()));
        chart.draw_series(places().map(|place| Circle::new(place, 4, color.filled())))?;
    }
    let font = ("sans-serif", 16);
    let mut names = chart.configure_series_labels();
    names.position(SeriesLabelPosition::UpperRight).label_font(font).draw()?;
    Ok(())
}

/// A box from the side.
fn outline([low, high]: [&[f64; 3]; 2], pose: &Pose) -> Vec<Place> {
    let corners = [(low, low), (high, low), (high, high), (low, high), (low, low)];
    corners
        .map(|(y, z)| pose.transform_point(&Point3::new(0.0, y[1], z[2])))
        .map(|place| (place.y, place.z))
        .to_vec()
}
