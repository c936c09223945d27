//! How often a mesh wraps around a place: the generalised winding number of Jacobson, Kavan and
//! Sorkine-Hornung (2013), which asks nothing of edges and is defined for open meshes too.
//!
//! It is the sum of the solid angles of all triangles over 4π. Groups of triangles far from the
//! place count as one dipole each (Barill et al., 2018): their summed area vector at their centre.

use cloudtouch_geom::{Point3, Vector3};

/// Wrapped around at least so often a place is inside, and at most so often outside: halfway between
/// what a closed mesh has there and on its surface.
pub(super) const INSIDE: f64 = 0.75;
pub(super) const OUTSIDE: f64 = 0.25;

/// How many of its radii away a group counts as a dipole. The error falls with the square of it: in
/// the middle of a torus, where all groups err the same way, it is 0.036 at 3 and 0.008 at 6; the
/// latter takes three to seven times as long.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FarRadii(f64);

impl FarRadii {
    /// Sums are within 0.01.
    pub(super) const FINE: Self = Self(6.0);
    /// Sums are within 0.05: enough to tell whole numbers apart.
    pub(super) const COARSE: Self = Self(3.0);
}

/// Triangles that are summed one by one rather than halved further.
const MAX_LEAF: usize = 8;

/// The triangles of a mesh in groups of groups, for fast sums.
#[derive(Debug)]
pub(super) struct Winding {
    /// Every group before its halves, the first half right after it.
    pub(super) groups: Vec<Group>,
    /// Corners in the order of the groups.
    triangles: Vec<[Point3; 3]>,
}

#[derive(Debug)]
pub(super) struct Group {
    /// Mean of the centroids, weighted by area: no term of first order is left but the dipole's.
    pub(super) center: Point3,
    /// Sum of area times unit normal, m².
    pub(super) area: Vector3,
    /// Sum of areas, m².
    pub(super) size: f64,
    /// How far the farthest corner is from the centre, squared, m².
    pub(super) squared_radius: f64,
    /// Which triangles: from, to.
    pub(super) range: [usize; 2],
    /// The next group that shares no triangle with this one.
    pub(super) next: usize,
    pub(super) is_leaf: bool,
}

impl Winding {
    pub(super) fn new(mut triangles: Vec<[Point3; 3]>) -> Self {
        let mut groups = Vec::with_capacity(4 * triangles.len() / MAX_LEAF + 1);
        let mut waiting = vec![[0, triangles.len()]];
        while let Some([from, to]) = waiting.pop() {
            groups.push(Group::new(&triangles[from..to], from));
            if to - from > MAX_LEAF {
                let middle = halve(&mut triangles[from..to]) + from;
                waiting.extend([[middle, to], [from, middle]]);
            }
        }
        for i in (0..groups.len()).rev() {
            let after = |group: &Group| group.next;
            // A group ends where its second half does, which starts where the first one ends.
            let next =
                if groups[i].is_leaf { i + 1 } else { after(&groups[after(&groups[i + 1])]) };
            groups[i].next = next;
        }
        Self { groups, triangles }
    }

    /// The triangles it is of, in an order of its own.
    pub(super) fn triangles(&self) -> &[[Point3; 3]] {
        &self.triangles
    }

    /// The winding number around a place off the surface.
    pub(super) fn fast(&self, place: &Point3, FarRadii(radii): FarRadii) -> f64 {
        let (mut half_angles, mut dipoles) = (0.0, 0.0);
        let mut at = 0;
        while let Some(group) = self.groups.get(at) {
            let toward = group.center - place;
            let squared = toward.norm_squared();
            at = if squared > radii * radii * group.squared_radius {
                dipoles += group.area.dot(&toward) / (squared * squared.sqrt());
                group.next
            } else if group.is_leaf {
                let [from, to] = group.range;
                half_angles += half_angles_of(&self.triangles[from..to], place);
                group.next
            } else {
                at + 1
            };
        }
        (half_angles + 0.5 * dipoles) / std::f64::consts::TAU
    }

    /// The same by every triangle.
    pub(super) fn plain(&self, place: &Point3) -> f64 {
        Self::of_triangles(&self.triangles, place)
    }

    /// How often triangles wrap around a place.
    pub(super) fn of_triangles(triangles: &[[Point3; 3]], place: &Point3) -> f64 {
        half_angles_of(triangles, place) / std::f64::consts::TAU
    }
}

