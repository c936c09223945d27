//! `cloudtouch info`: what a file holds, and which sensor suits it.

use std::process::ExitCode;

use anyhow::{Result, bail};
use cloudtouch::geom::{Point3, PointCloud, TriangleMesh};
use cloudtouch::noise::{Neighborhoods, SensorModel, typical_spacing};
use cloudtouch::{FilterSettings, LARGEST_COORDINATE, Mesh, PrepareError, filter};
use cloudtouch_io::{DepthCamera, Geometry, is_depth_image};
use cloudtouch_page::words;

use crate::answers::print;
use crate::args::InfoArguments;
use crate::load::{self, Kind, SUSPICIOUS_MESH_SIZE, Units};
use crate::sensor::{Chosen, suggestion};
use crate::unused;
use crate::usage::WrongUsage;

/// Points whose neighbours tell the spacing.
const SPACING_SAMPLE: usize = 500;

/// Of a sensor in a room or on a car neither: points that far apart over so much, m.
const SUSPICIOUS_CLOUD_SIZE: f64 = 50.0;
const SUSPICIOUS_SPACING: f64 = 0.5;

/// Coordinates of maps are far larger than what is in them, m.
const MAP_COORDINATE: f64 = 1e4;

pub(crate) fn run(arguments: &InfoArguments) -> Result<ExitCode> {
    let images = &arguments.depth.images();
    let units = Units {
        meshes: arguments.unit.unwrap_or_default(),
        clouds: arguments.cloud_unit.unwrap_or_default(),
        images,
    };
    if let Some(option) = arguments.depth.given().filter(|_| !is_depth_image(&arguments.file)) {
        bail!(unused::of_images(option));
    }
    #[cfg(feature = "mcap")]
    if let Some(name) = cloudtouch_io::recording::ScanName::of(&arguments.file) {
        load::check(&arguments.file)?;
        let text = super::recording::describe(&name?, arguments, describe_cloud)?;
        return answer(arguments, &text);
    }
    let read = load::geometry(&arguments.file, units, &arguments.limits.read_limits())?;
    let text = match (read.geometry, read.kind) {
        (Geometry::Cloud(_), _) if arguments.unit.is_some() => {
            bail!(WrongUsage(
                "--unit is for meshes, and this is a cloud: give --cloud-unit".to_owned()
            ))
        }
        (_, Kind::DepthImage(_)) if arguments.cloud_unit.is_some() => {
            bail!(WrongUsage(unused::CLOUD_UNIT.to_owned()))
        }
        (Geometry::Mesh(_), _) if arguments.cloud_unit.is_some() => {
            bail!(WrongUsage(
                "--cloud-unit is for clouds, and this is a mesh: give --unit".to_owned()
            ))
        }
        (Geometry::Cloud(cloud), Kind::DepthImage(camera)) => {
            // What is too large is so by its steps.
            let cloud_text = describe_scan(&cloud, "--depth-scale?")?;
            format!("{}\n{cloud_text}", describe_camera(&camera, &cloud))
        }
        (Geometry::Cloud(cloud), _) => describe_cloud(&cloud)?,
        (Geometry::Mesh(mesh), _) => describe_mesh(&mesh),
    };
    answer(arguments, &text)
}

fn answer(arguments: &InfoArguments, text: &str) -> Result<ExitCode> {
    print::to_stdout(&format!("{}\n{text}\n", arguments.file.display()))?;
    Ok(ExitCode::SUCCESS)
}

fn describe_cloud(cloud: &PointCloud) -> Result<String> {
    describe_scan(cloud, "--cloud-unit mm, or cm?")
}

