//! `cloudtouch info`: what a file holds, and which sensor suits it.

use std::process::ExitCode;

use anyhow::Result;
use cloudtouch::geom::{Point3, PointCloud, TriangleMesh};
use cloudtouch::noise::{Neighborhoods, typical_spacing};
use cloudtouch::{FilterSettings, filter};
use cloudtouch_io::Geometry;

use crate::args::InfoArguments;
use crate::load::{self, SUSPICIOUS_MESH_SIZE};
use crate::print;

/// Points whose neighbours tell the spacing.
const SPACING_SAMPLE: usize = 500;

pub(crate) fn run(arguments: &InfoArguments) -> Result<ExitCode> {
    let text =
        match load::geometry(&arguments.file, arguments.unit, &arguments.limits.read_limits())? {
            Geometry::Cloud(cloud) => describe_cloud(&cloud)?,
            Geometry::Mesh(mesh) => describe_mesh(&mesh),
        };
    print::to_stdout(&format!("{}\n{text}\n", arguments.file.display()))?;
    Ok(ExitCode::SUCCESS)
}

fn describe_cloud(cloud: &PointCloud) -> Result<String> {
    let cleaned = filter(cloud, &FilterSettings::default())?;
    let removed =
        |stage: &str| cleaned.stages.iter().find(|s| s.stage == stage).map_or(0, |s| s.removed);
    let mut lines = vec![
        format!("rows        {}{}", cloud.len(), image(cloud)),
        format!("missing     {} (NaN or infinite)", removed("missing")),
        format!("duplicates  {}", removed("duplicates")),
    ];
    if let Some((low, high)) = cloud.bounding_box() {
        lines.push(format!("box         {} to {} m", triple(&low), triple(&high)));
        let center = nalgebra::center(&low, &high);
        let local: Vec<Point3> =
            cleaned.cloud.points.iter().map(|p| Point3::from(p - center)).collect();
        let near = local
            .iter()
            .filter(|p| (**p + center.coords - cloud.sensor_origin()).norm() < 0.1)
            .count();
        let spacing = typical_spacing(&Neighborhoods::try_new(local)?, SPACING_SAMPLE);
        lines.push(format!("spacing     {:.1} mm (median)", 1e3 * spacing));
        if near > 0 {
            lines.push(format!(
                "too near    {near} points within 0.1 m of the sensor: placeholders? (--min-range 0.1)"
            ));
        }
        lines.push(format!("sensor      {}", suggestion(cloud, &low, &high)));
    }
    Ok(lines.join("\n"))
}

fn image(cloud: &PointCloud) -> String {
    match cloud.image_size {
        Some((width, height)) if height > 1 => format!(" (a {width} x {height} image)"),
        _ => String::new(),
    }
}

/// A file does not say which sensor made it: this is a guess from its layout and extent.
fn suggestion(cloud: &PointCloud, low: &Point3, high: &Point3) -> &'static str {
    let far_from_origin = low.coords.amax().min(high.coords.amax()) > 1e4;
    if cloud.covariances.is_some() {
        "per-point (the file has covariance columns)"
    } else if far_from_origin {
        "axes:0.3,0.3,0.15 (map coordinates: an airborne scan?)"
    } else if cloud.image_size.is_some_and(|(_, height)| height > 1) {
        "kinect, or iso:0.005 for a stereo camera (a depth image)"
    } else if (high - low).amax() > 4.0 {
        "lidar:0.02,0.003 (metres across: a laser scan?)"
    } else {
        "iso:0.005 (nothing in the file tells)"
    }
}

fn describe_mesh(mesh: &TriangleMesh) -> String {
    let merged = mesh.merged();
    let open = merged.open_edges();
    let closed = if open == 0 {
        "watertight: inside and outside are defined".to_owned()
    } else {
        format!("open: {open} edges do not join two triangles; only its surface collides")
    };
    let mut lines = vec![
        format!(
            "triangles   {} over {} vertices ({} after merging)",
            mesh.triangles().len(),
            mesh.vertices().len(),
            merged.vertices().len()
        ),
        format!("surface     {closed}"),
    ];
    if let Some((low, high)) = mesh.bounding_box() {
        lines.push(format!("box         {} to {} m", triple(&low), triple(&high)));
        if (high - low).norm() > SUSPICIOUS_MESH_SIZE {
            lines.push("unit        hundreds of metres across: --unit mm?".to_owned());
        }
    }
    lines.join("\n")
}

fn triple(p: &Point3) -> String {
    format!("({:.3}, {:.3}, {:.3})", p.x, p.y, p.z)
}