impl Group {
    /// A group of triangles, the first of which has the index `from`; what is after it is not known
    /// yet.
    fn new(triangles: &[[Point3; 3]], from: usize) -> Self {
        let (mut sum, mut weight, mut area) = (Vector3::zeros(), 0.0, Vector3::zeros());
        let base = triangles.first().map_or_else(Point3::origin, |t| t[0]);
        for triangle in triangles {
            let of_triangle = 0.5 * (triangle[1] - triangle[0]).cross(&(triangle[2] - triangle[0]));
            let size = of_triangle.norm();
            sum += (centroid(triangle) - base) * size;
            weight += size;
            area += of_triangle;
        }
        let center = if weight > 0.0 { base + sum / weight } else { base };
        let corners = triangles.iter().flatten();
        let squared_radius = corners.map(|p| (p - center).norm_squared()).fold(0.0, f64::max);
        Self {
            center,
            area,
            size: weight,
            squared_radius,
            range: [from, from + triangles.len()],
            next: 0,
            is_leaf: triangles.len() <= MAX_LEAF,
        }
    }
}

/// The middle of a triangle.
pub(super) fn centroid([a, b, c]: &[Point3; 3]) -> Point3 {
    a + ((b - a) + (c - a)) / 3.0
}

/// Orders triangles by their centroids along the longest side of these, and says where the second
/// half starts. The sort is stable: the result depends on nothing but the input.
fn halve(triangles: &mut [[Point3; 3]]) -> usize {
    let first = triangles.first().map_or_else(Point3::origin, centroid);
    let (low, high) = triangles
        .iter()
        .map(centroid)
        .fold((first, first), |(low, high), p| (low.inf(&p), high.sup(&p)));
    let axis = (high - low).imax();
    // PERF: a triangle takes nine numbers, and its centroid would be told for each comparison.
    triangles.sort_by_cached_key(|triangle| in_total_order(centroid(triangle)[axis]));
    triangles.len() / 2
}

