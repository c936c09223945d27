//! Points on a mesh where it faces a cloud, as dense as that cloud is there (section 6 of the
//! paper takes vertices and centroids, which miss a large triangle pierced in its interior).

use std::cmp::Ordering;

use cloudtouch_geom::Point3;

use crate::error::SubdivisionError;

/// Outside the core an edge may be this long for each metre it is away: the farther a sample, the
/// less its exact place matters to a surface near the cloud leaf.
const GRADING: f64 = 0.5;
/// Edges whose lengths differ by less than this part are as long as each other.
const TIED: f64 = 1e-9;
/// Deepest subdivision of one triangle: from 1e10 m, the largest, to nanometres. Only parts that
/// come near the leaf are split again, so that depth is cheap; a triangle of 1e9 m ended in parts of
/// metres at a quarter of that depth, with no corner near the cloud on it.
pub(super) const MAX_DEPTH: usize = 128;

/// Where and how densely a mesh is sampled, in the mesh's local frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SampleRegion {
    /// Middle of the cloud leaf.
    pub center: Point3,
    /// How far the cloud leaf reaches from there: within it samples are as dense as the cloud, m.
    pub core: f64,
    /// How far from there samples matter, m.
    pub radius: f64,
    /// No edge of a subdivided triangle within the core is longer than this, m; beyond it edges
    /// may grow with the distance from it.
    pub spacing: f64,
}

impl SampleRegion {
    /// No place of a triangle is nearer to the middle than this, m; negative where one may be anywhere.
    pub(super) fn away(&self, corners: &[Point3; 3]) -> f64 {
        let centroid = centroid(corners);
        let reach = corners.iter().map(|p| (p - centroid).norm()).fold(0.0, f64::max);
        (centroid - self.center).norm() - reach
    }

    /// The halves of a triangle so far [away](Self::away) that is too large to be sampled as it is, and may
    /// be split so often.
    pub(super) fn split(
        &self,
        corners: &[Point3; 3],
        away: f64,
        depth: usize,
    ) -> Option<[[Point3; 3]; 2]> {
        let limit = self.spacing.max(GRADING * (away - self.core));
        let (longest, halves) = halved(corners);
        halves.filter(|_| longest > limit && depth > 0)
    }
}

fn centroid([a, b, c]: &[Point3; 3]) -> Point3 {
    Point3::from((a.coords + b.coords + c.coords) / 3.0)
}

/// Where a triangle that is small enough is sampled: its corners and its centroid.
pub(super) fn samples_of(corners: [Point3; 3]) -> [Point3; 4] {
    let [a, b, c] = corners;
    [a, b, c, centroid(&corners)]
}

/// Vertices and centroid of every part of `triangles` inside the region, after splitting them until
/// no edge is longer than the spacing.
///
/// # Errors
/// When that takes more than `max_parts` parts, those that were split or left out included; before
/// more than a few points for each of them are held in memory.
pub(crate) fn sample_region(
    triangles: impl IntoIterator<Item = [Point3; 3]>,
    region: &SampleRegion,
    max_parts: usize,
) -> Result<Vec<Point3>, SubdivisionError> {
    let mut samples = Samples { region, points: Vec::new(), parts: 0, max_parts };
    for corners in triangles {
        samples.split(corners, MAX_DEPTH);
    }
    if samples.parts > max_parts {
        return Err(SubdivisionError { spacing: region.spacing, max_parts });
    }
    merge_repeated(&mut samples.points);
    Ok(samples.points)
}

/// Corners and centroid of every triangle, those that are shared once (section 4.5 as printed).
pub(crate) fn four_per_triangle(triangles: impl IntoIterator<Item = [Point3; 3]>) -> Vec<Point3> {
    let mut points: Vec<Point3> = triangles.into_iter().flat_map(samples_of).collect();
    merge_repeated(&mut points);
    points
}

