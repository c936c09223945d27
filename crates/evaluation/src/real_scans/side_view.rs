//! The scene and the object from the side: a slice through both, so that what looks like an overlap is one.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Context, Result, ensure};
use cloudtouch::{Cloud, Mesh, Report};
use cloudtouch_geom::{Point3, Pose, TriangleMesh, Vector3};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::float::simplify::SimplifyShape;

use crate::report::{Axis, Figure, GREY, Panel, Place, RGBColor, Series};
use crate::statistics::quantile;

/// Into the table, as the camera sees it (x right, y down, z forward).
const DOWN: [f64; 3] = [0.05, 0.8, 0.6];
/// Half the thickness of the slice, m: that of a finger.
const SLICE: f64 = 0.01;
/// What is shown, cm: to either side of the first contact, and from below the table upwards.
const SIDEWAYS: f64 = 10.0;
const HEIGHTS: std::ops::Range<f64> = -1.5..30.0;
/// Side of the squares of which no more than one point is drawn, cm.
const SQUARE: f64 = 0.4;
/// Points and contacts at least this likely are marked.
const LIKELY: f64 = 0.3;

const POINTS: &str = "scan";
const GRIPPER: RGBColor = RGBColor(110, 165, 220);
const RED: RGBColor = RGBColor(215, 25, 28);
const BLACK: RGBColor = RGBColor(0, 0, 0);

/// The plane of the picture.
struct View {
    middle: Point3,
    right: Vector3,
    up: Vector3,
    towards_eye: Vector3,
    /// Height of the table above the middle, cm.
    table: f64,
}

impl View {
    /// Looks along the z axis of the object, along which its fingers are flat.
    fn of(cloud: &Cloud, middle: Point3, scene_from_object: &Pose) -> Result<Self> {
        let towards_eye = -scene_from_object.transform_vector(&Vector3::z());
        let down = Vector3::from(DOWN);
        let up = -(down - towards_eye * down.dot(&towards_eye)).normalize();
        let right = up.cross(&towards_eye);
        let view = Self { middle, right, up, towards_eye, table: 0.0 };
        let heights: Vec<f64> = view.slice(cloud).map(|(_, (_, height))| height).collect();
        ensure!(!heights.is_empty(), "no measured point is in the slice");
        Ok(Self { table: quantile(&heights, 0.1), ..view })
    }

    /// Sideways from the middle and above the table, cm.
    fn place(&self, point: &Point3) -> Place {
        let offset = 100.0 * (point - self.middle);
        (offset.dot(&self.right), offset.dot(&self.up) - self.table)
    }

    /// The points of the slice that are in sight, by their index.
    fn slice<'a>(&'a self, cloud: &'a Cloud) -> impl Iterator<Item = (usize, Place)> + 'a {
        let depth = |i: usize| (cloud.point(i) - self.middle).dot(&self.towards_eye).abs();
        let in_slice = (0..cloud.len()).filter(move |&i| depth(i) < SLICE);
        let placed = in_slice.map(|i| (i, self.place(&cloud.point(i))));
        placed.filter(|(_, (x, y))| x.abs() < SIDEWAYS && y.abs() < HEIGHTS.end)
    }
}

