//! Scene, object and contacts in colour, for any viewer that reads PLY.

use std::path::Path;

use anyhow::Result;
use cloudtouch::geom::{Point3, Pose};
use cloudtouch::{MAX_MESH_PARTS, Report};
use cloudtouch_io::write_colored_ply;

use crate::body::{Body, PreparedCloud};

type Color = [u8; 3];

const SCENE: Color = [170, 170, 170];
const OBJECT: Color = [70, 130, 220];
const CERTAIN: Color = [220, 30, 20];
const CONTACT: Color = [30, 200, 60];

/// Points along a contact's normal, and how far it reaches, as a share of the object.
const ARROW_POINTS: usize = 20;
const ARROW_SHARE: f64 = 0.15;
/// A mesh is drawn by points this far apart, as a share of its size.
const MESH_SPACING_SHARE: f64 = 0.01;

/// Writes the scene in grey, the object in blue, both towards red by the probability of each
/// point, and each contact as a green line along its normal; all in the scene's frame, with the
/// probability as a column too.
pub(crate) fn write<C: PreparedCloud>(
    path: &Path,
    scene: &Body<C>,
    object: &Body<C>,
    scene_from_object: &Pose,
    report: &Report,
) -> Result<()> {
    let likely = &report.point_probabilities;
    let object_points: Vec<Point3> =
        body_points(object)?.iter().map(|p| scene_from_object.transform_point(p)).collect();
    let arrow = ARROW_SHARE * extent(&object_points);
    let mut picture = Picture::default();
    picture.add_body(&body_points(scene)?, SCENE, &likely.a);
    picture.add_body(&object_points, OBJECT, &likely.b);
    for contact in &report.contacts {
        for step in 0..ARROW_POINTS {
            let along = arrow * step as f64 / ARROW_POINTS as f64;
            let point = contact.point + contact.normal_a_to_b * along;
            picture.add(point, CONTACT, contact.probability);
        }
    }
    let Picture { points, colors, probabilities } = picture;
    Ok(write_colored_ply(path, &points, &colors, Some(&probabilities))?)
}

/// Lists of one length.
#[derive(Default)]
struct Picture {
    points: Vec<Point3>,
    colors: Vec<Color>,
    probabilities: Vec<f64>,
}

impl Picture {
    fn add(&mut self, point: Point3, color: Color, probability: f64) {
        self.points.push(point);
        self.colors.push(color);
        self.probabilities.push(probability);
    }

    /// Points in `base`, those that are listed in `likely` by their index redder.
    fn add_body(&mut self, points: &[Point3], base: Color, likely: &[(usize, f64)]) {
        let first = self.points.len();
        points.iter().for_each(|&p| self.add(p, base, 0.0));
        for &(index, probability) in likely {
            self.colors[first + index] = blend(base, CERTAIN, probability);
            self.probabilities[first + index] = probability;
        }
    }
}

fn body_points<C: PreparedCloud>(body: &Body<C>) -> Result<Vec<Point3>> {
    Ok(match body {
        Body::Cloud(cloud) => cloud.points(),
        Body::Mesh(mesh) => {
            mesh.surface_points(MESH_SPACING_SHARE * mesh.size(), MAX_MESH_PARTS)?
        }
    })
}

fn extent(points: &[Point3]) -> f64 {
    let Some(&first) = points.first() else { return 0.0 };
    let (low, high) =
        points.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
    (high - low).norm()
}

fn blend(from: Color, to: Color, share: f64) -> Color {
    std::array::from_fn(|k| {
        let (from, to) = (f64::from(from[k]), f64::from(to[k]));
        (from + (to - from) * share.clamp(0.0, 1.0)).round() as u8
    })
}