/// The length of the longest edge of a triangle, m, and its halves across that, so that a thin one falls into
/// no more parts than it is long; `None` where rounding keeps the edge from becoming shorter.
pub(super) fn halved(corners: &[Point3; 3]) -> (f64, Option<[[Point3; 3]; 2]>) {
    let corner = |k: usize| corners[k % 3];
    let lengths = [0, 1, 2].map(|k| (corner(k + 1) - corner(k)).norm());
    // Of those that are as long the first of the file: rounding, and with it the frame, is not to choose.
    let is_longer = |k: usize, than: usize| lengths[k] > lengths[than] * (1.0 + TIED);
    let long = (0..3).fold(0, |most, k| if is_longer(k, most) { k } else { most });
    let (from, to, other) = (corner(long), corner(long + 1), corner(long + 2));
    let middle = nalgebra::center(&from, &to);
    let is_split = middle != from && middle != to;
    (lengths[long], is_split.then_some([[from, middle, other], [middle, to, other]]))
}

/// Samples in the making.
struct Samples<'a> {
    region: &'a SampleRegion,
    points: Vec<Point3>,
    /// Triangles looked at so far, before and after splitting.
    parts: usize,
    max_parts: usize,
}

impl Samples<'_> {
    fn split(&mut self, corners: [Point3; 3], depth: usize) {
        self.parts = self.parts.saturating_add(1);
        if self.parts > self.max_parts {
            return;
        }
        let region = self.region;
        let away = region.away(&corners);
        if away > region.radius {
            return;
        }
        match region.split(&corners, away, depth) {
            Some(halves) => halves.into_iter().for_each(|half| self.split(half, depth - 1)),
            None => {
                let inside = |p: &Point3| (p - region.center).norm() <= region.radius;
                self.points.extend(samples_of(corners).into_iter().filter(inside));
            }
        }
    }
}

/// Neighbouring parts share their corners; each is wanted once.
fn merge_repeated(points: &mut Vec<Point3>) {
    points.sort_unstable_by(by_coordinates);
    points.dedup();
}

/// Zeros of either sign are one.
pub(super) fn by_coordinates(p: &Point3, q: &Point3) -> Ordering {
    let compare = |p: f64, q: f64| (p + 0.0).total_cmp(&(q + 0.0));
    compare(p.x, q.x).then_with(|| compare(p.y, q.y)).then_with(|| compare(p.z, q.z))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]
mod tests {
    use cloudtouch_geom::{Pose, Vector3, seed};

    use super::*;

    #[test]
    fn a_large_triangle_is_sampled_in_its_interior_and_only_there() {
        let corners = [Point3::origin(), Point3::new(10.0, 0.0, 0.0), Point3::new(0.0, 10.0, 0.0)];
        let region = SampleRegion {
            center: Point3::new(3.0, 3.0, 0.05),
            core: 0.3,
            radius: 0.3,
            spacing: 0.1,
        };
        let points = sample_region([corners], &region, 10_000).unwrap();
        assert!(points.len() > 30, "{} points", points.len());
        assert!(points.iter().all(|p| (p - region.center).norm() <= region.radius));
        // No hole: any spot of the disc has a sample within one spacing.
        for (dx, dy) in [(0.0, 0.0), (0.2, 0.0), (-0.1, 0.15), (0.0, -0.2)] {
            let spot = Point3::new(3.0 + dx, 3.0 + dy, 0.0);
            assert!(points.iter().any(|p| (p - spot).norm() <= 0.1), "hole at {spot}");
        }
        let mut unique = points.clone();
        unique.dedup();
        assert_eq!(unique.len(), points.len());
    }

    /// Rounding told which of two edges that are as long is the longest, and with it the frame that a mesh is written in.
    #[test]
    fn a_triangle_with_two_longest_edges_is_halved_alike_in_any_frame() {
        let corners = [[0.0, 0.0, 0.0], [0.02, 0.0, 0.0], [0.01, 0.05, 0.0]].map(Point3::from);
        for draw in 0..200 {
            let turn = [0, 1, 2].map(|k| 6.0 * seed::unit(seed::derive(3, draw, k)));
            let pose = Pose::from_translation_rpy(Vector3::new(1.3, -0.7, 2.9), turn);
            let (_, halves) = halved(&corners.map(|p| pose.transform_point(&p)));
            let middle = pose.inverse().transform_point(&halves.unwrap()[1][0]);
            let expected = nalgebra::center(&corners[1], &corners[2]);
            assert!((middle - expected).norm() < 1e-9, "{middle} for {expected}");
        }
    }

