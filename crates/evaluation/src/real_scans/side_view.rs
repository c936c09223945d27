//! The scene and the object from the side: a slice through both, so that what looks like an overlap
//! is one.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use cloudtouch::{Cloud, Contact, Report};
use cloudtouch_geom::{Point3, Pose, TriangleMesh, Vector3};
use i_overlay::{
    core::{fill_rule::FillRule, overlay_rule::OverlayRule},
    float::single::SingleFloatOverlay,
};

use crate::{
    figure::{Axis, Figure, Panel, Place, RGBColor, Series, palette},
    statistics::quantile,
    table::verdict,
};

/// Into the table, as the camera sees it (x right, y down, z forward).
const DOWN: [f64; 3] = [0.05, 0.8, 0.6];
/// Half the thickness of the slice, m: that of a finger.
const SLICE: f64 = 0.01;
/// What is shown about the middle, cm: sideways, and from below the table upwards.
const SIDEWAYS: f64 = 9.0;
const HEIGHTS: std::ops::Range<f64> = -1.0..19.0;
/// Side of the squares of which no more than one point is drawn, cm.
const SQUARE: f64 = 0.4;
/// Points and contacts at least this likely are marked.
const LIKELY: f64 = 0.3;
/// Length of a contact's arrow, cm.
const ARROW: f64 = 4.0;

const GRIPPER: RGBColor = RGBColor(150, 195, 235);
const RED: RGBColor = RGBColor(215, 25, 28);

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
        let mut view = Self { middle, right: up.cross(&towards_eye), up, towards_eye, table: 0.0 };
        let heights: Vec<f64> = view.slice(cloud).map(|(_, (_, height))| height).collect();
        view.table = quantile(&heights, 0.05);
        (!heights.is_empty()).then_some(view).context("no measured point in the slice")
    }

    /// Sideways from the middle and above the table, cm.
    fn place(&self, point: &Point3) -> Place {
        let offset = 100.0 * (point - self.middle);
        (offset.dot(&self.right), offset.dot(&self.up) - self.table)
    }

    fn is_in_slice(&self, point: &Point3) -> bool {
        (point - self.middle).dot(&self.towards_eye).abs() < SLICE
    }

    /// The points of the slice that are in sight, by their index.
    fn slice<'a>(&'a self, cloud: &'a Cloud) -> impl Iterator<Item = (usize, Place)> + 'a {
        let in_slice = (0..cloud.len()).filter(|&i| self.is_in_slice(&cloud.point(i)));
        in_slice.map(|i| (i, self.place(&cloud.point(i)))).filter(|(_, (x, y))| {
            x.abs() < SIDEWAYS && (*y + self.table).abs() < HEIGHTS.end && *y < HEIGHTS.end
        })
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
    let figure =
        Figure::new("How likely does the gripper hit the mug? Three poses, seen from the side")
            .columns(3)
            .panel_size(310, 410);
    Ok(shown.iter().fold(figure, |figure, (pose, report)| {
        figure.panel(panel(&view, cloud, object, pose, report))
    }))
}

fn panel(view: &View, cloud: &Cloud, object: &TriangleMesh, pose: &Pose, report: &Report) -> Panel {
    let title = format!("P = {:.2}: {}", report.collision_probability, verdict(report.verdict));
    eprintln!(
        "DEBUG {} {}",
        report.collision_probability,
        report.point_probabilities.a.iter().filter(|(_, p)| *p > 0.3).count()
    );
    for (i, p) in &report.point_probabilities.a {
        let q = cloud.point(*i);
        if view.is_in_slice(&q) && *p > 0.01 {
            eprint!("{:?}:{:.2} ", view.place(&q), p);
        }
    }
    let (outlines, holes) = outline(view, object, pose);
    let (likely, other) = points(view, cloud, report);
    let panel = Panel::new(
        Axis::linear("sideways (cm)").range(-SIDEWAYS..SIDEWAYS),
        Axis::linear("height above the table (cm)").range(HEIGHTS),
    );
    panel
        .title(&title)
        .equal_aspect()
        .series(Series::polygons("gripper (known shape)", outlines).color(GRIPPER))
        .series(Series::polygons("", holes).color(RGBColor(255, 255, 255)))
        .series(Series::points("measured points of the scene", other).color(palette::GREY).size(2))
        .series(Series::points("points likely in contact", likely).color(RED).size(3))
        .series(
            Series::arrows("contact: place and direction", arrow(view, &report.contacts))
                .color(palette::BLACK),
        )
}

