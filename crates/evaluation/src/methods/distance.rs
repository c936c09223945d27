//! The least distance: between the points of two clouds, or of a cloud from a mesh, as measured or
//! after our own surface fit, in units of noise and spacing.

use std::num::NonZeroUsize;
use std::time::Instant;

use anyhow::{Result, anyhow};
use cloudtouch::Mesh;
use cloudtouch_geom::{Point3, Pose};
use cloudtouch_noise::{Neighborhoods, NoiseModel, Scratch, typical_spacing};
use cloudtouch_testkit::family::Observation;
use kiddo::{ImmutableKdTree, SquaredEuclidean};

use super::{Draw, Method, Prepared, cleaned, sensor_of};
use crate::answers::{Pair, Said};

/// Standard deviation of where the surface is along itself between samples, in spacings.
const DISC_STD: f64 = 0.35;
/// Points whose spacing stands for that of all.
const SPACING_SAMPLE: usize = 500;
/// Points of the second cloud are visited in strides of this.
const STRIDE: usize = 64;

/// The least distance, negative where a point is inside of a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distance {
    /// Whether points are first moved to where our noise model expects the surface.
    pub smoothed: bool,
}

impl Method for Distance {
    fn name(&self) -> String {
        if self.smoothed { "smoothed distance".into() } else { "distance".into() }
    }

    fn prepare(&self, draw: &Draw<'_>) -> Result<Prepared> {
        let [(a, unit_a), (b, unit_b)] =
            [points(draw.a, self.smoothed)?, points(draw.b, self.smoothed)?];
        let corners = draw.mesh.bounding_box().ok_or_else(|| anyhow!("a mesh of nothing"))?;
        let mesh = Mesh::prepare(draw.mesh)?;
        // −0 and 0 are one place.
        let entries: Vec<(u32, [f64; 3])> =
            (0..).zip(&a).map(|(i, p)| (i, p.coords.map(|v| v + 0.0).into())).collect();
        let index = ImmutableKdTree::new_from_entries(&entries);
        let index = index.map_err(|e| anyhow!("index: {e}"))?;
        // What one unit of distance is for two clouds, and for a cloud and a mesh, m.
        let scales = [unit_a.hypot(unit_b), unit_a].map(|scale| scale.max(1e-9));
        Ok(Box::new(move |pair, a_from_b| {
            let start = Instant::now();
            let (distance, scale) = match pair {
                Pair::CloudCloud => (to_points(&index, &b, a_from_b), scales[0]),
                Pair::CloudMesh => (to_mesh(&a, &mesh, corners, a_from_b), scales[1]),
            };
            Ok(Some(Said::score(-distance / scale, start)))
        }))
    }
}

/// The points, and a standard deviation of noise and sampling, m.
fn points(observation: &Observation, smoothed: bool) -> Result<(Vec<Point3>, f64)> {
    let cloud = cleaned(observation)?;
    let neighborhoods = Neighborhoods::new(cloud.points.clone())?;
    let unit = observation.std.hypot(DISC_STD * typical_spacing(&neighborhoods, SPACING_SAMPLE));
    if !smoothed {
        return Ok((cloud.points, unit));
    }
    let sensor = sensor_of(observation).covariances(&cloud)?;
    let (model, mut scratch) = (NoiseModel::default(), Scratch::default());
    let mut expected =
        |i| model.refine(i, &neighborhoods, &sensor, f64::INFINITY, &mut scratch).point.mean;
    Ok(((0..cloud.points.len()).map(&mut expected).collect(), unit))
}

/// The least distance of points from those of an index, m.
fn to_points(index: &ImmutableKdTree<f64, 3>, points: &[Point3], a_from_b: &Pose) -> f64 {
    let mut least = f64::MAX;
    // In strides, so that a close one comes early.
    for point in (0..STRIDE).flat_map(|start| points.iter().skip(start).step_by(STRIDE)) {
        let place: [f64; 3] = a_from_b.transform_point(point).coords.into();
        let nearest = index.query(&place).nearest_n::<SquaredEuclidean<f64>>(NonZeroUsize::MIN);
        // Each is sought no farther than the nearest so far.
        if let Some(hit) = nearest.within(least).execute().first() {
            least = least.min(hit.distance);
        }
    }
    least.sqrt()
}

/// The least signed distance of points from a mesh in a box with these corners, m.
fn to_mesh(points: &[Point3], mesh: &Mesh, (low, high): (Point3, Point3), a_from_b: &Pose) -> f64 {
    let b_from_a = a_from_b.inverse();
    let moved = points.iter().map(|p| b_from_a.transform_point(p));
    let to_box = |p: &Point3| {
        (0..3).map(|k| (low[k] - p[k]).max(p[k] - high[k]).max(0.0).powi(2)).sum::<f64>().sqrt()
    };
    let mut by_box: Vec<(f64, Point3)> = moved.map(|p| (to_box(&p), p)).collect();
    by_box.sort_by(|x, y| x.0.total_cmp(&y.0));
    let mut least = f64::INFINITY;
    for (at_least, point) in by_box {
        if at_least >= least && at_least > 0.0 {
            break;
        }
        least = least.min(mesh.signed_distance(&point));
    }
    least
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Vector3, seed};
    use cloudtouch_testkit::brute;
    use cloudtouch_testkit::family::{Family, Side};
    use cloudtouch_testkit::noise::NoiseKind;

    use super::*;

    #[test]
    fn distances_are_those_of_brute_force() {
        let scene = Family::SphereAndPlane.scene(3);
        let [a, b] =
            [Side::A, Side::B].map(|s| scene.observe(s, 300, NoiseKind::Gaussian, 0.002, 1));
        let draw = Draw { family: "x", a: &a, b: &b, mesh: scene.b.mesh() };
        let prepared = Distance { smoothed: false }.prepare(&draw).unwrap();
        let mesh = Mesh::prepare(scene.b.mesh()).unwrap();
        for i in 0..10 {
            let along = |k| 0.4 * seed::unit(seed::derive(9, i, k)) - 0.2;
            let offset = Vector3::new(along(0), along(1), 0.3 + along(2));
            let pose = Pose::from_translation_rpy(offset, [along(3), along(4), along(5)]);
            let said = |pair| prepared(pair, &pose).unwrap().unwrap().score;
            let moved: Vec<Point3> =
                b.cloud.points.iter().map(|p| pose.transform_point(p)).collect();
            let clouds = brute::minimum_distance(&a.cloud.points, &moved);
            let in_b = a.cloud.points.iter().map(|p| pose.inverse().transform_point(p));
            let to_mesh = in_b.map(|p| mesh.signed_distance(&p)).fold(f64::INFINITY, f64::min);
            // Both are divided by the same unit in every pose.
            for (pair, distance) in [(Pair::CloudCloud, clouds), (Pair::CloudMesh, to_mesh)] {
                let unit = -distance / said(pair);
                assert!(unit > 0.002 && unit < 0.1, "{pair:?}: {unit}");
            }
        }
    }
}