    #[test]
    fn a_triangle_of_kilometres_was_sampled_no_finer_than_metres() {
        let corners = [Point3::origin(), Point3::new(1e4, 0.0, 0.0), Point3::new(0.0, 1e4, 0.0)];
        let center = Point3::new(3000.0, 3000.0, 0.0);
        let region = SampleRegion { center, core: 0.1, radius: 0.2, spacing: 0.02 };
        let points = sample_region([corners], &region, 20_000).unwrap();
        let nearest = points.iter().map(|p| (p - center).norm()).fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.02 && points.len() > 50, "{} points, {nearest} m off", points.len());
    }

    #[test]
    fn a_triangle_of_the_largest_size_was_sampled_no_finer_than_metres() {
        let corners = [[-1e10, -1e10], [1e10, -1e10], [1e10, 1e10]];
        let corners = corners.map(|[x, y]| Point3::new(x, y, 0.0));
        for (x, y) in [(37.3, -11.9), (1e3, -9.9e9)] {
            let center = Point3::new(x, y, 0.001);
            let region = SampleRegion { center, core: 0.1, radius: 0.15, spacing: 0.01 };
            let points = sample_region([corners], &region, 20_000).unwrap();
            let nearest = points.iter().map(|p| (p - center).norm()).fold(f64::INFINITY, f64::min);
            assert!(nearest < 0.01 && points.len() > 300, "{}, {nearest} m off", points.len());
        }
    }

    #[test]
    fn far_from_the_leaf_samples_are_sparse() {
        let corners = [Point3::origin(), Point3::new(10.0, 0.0, 0.0), Point3::new(0.0, 10.0, 0.0)];
        let dense = SampleRegion {
            center: Point3::new(3.0, 3.0, 0.0),
            core: 2.0,
            radius: 2.0,
            spacing: 0.05,
        };
        let graded = SampleRegion { core: 0.1, ..dense };
        let (dense, graded) =
            [dense, graded].map(|r| sample_region([corners], &r, 1_000_000).unwrap()).into();
        assert!(graded.len() * 10 < dense.len(), "{} of {}", graded.len(), dense.len());
        let near = |p: &&Point3| (*p - Point3::new(3.0, 3.0, 0.0)).norm() < 0.1;
        assert_eq!(graded.iter().filter(near).count(), dense.iter().filter(near).count());
    }

    #[test]
    fn ten_million_parts_are_refused_before_they_are_held() {
        let corners = [Point3::origin(), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0)];
        let region = |spacing| SampleRegion {
            center: Point3::origin(),
            core: f64::INFINITY,
            radius: f64::INFINITY,
            spacing,
        };
        // Six splits make 64 parts of 127 triangles in all.
        assert!(sample_region([corners], &region(0.2), 127).is_ok());
        let error = sample_region([corners], &region(0.2), 126).unwrap_err();
        assert_eq!(error, SubdivisionError { spacing: 0.2, max_parts: 126 });
        // Ten triangles, a million parts each.
        for spacing in [1e-3, 0.0, -1.0, f64::NAN] {
            assert!(sample_region([corners; 10], &region(spacing), 1000).is_err());
        }
    }

    #[test]
    fn a_degenerate_triangle_ends_the_recursion() {
        let p = Point3::new(1.0, 0.0, 0.0);
        let region =
            SampleRegion { center: Point3::origin(), core: 2.0, radius: 2.0, spacing: 1e-3 };
        assert_eq!(sample_region([[p, p, p]], &region, 1), Ok(vec![p]));
    }
}