/// What the mesh covers, and the holes in it.
fn outline(view: &View, mesh: &TriangleMesh, pose: &Pose) -> (Vec<Vec<Place>>, Vec<Vec<Place>>) {
    let project = |corner: Point3| {
        let (x, y) = view.place(&pose.transform_point(&corner));
        [x, y]
    };
    let triangles = (0..mesh.triangles().len()).map(|triangle| {
        let [a, b, c] = mesh.corners(triangle).map(project);
        // All turned alike, so that the rule counts covered places.
        let turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if turn < 0.0 { vec![a, c, b] } else { vec![a, b, c] }
    });
    let (left, right) = (-SIDEWAYS, SIDEWAYS);
    let (low, high) = (HEIGHTS.start, HEIGHTS.end);
    let sight = vec![[left, low], [right, low], [right, high], [left, high]];
    let triangles: Vec<_> = triangles.collect();
    let shapes = triangles.overlay(&sight, OverlayRule::Intersect, FillRule::NonZero);
    let places = |contour: &Vec<[f64; 2]>| contour.iter().map(|&[x, y]| (x, y)).collect();
    let outer = shapes.iter().filter_map(|shape| shape.first()).map(places);
    (outer.collect(), shapes.iter().flat_map(|shape| &shape[1..]).map(places).collect())
}

/// The likely points and the others, thinned.
fn points(view: &View, cloud: &Cloud, report: &Report) -> (Vec<Place>, Vec<Place>) {
    let probabilities: BTreeMap<usize, f64> =
        report.point_probabilities.a.iter().copied().collect();
    let mut squares: BTreeMap<[i64; 2], (bool, Place)> = BTreeMap::new();
    for (index, place) in view.slice(cloud) {
        let is_likely = probabilities.get(&index).is_some_and(|&p| p >= LIKELY);
        let square = [place.0, place.1].map(|v| (v / SQUARE).floor() as i64);
        let held = squares.entry(square).or_insert((is_likely, place));
        if is_likely && !held.0 {
            *held = (true, place);
        }
    }
    let (likely, other): (Vec<_>, Vec<_>) = squares.into_values().partition(|held| held.0);
    let places = |held: Vec<(bool, Place)>| held.into_iter().map(|(_, place)| place).collect();
    (places(likely), places(other))
}

/// The likeliest contact whose normal lies in the picture.
fn arrow(view: &View, contacts: &[Contact]) -> Option<[Place; 2]> {
    let lies_in_picture = |contact: &&Contact| {
        contact.probability >= LIKELY
            && view.is_in_slice(&contact.point)
            && contact.normal_a_to_b.dot(&view.towards_eye).abs() < 0.5
    };
    contacts.iter().find(lies_in_picture).map(|contact| {
        let end = contact.point + contact.normal_a_to_b * (0.01 * ARROW);
        [view.place(&contact.point), view.place(&end)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outline_is_what_triangles_cover_and_its_holes() {
        // A square frame of eight triangles in the plane of the picture, some turned over.
        let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0]];
        let inner = corners.map(|[x, y]: [f64; 2]| [0.5 * x + 0.75, 0.5 * y + 0.75]);
        let all = corners.into_iter().chain(inner);
        let vertices = all.map(|[x, y]| Point3::new(0.01 * x, 0.01 * y, 0.0)).collect();
        let side = |i: u32| [[i, (i + 1) % 4, 4 + i], [4 + (i + 1) % 4, (i + 1) % 4, 4 + i]];
        let mesh = TriangleMesh::try_new(vertices, (0..4).flat_map(side).collect()).unwrap();
        let (right, up, towards_eye) = (Vector3::x(), Vector3::y(), Vector3::z());
        let view = View { middle: Point3::origin(), right, up, towards_eye, table: 0.0 };
        let (outer, holes) = outline(&view, &mesh, &Pose::identity());
        assert_eq!((outer.len(), holes.len()), (1, 1));
        let widest = |contour: &[Place]| contour.iter().map(|p| p.0).fold(0.0, f64::max);
        assert!((widest(&outer[0]) - 3.0).abs() < 1e-6);
        assert!((widest(&holes[0]) - 2.25).abs() < 1e-6);
    }
}
