//! What a scan holds, and which sensor suits it.

use anyhow::Result;
use cloudtouch::geom::{Point3, PointCloud};
use cloudtouch::noise::{Neighborhoods, SensorModel, typical_spacing};
use cloudtouch::{FilterSettings, Filtered, LARGEST_COORDINATE, filter};
use cloudtouch_page::words;

use crate::sensor::{Chosen, suggestion};

use super::triple::triple;

/// Points whose neighbours tell the spacing.
const SPACING_SAMPLE: usize = 500;

/// Of a sensor in a room or on a car neither: points that far apart over so much, m.
const SUSPICIOUS_CLOUD_SIZE: f64 = 50.0;
const SUSPICIOUS_SPACING: f64 = 0.5;

/// Coordinates of maps are far larger than what is in them, m.
const MAP_COORDINATE: f64 = 1e4;

/// Returns so near a sensor are none, m.
const NEAR: f64 = 0.1;

pub(super) fn describe_cloud(cloud: &PointCloud) -> Result<String> {
    describe_scan(cloud, "--cloud-unit mm, or cm?")
}

/// `remedy` is for what is too large to be in metres.
pub(super) fn describe_scan(cloud: &PointCloud, remedy: &str) -> Result<String> {
    let cleaned = filter(cloud, &FilterSettings::default(), &SensorModel::Exact)?;
    let mut lines = rows(cloud, &cleaned);
    if let Some(beyond) = too_far(cloud) {
        lines.push(beyond);
    } else if let Some(corners) = cloud.bounding_box() {
        lines.extend(extent(cloud, &cleaned.cloud.points, corners, remedy)?);
        let Chosen { sensor, because } = suggestion(cloud);
        lines.push(format!("sensor      {sensor} ({})", because.unwrap_or_default()));
    }
    Ok(lines.join("\n"))
}

/// How many rows there are, and how many of them are points.
fn rows(cloud: &PointCloud, cleaned: &Filtered) -> Vec<String> {
    let removed =
        |stage: &str| cleaned.stages.iter().find(|s| s.stage == stage).map_or(0, |s| s.removed);
    let mut lines = vec![
        format!("rows        {}{}", cloud.len(), image(cloud)),
        format!("missing     {} (NaN, infinite, or zeros for no return)", removed("missing")),
        format!("duplicates  {}", removed("duplicates")),
    ];
    if cleaned.cloud.points.is_empty() {
        lines.push(
            "box         none: no row is a point, and nothing can be asked about it".to_owned(),
        );
    }
    lines
}

/// Which rows no query would take, if any.
fn too_far(cloud: &PointCloud) -> Option<String> {
    let is_beyond = |p: &Point3| PointCloud::is_return(p) && p.coords.amax() > LARGEST_COORDINATE;
    let row = cloud.points.iter().position(is_beyond)?;
    let count = cloud.points.iter().filter(|p| is_beyond(p)).count();
    Some(format!(
        "too far     {count} of {} rows beyond 1e10 m, which a query refuses, the first of them row {}:\n            \
         correct or remove them, or give the unit",
        cloud.len(),
        row + 1
    ))
}

/// Where its points are, how far apart, and what of that is odd.
fn extent(
    cloud: &PointCloud,
    points: &[Point3],
    (low, high): (Point3, Point3),
    remedy: &str,
) -> Result<Vec<String>> {
    let center = nalgebra::center(&low, &high);
    let local: Vec<Point3> = points.iter().map(|p| Point3::from(p - center)).collect();
    let origin = cloud.sensor_origin();
    let near = local.iter().filter(|p| (**p + center.coords - origin).norm() < NEAR).count();
    let spacing = typical_spacing(&Neighborhoods::new(local)?, SPACING_SAMPLE);
    let mut lines = vec![
        format!("box         {} to {} m", triple(&low), triple(&high)),
        format!("spacing     {} (median)", words::length(spacing)),
    ];
    if cloud.sensor_pose.is_some() {
        let from = words::length((origin - center).norm());
        lines.push(format!("viewpoint   {} m, {from} from the middle of the box", triple(&origin)));
    }
    let size = (high - low).norm();
    // A map in metres has its points as far apart, far from its origin.
    let is_map = low.coords.amax().min(high.coords.amax()) > MAP_COORDINATE;
    if size > SUSPICIOUS_CLOUD_SIZE && spacing > SUSPICIOUS_SPACING && !is_map {
        lines.push(format!(
            "unit        {size:.0} m across and {spacing:.1} m from point to point: {remedy}"
        ));
    }
    if near > 0 {
        lines.push(near_sensor(cloud, near));
    }
    Ok(lines)
}

/// What points so near the sensor are, or near the origin where no sensor is known of.
fn near_sensor(cloud: &PointCloud, near: usize) -> String {
    if cloud.is_image() {
        return format!(
            "too near    {near} points within {NEAR} m of where the sensor stood: no returns (the models of cameras\n            \
             and laser scanners leave them out)"
        );
    }
    // In a map, or about an object, it is a place like others, even one that is stated.
    let (label, place) = match cloud.sensor_pose {
        Some(_) => ("near sensor", "where the sensor is said to have stood"),
        None => ("at origin", "it"),
    };
    format!(
        "{label:<12}{near} points within {NEAR} m of {place}: surface, unless the sensor stood there\n            \
         (then --min-range {NEAR} leaves them out)"
    )
}

fn image(cloud: &PointCloud) -> String {
    match cloud.image_size {
        Some((width, height)) if height > 1 => format!(" (a {width} x {height} image)"),
        _ => String::new(),
    }
}