/// `remedy` is for what is too large to be in metres.
fn describe_scan(cloud: &PointCloud, remedy: &str) -> Result<String> {
    let cleaned = filter(cloud, &FilterSettings::default(), &SensorModel::Exact)?;
    let removed =
        |stage: &str| cleaned.stages.iter().find(|s| s.stage == stage).map_or(0, |s| s.removed);
    let mut lines = vec![
        format!("rows        {}{}", cloud.len(), image(cloud)),
        format!("missing     {} (NaN or infinite)", removed("missing")),
        format!("duplicates  {}", removed("duplicates")),
    ];
    if cleaned.cloud.points.is_empty() {
        lines.push(
            "box         none: no row is a point, and nothing can be asked about it".to_owned(),
        );
    }
    let is_beyond = |p: &Point3| PointCloud::is_return(p) && p.coords.amax() > LARGEST_COORDINATE;
    if let Some(row) = cloud.points.iter().position(is_beyond) {
        let count = cloud.points.iter().filter(|p| is_beyond(p)).count();
        lines.push(format!(
            "too far     {count} of {} rows beyond 1e10 m, which a query refuses, the first of them row {}:\n            \
             correct or remove them, or give the unit",
            cloud.len(),
            row + 1
        ));
    } else if let Some((low, high)) = cloud.bounding_box() {
        lines.push(format!("box         {} to {} m", triple(&low), triple(&high)));
        let center = nalgebra::center(&low, &high);
        let local: Vec<Point3> =
            cleaned.cloud.points.iter().map(|p| Point3::from(p - center)).collect();
        let near = local
            .iter()
            .filter(|p| (**p + center.coords - cloud.sensor_origin()).norm() < 0.1)
            .count();
        let spacing = typical_spacing(&Neighborhoods::new(local)?, SPACING_SAMPLE);
        lines.push(format!("spacing     {} (median)", words::length(spacing)));
        if cloud.sensor_pose.is_some() {
            let origin = cloud.sensor_origin();
            let from = words::length((origin - center).norm());
            lines.push(format!(
                "viewpoint   {} m, {from} from the middle of the box",
                triple(&origin)
            ));
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
            lines.push(match cloud.is_image() || cloud.sensor_pose.is_some() {
                true => format!(
                    "too near    {near} points within 0.1 m of where the sensor stood: no returns, left out"
                ),
                // In a map, or about an object, it is a place like others.
                false => format!(
                    "at origin   {near} points within 0.1 m of it: surface, unless the sensor stood there\n            \
                     (then --min-range 0.1 leaves them out)"
                ),
            });
        }
        let Chosen { sensor, because } = suggestion(cloud);
        lines.push(format!("sensor      {sensor} ({})", because.unwrap_or_default()));
    }
    Ok(lines.join("\n"))
}

/// The camera of a depth image, and how wide it sees.
fn describe_camera(camera: &DepthCamera, cloud: &PointCloud) -> String {
    let DepthCamera { fx, fy, cx, cy, depth_scale, .. } = camera;
    let (width, height) = cloud.image_size.unwrap_or_default();
    let seen = |focal_length: f64, middle: f64, pixels: usize| {
        let edges = [-0.5 - middle, pixels as f64 - 0.5 - middle];
        let [from, to] = edges.map(|edge| (edge / focal_length).atan().to_degrees());
        to - from
    };
    let (across, down) = (seen(*fx, *cx, width), seen(*fy, *cy, height));
    format!(
        "camera      fx {fx}, fy {fy}, cx {cx}, cy {cy} pixels, {depth_scale} m a step: sees {across:.1} x \
         {down:.1} degrees"
    )
}

fn image(cloud: &PointCloud) -> String {
    match cloud.image_size {
        Some((width, height)) if height > 1 => format!(" (a {width} x {height} image)"),
        _ => String::new(),
    }
}

fn describe_mesh(mesh: &TriangleMesh) -> String {
    let merged = mesh.merged().without_repeats();
    let open = merged.open_edges();
    let prepared = Mesh::prepare(mesh);
    let closed = match prepared {
        Err(error @ PrepareError::CoordinateRange { .. }) => format!("refused: {error}"),
        Err(_) => "none: no triangle has an area, nothing collides with it".to_owned(),
        Ok(mesh) if mesh.is_watertight() => "watertight: inside and outside are defined".to_owned(),
        Ok(_) if open == 0 => {
            "closed, but part of it encloses no volume; only its surface collides".to_owned()
        }
        Ok(mesh) if mesh.is_closed() => format!(
            "closed: inside and outside are defined; its parts touch along {open} edges that join more than two \
             triangles"
        ),
        Ok(mesh) if mesh.has_solids() => format!(
            "partly closed: what its closed parts enclose is inside; of the rest, with {open} edges that do not \
             join two triangles, only the surface collides"
        ),
        Ok(_) => format!("open: {open} edges do not join two triangles; only its surface collides"),
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