/// Integers in the order that `f64::total_cmp` puts numbers in.
fn in_total_order(value: f64) -> i64 {
    let bits = value.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

/// Half the solid angles of triangles, summed, by the formula of Van Oosterom and Strackee (1983):
/// positive where a triangle shows its back.
fn half_angles_of(triangles: &[[Point3; 3]], place: &Point3) -> f64 {
    triangles
        .chunks(MAX_LEAF)
        .map(|few| few.iter().fold(Turned::NOT, |t, s| t.by(s, place)).angle())
        .sum()
}

/// An angle of any size, as a complex number and the whole turns that it leaves out.
///
/// PERF: numbers are multiplied where angles are added, so that one arc tangent tells the sum of many.
#[derive(Debug, Clone, Copy)]
struct Turned {
    real: f64,
    imaginary: f64,
    turns: f64,
}

impl Turned {
    const NOT: Self = Self { real: 1.0, imaginary: 0.0, turns: 0.0 };

    /// Turned on by half the solid angle of a triangle.
    #[inline(always)]
    fn by(self, triangle: &[Point3; 3], place: &Point3) -> Self {
        let [a, b, c] = [triangle[0] - place, triangle[1] - place, triangle[2] - place];
        let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
        let size = la * lb * lc;
        let denominator = size + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
        let numerator = a.cross(&b).dot(&c);
        // Seen from a corner or an edge of its own a triangle has no angle.
        if size == 0.0 || numerator == 0.0 && denominator == 0.0 {
            return self;
        }
        let (x, y) = (denominator / size, numerator / size);
        let (real, imaginary) =
            (self.real * x - self.imaginary * y, self.real * y + self.imaginary * x);
        // Two angles of one sign may make more than half a turn.
        let passed = match (self.imaginary >= 0.0, y >= 0.0, imaginary >= 0.0) {
            (true, true, false) => 1.0,
            (false, false, true) => -1.0,
            _ => 0.0,
        };
        Self { real, imaginary, turns: self.turns + passed }
    }

    fn angle(self) -> f64 {
        self.imaginary.atan2(self.real) + std::f64::consts::TAU * self.turns
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::TriangleMesh;
    use cloudtouch_testkit::scene;
    use proptest::prelude::*;

    use super::*;

    fn winding(mesh: &TriangleMesh) -> Winding {
        Winding::new((0..mesh.triangles().len()).map(|t| mesh.corners(t)).collect())
    }

    /// Closed, open in many places, of long and of short triangles.
    fn shapes() -> [TriangleMesh; 6] {
        let ball = scene::sphere(0.4, 4);
        let some = ball.triangles().iter().enumerate().filter(|(i, _)| i % 3 != 0);
        let holes = TriangleMesh::new(ball.vertices().to_vec(), some.map(|(_, &t)| t).collect());
        [
            scene::torus(0.3, 0.1, 48),
            holes.unwrap(),
            scene::plane_patch(0.8),
            scene::subdivide_to_max_edge(&scene::plane_patch(0.8), 0.05),
            scene::plate_with_hole(0.6, 0.05, 0.2),
            scene::piano(),
        ]
    }

    #[test]
    fn integers_are_in_the_order_of_numbers() {
        let numbers =
            [f64::NEG_INFINITY, -2.0, -1e-300, -0.0, 0.0, 1e-300, 1.0, 3.5, f64::INFINITY];
        assert!(numbers.is_sorted_by(|p, q| in_total_order(*p) < in_total_order(*q)));
        assert!(numbers.is_sorted_by(|p, q| p.total_cmp(q).is_lt()));
    }

    #[test]
    fn groups_hold_every_triangle_once() {
        for shape in shapes() {
            let winding = winding(&shape);
            assert_eq!(winding.triangles.len(), shape.triangles().len());
            let mut end = 0;
            for group in winding.groups.iter().filter(|group| group.is_leaf) {
                assert_eq!(group.range[0], end);
                end = group.range[1];
            }
            assert_eq!(end, shape.triangles().len());
            assert!(winding.groups.iter().enumerate().all(|(i, group)| group.next > i));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(400))]
        #[test]
        fn the_fast_sum_is_the_plain_one(
            shape in 0..6_usize, x in -1.0..1.0_f64, y in -1.0..1.0_f64, z in -1.0..1.0_f64,
        ) {
            static WINDINGS: std::sync::OnceLock<Vec<Winding>> = std::sync::OnceLock::new();
            let windings = WINDINGS.get_or_init(|| shapes().iter().map(winding).collect());
            let place = Point3::new(x, y, z);
            let plain = windings[shape].plain(&place);
            for (radii, error) in [(FarRadii::FINE, 0.01), (FarRadii::COARSE, 0.05)] {
                let fast = windings[shape].fast(&place, radii);
                prop_assert!((fast - plain).abs() < error, "{} not {}", fast, plain);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

        /// Few triangles about a place, so that many show more than half of what is seen of it.
        #[test]
        fn angles_that_are_multiplied_are_those_that_are_added(
            triangles in prop::collection::vec(prop::array::uniform9(-1.0..1.0_f64), 1..30),
            flat in any::<bool>(),
        ) {
            let flattened = |z: f64| if flat { (4.0 * z).round() / 4.0 } else { z };
            let corner = |t: &[f64; 9], k: usize| Point3::new(t[3 * k], t[3 * k + 1], flattened(t[3 * k + 2]));
            let triangles: Vec<_> = triangles.iter().map(|t| [0, 1, 2].map(|k| corner(t, k))).collect();
            let place = Point3::new(0.1, -0.05, 0.0);
            let half_angle = |triangle: &[Point3; 3]| {
                let [a, b, c] = triangle.map(|p| p - place);
                let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
                let denominator = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
                a.cross(&b).dot(&c).atan2(denominator)
            };
            let added: f64 = triangles.iter().map(half_angle).sum();
            let off = (half_angles_of(&triangles, &place) - added).abs();
            // In the plane of a triangle either side may be told: all of it more or less.
            let whole = (off / std::f64::consts::TAU).round() * std::f64::consts::TAU;
            prop_assert!((off - if flat { whole } else { 0.0 }).abs() < 1e-9, "{off}");
        }
    }

    /// Where the errors of all groups add up.
    #[test]
    fn in_the_middle_of_a_torus_the_fast_sum_is_the_plain_one() {
        let torus = winding(&scene::torus(0.3, 0.1, 48));
        assert!(torus.fast(&Point3::origin(), FarRadii::FINE).abs() < 0.01);
        assert!(torus.fast(&Point3::origin(), FarRadii::COARSE).abs() < 0.05);
    }

    #[test]
    fn triangles_on_one_another_end_the_halving() {
        let corners = [Point3::origin(), Point3::new(1.0, 0.0, 0.0), Point3::new(0.0, 1.0, 0.0)];
        let winding = Winding::new(vec![corners; 1000]);
        assert!(winding.groups.len() < 1000);
        let place = Point3::new(0.2, 0.2, 9.0);
        let [fast, plain] = [winding.fast(&place, FarRadii::FINE), winding.plain(&place)];
        assert!((fast / plain - 1.0).abs() < 0.01, "{fast} not {plain}");
    }
}