/// One panel for each pose with its answer.
pub(super) fn figure(
    cloud: &Cloud,
    object: &TriangleMesh,
    shown: &[(Pose, Report)],
) -> Result<Figure> {
    let touching = shown.iter().find_map(|(pose, report)| Some((pose, report.contacts.first()?)));
    let (pose, first) = touching.context("no pose has a contact")?;
    let view = View::of(cloud, first.point, pose)?;
    let mesh = Mesh::prepare(object)?;
    let panel = |(pose, report): &(Pose, Report)| {
        let (likely, other) = points(&view, cloud, &mesh, pose, report);
        let x = Axis { range: Some(-SIDEWAYS..SIDEWAYS), ..Axis::linear("sideways (cm)") };
        let y = Axis { range: Some(HEIGHTS), ..Axis::linear("height above the table (cm)") };
        let painted = |series, color| Series { color: Some(color), size: 2, ..series };
        let gripper = Series::polygons("gripper", outline(&view, object, pose));
        let series = vec![
            // Circles are the markers of the first.
            painted(Series::points(POINTS, []), GREY),
            painted(gripper, GRIPPER).named_at(3.5, 28.5),
            painted(Series::points(POINTS, other), GREY).named_at(-8.5, 1.9),
            painted(Series::points("in contact", likely), RED).named_at(-9.8, 10.4),
            painted(Series::polygons("normal", arrow(&view, report)), BLACK).named_at(1.2, 8.6),
        ];
        let p = report.collision_probability;
        Panel { title: format!("P = {p:.2}: {}", report.verdict), x, y, series }
    };
    let title = "How likely does the gripper hit the mug? Three poses, seen from the side";
    let figure = Figure::new(title, shown.iter().map(panel));
    // As many pixels for a centimetre upwards as sideways.
    Ok(Figure { columns: 3, panel_size: (290, 440), ..figure })
}

/// What the mesh covers; no hole in it is large enough to be seen.
fn outline(view: &View, mesh: &TriangleMesh, pose: &Pose) -> Vec<Vec<Place>> {
    let project = |corner: Point3| <[f64; 2]>::from(view.place(&pose.transform_point(&corner)));
    let triangles = (0..mesh.triangles().len()).map(|triangle| {
        let [a, b, c] = mesh.corners(triangle).map(project);
        // All turned alike, so that the rule counts covered places.
        let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if turn < 0.0 { vec![a, c, b] } else { vec![a, b, c] }
    });
    let shapes = triangles.collect::<Vec<_>>().simplify_shape(FillRule::NonZero);
    let places = |contour: &Vec<[f64; 2]>| contour.iter().map(|&[x, y]| (x, y)).collect();
    shapes.iter().filter_map(|shape| shape.first()).map(places).collect()
}

/// The points likely in contact or measured inside of the mesh, and the others, thinned.
fn points(
    view: &View,
    cloud: &Cloud,
    mesh: &Mesh,
    pose: &Pose,
    report: &Report,
) -> (Vec<Place>, Vec<Place>) {
    let likely = report.point_probabilities.a.iter().filter(|(_, p)| *p >= LIKELY);
    let likely: BTreeSet<usize> = likely.map(|(index, _)| *index).collect();
    let object_from_scene = pose.inverse();
    let mut squares: [BTreeMap<[i64; 2], Place>; 2] = Default::default();
    for (index, place) in view.slice(cloud) {
        let in_object = object_from_scene.transform_point(&cloud.point(index));
        let marked = likely.contains(&index) || mesh.signed_distance(&in_object) < 0.0;
        let square = [place.0, place.1].map(|v| (v / SQUARE).floor() as i64);
        squares[usize::from(!marked)].entry(square).or_insert(place);
    }
    let [marked, other] = squares.map(|of| of.into_values().collect());
    (marked, other)
}

/// An arrow at the likeliest contact whose normal lies in the picture.
fn arrow(view: &View, report: &Report) -> Option<Vec<Place>> {
    let contact = report.contacts.iter().find(|contact| {
        contact.probability >= LIKELY && contact.normal_a_to_b.dot(&view.towards_eye).abs() < 0.5
    })?;
    let along = contact.normal_a_to_b;
    let across = along.cross(&view.towards_eye);
    // Corners from the tail around the head and back, cm along and across.
    let corners =
        [[0.0, 0.1], [4.2, 0.1], [4.2, 0.5], [5.0, 0.0], [4.2, -0.5], [4.2, -0.1], [0.0, -0.1]];
    let place = |[a, b]: [f64; 2]| view.place(&(contact.point + 0.01 * (a * along + b * across)));
    Some(corners.map(place).to_vec())
}
