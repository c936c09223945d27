//! Scene, object and contacts in colour, for any viewer that reads PLY.

use std::path::Path;

use anyhow::Result;
use cloudtouch::Report;
use cloudtouch::geom::{Point3, Pose, bounding_box};
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

/// A body, and the colours of the rows of its file, if it has any.
pub(crate) type Painted<'a, C> = (&'a Body<C>, Option<&'a [Color]>);

/// Writes both bodies in the scene's frame: clouds in their own colours or else the scene in grey and
/// the object in blue, meshes as meshes, points towards red by their probability, and each contact as
/// a green line along its normal; with the probability as a column too.
pub(crate) fn write<C: PreparedCloud>(
    path: &Path,
    scene: Painted<'_, C>,
    object: Painted<'_, C>,
    scene_from_object: &Pose,
    report: &Report,
) -> Result<()> {
    let likely = &report.point_probabilities;
    let mut picture = Picture::default();
    picture.add_body(scene, SCENE, &Pose::identity(), &likely.a);
    let first = picture.points.len();
    picture.add_body(object, OBJECT, scene_from_object, &likely.b);
    let arrow = ARROW_SHARE * extent(&picture.points[first..]);
    for contact in &report.contacts {
        for step in 0..ARROW_POINTS {
            let along = arrow * step as f64 / ARROW_POINTS as f64;
            let point = contact.point + contact.normal_a_to_b * along;
            picture.add(point, CONTACT, contact.probability);
        }
    }
    let Picture { points, colors, probabilities, triangles } = picture;
    Ok(write_colored_ply(path, &points, &colors, Some(&probabilities), &triangles)?)
}

/// Lists of one length, and triangles between the points.
#[derive(Default)]
struct Picture {
    points: Vec<Point3>,
    colors: Vec<Color>,
    probabilities: Vec<f64>,
    triangles: Vec<[u32; 3]>,
}

impl Picture {
    fn add(&mut self, point: Point3, color: Color, probability: f64) {
        self.points.push(point);
        self.colors.push(color);
        self.probabilities.push(probability);
    }

    /// A body where the pose puts it; points that are listed in `likely` by their index redder.
    fn add_body<C: PreparedCloud>(
        &mut self,
        (body, own): Painted<'_, C>,
        base: Color,
        pose: &Pose,
        likely: &[(usize, f64)],
    ) {
        let first = self.points.len();
        match body {
            Body::Cloud(cloud) => {
                let rows = cloud.file_rows();
                for (index, point) in cloud.points().iter().enumerate() {
                    let of_row = |row: &usize| own.and_then(|colors| colors.get(*row));
                    let color = rows.get(index).and_then(of_row).copied().unwrap_or(base);
                    self.add(pose.transform_point(point), color, 0.0);
                }
            }
            Body::Mesh(mesh) => {
                let (vertices, triangles) = mesh.faces();
                let shift = first as u32;
                self.triangles.extend(triangles.iter().map(|corners| corners.map(|c| c + shift)));
                vertices.iter().for_each(|p| self.add(pose.transform_point(p), base, 0.0));
            }
        }
        for &(index, probability) in likely {
            let color = &mut self.colors[first + index];
            *color = blend(*color, CERTAIN, probability);
            self.probabilities[first + index] = probability;
        }
    }
}

fn extent(points: &[Point3]) -> f64 {
    bounding_box(points).map_or(0.0, |(low, high)| (high - low).norm())
}

fn blend(from: Color, to: Color, share: f64) -> Color {
    std::array::from_fn(|k| {
        let (from, to) = (f64::from(from[k]), f64::from(to[k]));
        (from + (to - from) * share.clamp(0.0, 1.0)).round() as u8
    })
}
