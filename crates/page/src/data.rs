//! What the viewer in the page is given: JSON, with long lists as base64 of little endian bytes.

use std::borrow::Cow;
use std::collections::BTreeMap;

use cloudtouch::Contact;
use cloudtouch::geom::{Point3, Pose};
use serde::Serialize;

use crate::body::{Body, Shape};
use crate::coarse::coarse;
use crate::likely::{Likely, likely, listed};
use crate::page::Page;
use crate::share::{Share, choose};
use crate::upright::{Upright, upright};
use crate::view::{Asked, Standing, View};
use crate::{MOST_LIKELY, MOST_TRIANGLES, encode, escape};

/// All that is drawn.
#[derive(Serialize)]
pub(crate) struct Data<'a> {
    start: usize,
    is_one_scene: bool,
    bodies: Vec<Drawn<'a>>,
    views: Vec<Posed<'a>>,
}

/// A body; positions are about its middle.
#[derive(Serialize)]
struct Drawn<'a> {
    name: Cow<'a, str>,
    middle: [f64; 3],
    /// 3 × f32 each, m.
    positions: String,
    /// 3 × u32 each; a cloud has none.
    triangles: Option<String>,
    /// u8 each.
    brightness: Option<String>,
}

/// A view.
#[derive(Serialize)]
struct Posed<'a> {
    name: Cow<'a, str>,
    /// The place about which all that is drawn is placed, m.
    middle: [f64; 3],
    upright: Upright,
    around: Vec<Placed>,
    asked: Option<Answered>,
}

/// An object in a scene, with the answer.
#[derive(Serialize)]
struct Answered {
    scene: Placed,
    object: Placed,
    probability: f64,
    bounds: [f64; 2],
    contacts: Vec<Patch>,
    /// Of the scene and of the object.
    likely: [Likely; 2],
}

#[derive(Serialize)]
struct Placed {
    body: usize,
    /// Body to picture, row by row.
    pose: [f64; 16],
}

#[derive(Serialize)]
struct Patch {
    point: [f64; 3],
    normal: [f64; 3],
    probability: f64,
    /// Of a disc of the same area, m.
    radius: Option<f64>,
}

/// What is drawn of a page, and what is to be said of what is left out.
pub(crate) fn of_page<'a>(page: &'a Page<'_>) -> (Data<'a>, Vec<String>) {
    let mut notes = Vec::new();
    let per_view = MOST_LIKELY / page.views.len().max(1);
    let listed: Vec<_> = page.views.iter().map(|view| listed(view, per_view, &mut notes)).collect();
    notes.dedup();
    let chosen = choose(page, &listed, &mut notes);
    let bodies = page.bodies.iter().zip(&chosen);
    let limits = Share::of(page.bodies.iter().map(|body| triangles(&body.shape)), MOST_TRIANGLES);
    let bodies = bodies.map(|(body, chosen)| draw(body, chosen, &limits, &mut notes)).collect();
    let mut known: BTreeMap<usize, ([f64; 3], Upright)> = BTreeMap::new();
    let views = page.views.iter().zip(&listed).map(|(view, likely)| {
        let still = still(view, page);
        let body = still.map_or(0, |still| still.body);
        let (middle, upright) = *known.entry(body).or_insert_with(|| stand(still, page));
        let around = view.around.iter().map(Placed::from).collect();
        let asked = view.asked.as_ref().map(|asked| answered(asked, likely, &chosen));
        Posed { name: escape::plain(&view.name), middle, upright, around, asked }
    });
    let views = views.collect();
    (Data { start: page.start, is_one_scene: page.is_one_scene, bodies, views }, notes)
}

/// The body that keeps its place in all views it is in: the scene, or the first of one scene.
fn still(view: &View<'_>, page: &Page<'_>) -> Option<Standing> {
    let is_first = |standing: &Standing| standing.body == 0;
    let first = if page.is_one_scene { view.standing().find(is_first) } else { None };
    first.or_else(|| view.standing().next())
}

/// Its middle in the picture, and which way is up in what is drawn of it.
fn stand(still: Option<Standing>, page: &Page<'_>) -> ([f64; 3], Upright) {
    let body = still.and_then(|still| Some((still.pose, page.bodies.get(still.body)?)));
    let Some((pose, body)) = body else { return ([0.0; 3], Upright::Z) };
    let points = body.shape.points();
    let placed: Vec<Point3> = points.iter().map(|point| pose.transform_point(point)).collect();
    let middle = pose.transform_point(&encode::middle(points));
    (middle.coords.into(), upright(&placed))
}

fn triangles(shape: &Shape) -> usize {
    match shape {
        Shape::Cloud { .. } => 0,
        Shape::Mesh { triangles, .. } => triangles.len(),
    }
}

fn draw<'a>(
    body: &'a Body,
    chosen: &[usize],
    limits: &Share,
    notes: &mut Vec<String>,
) -> Drawn<'a> {
    let middle = encode::middle(body.shape.points());
    let (positions, triangles, brightness) = match &body.shape {
        Shape::Cloud { points, brightness } => {
            let of = |values: &Vec<u8>| {
                encode::bytes(chosen.iter().map(|&i| values.get(i).copied().unwrap_or_default()))
            };
            let drawn = chosen.iter().map(|&i| &points[i]);
            (encode::positions(drawn, &middle), None, brightness.as_ref().map(of))
        }
        Shape::Mesh { vertices, triangles } => {
            let limit = limits.of_one(triangles.len());
            let (corners, faces) = coarse(vertices, triangles, limit);
            if faces.len() < triangles.len() {
                notes.push(format!(
                    "{}: drawn coarser, with {} instead of {} triangles; all were used for the answer.",
                    body.name,
                    faces.len(),
                    triangles.len()
                ));
            }
            let faces = encode::indices(faces.into_iter().flatten());
            (encode::positions(&corners, &middle), Some(faces), None)
        }
    };
    let name = escape::plain(&body.name);
    Drawn { name, middle: middle.coords.into(), positions, triangles, brightness }
}

fn answered(asked: &Asked<'_>, listed: &[Vec<(usize, f64)>; 2], chosen: &[Vec<usize>]) -> Answered {
    let of = |standing: &Standing, points: &Vec<(usize, f64)>| {
        chosen.get(standing.body).map_or_else(Likely::default, |chosen| likely(points, chosen))
    };
    let Asked { scene, object, report, .. } = asked;
    Answered {
        scene: scene.into(),
        object: object.into(),
        probability: report.collision_probability,
        bounds: report.bounds,
        contacts: report.contacts.iter().map(patch).collect(),
        likely: [of(scene, &listed[0]), of(object, &listed[1])],
    }
}

impl From<&Standing> for Placed {
    fn from(standing: &Standing) -> Self {
        Self { body: standing.body, pose: rows(&standing.pose) }
    }
}

fn patch(contact: &Contact) -> Patch {
    let Point3 { coords } = contact.point;
    Patch {
        point: coords.into(),
        normal: contact.normal_a_to_b.into(),
        probability: contact.probability,
        radius: contact.area_m2.map(|area| (area / std::f64::consts::PI).sqrt()),
    }
}

/// A pose as a matrix, row by row.
pub(crate) fn rows(pose: &Pose) -> [f64; 16] {
    let matrix = pose.isometry().to_homogeneous();
    std::array::from_fn(|i| matrix[(i / 4, i % 4)])
}
