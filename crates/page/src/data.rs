//! What the viewer in the page is given: JSON, with long lists as base64 of little endian bytes.

use std::collections::BTreeMap;

use cloudtouch::Contact;
use cloudtouch::geom::{Point3, Pose};
use serde::Serialize;

use crate::body::{Body, Shape};
use crate::coarse::coarse;
use crate::page::Page;
use crate::thin::drawn;
use crate::upright::{Upright, upright};
use crate::view::View;
use crate::{MOST_LIKELY, MOST_POINTS, MOST_TRIANGLES, encode};

/// Points that are less likely have no colour.
const LEAST_LIKELY: f64 = 0.01;

/// All that is drawn.
#[derive(Serialize)]
pub(crate) struct Data<'a> {
    start: usize,
    bodies: Vec<Drawn<'a>>,
    views: Vec<Posed<'a>>,
}

/// A body; positions are about its middle.
#[derive(Serialize)]
struct Drawn<'a> {
    name: &'a str,
    middle: [f64; 3],
    /// 3 × f32 each, m.
    positions: String,
    /// 3 × u32 each; a cloud has none.
    triangles: Option<String>,
    /// u8 each.
    brightness: Option<String>,
}

/// A pose of an object in a scene.
#[derive(Serialize)]
struct Posed<'a> {
    name: &'a str,
    scene: usize,
    object: usize,
    /// Of its scene.
    upright: Upright,
    /// Object to scene, row by row.
    pose: [f64; 16],
    probability: f64,
    bounds: [f64; 2],
    contacts: Vec<Patch>,
    /// Of the scene and of the object.
    likely: [Likely; 2],
}

#[derive(Serialize)]
struct Patch {
    point: [f64; 3],
    normal: [f64; 3],
    probability: f64,
    /// Of a disc of the same area, m.
    radius: Option<f64>,
}

/// Points with a probability: u32 among the points that are drawn, and u8 in parts of 255.
#[derive(Default, Serialize)]
struct Likely {
    points: String,
    probabilities: String,
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
    let mut known: BTreeMap<usize, Upright> = BTreeMap::new();
    let mut of_scene = |scene: usize| {
        let found = || page.bodies.get(scene).map_or(Upright::Z, |of| upright(of.shape.points()));
        *known.entry(scene).or_insert_with(found)
    };
    let views = page.views.iter().zip(&listed);
    let views = views.map(|(view, likely)| posed(view, of_scene(view.scene), likely, &chosen));
    (Data { start: page.start, bodies, views: views.collect() }, notes)
}

/// How much of something each body may have, where all together may have no more than a limit.
struct Share {
    total: usize,
    limit: usize,
}

impl Share {
    fn of(counts: impl Iterator<Item = usize>, limit: usize) -> Self {
        Self { total: counts.sum(), limit }
    }

    fn of_one(&self, count: usize) -> usize {
        if self.total <= self.limit {
            return count;
        }
        (count as u128 * self.limit as u128 / self.total as u128) as usize
    }
}

/// Points of scene and object that have a colour in a view, the likeliest where there are too many.
fn listed(view: &View<'_>, most: usize, notes: &mut Vec<String>) -> [Vec<(usize, f64)>; 2] {
    let all = &view.report.point_probabilities;
    [&all.a, &all.b].map(|points| {
        let mut points: Vec<(usize, f64)> =
            points.iter().copied().filter(|(_, p)| *p >= LEAST_LIKELY).collect();
        if points.len() > most / 2 {
            points.sort_by(|(i, p), (j, q)| q.total_cmp(p).then(i.cmp(j)));
            points.truncate(most / 2);
            points.sort_by_key(|(index, _)| *index);
            notes.push(format!(
                "In a pose no more than the {} likeliest points of a cloud are coloured.",
                most / 2
            ));
        }
        points
    })
}

/// For every body the indices of the points that are drawn.
fn choose(
    page: &Page<'_>,
    listed: &[[Vec<(usize, f64)>; 2]],
    notes: &mut Vec<String>,
) -> Vec<Vec<usize>> {
    let mut likely: Vec<BTreeMap<usize, f64>> = vec![BTreeMap::new(); page.bodies.len()];
    for (view, points) in page.views.iter().zip(listed) {
        for (body, points) in [view.scene, view.object].into_iter().zip(points) {
            let Some(likely) = likely.get_mut(body) else { continue };
            for &(index, p) in points {
                let most = likely.entry(index).or_insert(p);
                *most = most.max(p);
            }
        }
    }
    let count = |body: &Body| match &body.shape {
        Shape::Cloud { points, .. } => points.len(),
        Shape::Mesh { .. } => 0,
    };
    let share = Share::of(page.bodies.iter().map(count), MOST_POINTS);
    let chosen = page.bodies.iter().zip(likely).map(|(body, likely)| {
        let (all, limit) = (count(body), share.of_one(count(body)));
        if limit < all {
            notes.push(format!(
                "{}: {limit} of {all} points are drawn; all were used for the answer.",
                body.name
            ));
        }
        drawn(all, limit, &likely.into_iter().collect::<Vec<_>>())
    });
    chosen.collect()
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
    Drawn { name: &body.name, middle: middle.coords.into(), positions, triangles, brightness }
}

fn posed<'a>(
    view: &'a View<'_>,
    upright: Upright,
    listed: &[Vec<(usize, f64)>; 2],
    chosen: &[Vec<usize>],
) -> Posed<'a> {
    let of = |body: usize, points: &Vec<(usize, f64)>| {
        chosen.get(body).map_or_else(Likely::default, |chosen| likely(points, chosen))
    };
    Posed {
        name: &view.name,
        scene: view.scene,
        object: view.object,
        upright,
        pose: rows(&view.scene_from_object),
        probability: view.report.collision_probability,
        bounds: view.report.bounds,
        contacts: view.report.contacts.iter().map(patch).collect(),
        likely: [of(view.scene, &listed[0]), of(view.object, &listed[1])],
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

/// Those of the listed points that are drawn.
fn likely(listed: &[(usize, f64)], chosen: &[usize]) -> Likely {
    let among = |&(index, p): &(usize, f64)| Some((chosen.binary_search(&index).ok()? as u32, p));
    let points: Vec<(u32, f64)> = listed.iter().filter_map(among).collect();
    Likely {
        points: encode::indices(points.iter().map(|(index, _)| *index)),
        probabilities: encode::bytes(points.iter().map(|(_, p)| (255.0 * p).round() as u8)),
    }
}

/// A pose as a matrix, row by row.
pub(crate) fn rows(pose: &Pose) -> [f64; 16] {
    let matrix = pose.isometry().to_homogeneous();
    std::array::from_fn(|i| matrix[(i / 4, i % 4)])
}
