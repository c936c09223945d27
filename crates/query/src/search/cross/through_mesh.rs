//! How a mesh passes through the disc about a sample, whatever triangles it is made of.

use cloudtouch_geom::{Point3, Vector3};

use super::reached::{Pull, Reached, passes_nearest};
use crate::search::compare::facet::Facet;
use crate::search::wrench::{Height, Wrench, force_at};

/// What a mesh does near a disc: how far it reaches on either side within the disc's outline, and
/// how near to the middle it passes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Through {
    /// The greatest height above the disc and the lowest below, m; zero where there is none.
    pub above: Height,
    pub below: Height,
    /// Distance from the middle of the disc to the nearest place where the mesh passes it, m;
    /// infinite where it does not.
    pub off: Height,
    /// That place.
    pub place: Point3,
}

/// A disc, seen along its normal.
#[derive(Debug, Clone, Copy)]
pub(in crate::search) struct Outline {
    middle: Point3,
    radius: f64,
    normal: Vector3,
    /// Two directions across the normal; any will do, for only lengths are told from them.
    across: [Vector3; 2],
}

impl Outline {
    pub(in crate::search) fn new(middle: Point3, normal: Vector3, radius: f64) -> Self {
        let first = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize();
        Self { middle, radius, normal, across: [first, normal.cross(&first)] }
    }

    /// Whether one of some facets passes the disc.
    pub(super) fn is_passed_by(&self, facets: &[Facet]) -> bool {
        facets.iter().any(|facet| {
            let ways = facet.corners.map(|corner| corner - self.middle);
            // Most are above the disc or below.
            let are_below = ways.map(|way| self.normal.dot(&way) < 0.0);
            if are_below == [are_below[0]; 3] {
                return false;
            }
            let corners = ways.map(|way| self.local(&way));
            !self.is_aside(&corners)
                && passes_nearest(&corners).is_some_and(|reached| self.is_within(&reached))
        })
    }

    fn is_within(&self, reached: &Reached) -> bool {
        reached.at.norm() <= self.radius
    }

    /// Adds up what some facets do; no height counts beyond the radius.
    pub(super) fn through<'a>(&self, facets: impl Iterator<Item = &'a Facet>) -> Through {
        let level = Reached { at: Vector3::zeros(), pulled_by: Pull::Known(Vector3::zeros()) };
        let (mut above, mut below, mut nearest) = (level, level, None);
        for facet in facets {
            // PERF: of a surface in many triangles few pass the disc, or reach farther than all before them.
            let heights = facet.corners.map(|corner| self.normal.dot(&(corner - self.middle)));
            let reaches = self.may_reach_beyond(heights, [below.at.z, above.at.z]);
            let is_astride = are_astride(heights);
            if !reaches && !is_astride {
                continue;
            }
            let Some(corners) = self.corners_not_aside(facet) else { continue };
            if reaches {
                self.visit_heights(facet, &corners, |reached| {
                    if reached.at.z > above.at.z {
                        above = reached;
                    }
                    if reached.at.z < below.at.z {
                        below = reached;
                    }
                });
            }
            let passes = || passes_nearest(&corners).filter(|reached| self.is_within(reached));
            if let Some(reached) = is_astride.then(passes).flatten() {
                let is_nearer = |known: Reached| reached.at.norm() < known.at.norm();
                if nearest.is_none_or(is_nearer) {
                    nearest = Some(reached);
                }
            }
        }
        let off = nearest.map_or(f64::INFINITY, |reached| reached.at.norm());
        Through {
            above: self.height(&above),
            below: self.height(&below),
            off: Height {
                value: off,
                by_pose: nearest.map_or_else(Wrench::zeros, |s| self.wrench(&s)),
            },
            place: nearest.map_or(self.middle, |reached| self.place(&reached.at)),
        }
    }

    /// Whether a facet with corners at these heights may reach lower or higher than known, where that still counts: in the outline as
    /// anywhere it is between its corners, but for rounding.
    fn may_reach_beyond(&self, [p, q, r]: [f64; 3], [below, above]: [f64; 2]) -> bool {
        /// Of its height and the disc's radius, generously.
        const ROUNDING: f64 = 1e-9;
        let (low, high) = (p.min(q).min(r), p.max(q).max(r));
        let slack = ROUNDING * (high - low + self.radius);
        above <= self.radius && high + slack > above || below >= -self.radius && low - slack < below
    }

    /// No height counts beyond the radius.
    fn height(&self, reached: &Reached) -> Height {
        let value = reached.at.z.clamp(-self.radius, self.radius);
        let is_within = value == reached.at.z;
        Height { value, by_pose: if is_within { self.wrench(reached) } else { Wrench::zeros() } }
    }

    fn wrench(&self, reached: &Reached) -> Wrench {
        force_at(&self.place(&reached.at), &self.vector(&reached.force(self.radius)))
    }

    fn place(&self, local: &Vector3) -> Point3 {
        self.middle + self.vector(local)
    }

    fn vector(&self, local: &Vector3) -> Vector3 {
        self.across[0] * local.x + self.across[1] * local.y + self.normal * local.z
    }

    /// Between which heights over the disc these facets are, m; `None` where they are all aside.
    pub(in crate::search) fn heights<'a>(
        &self,
        facets: impl Iterator<Item = &'a Facet>,
    ) -> Option<[f64; 2]> {
        let mut between = None;
        for facet in facets {
            let Some(corners) = self.corners_not_aside(facet) else { continue };
            self.visit_heights(facet, &corners, |Reached { at, .. }| {
                let z = at.z;
                let [low, high] = between.unwrap_or([z; 2]);
                between = Some([z.min(low), z.max(high)]);
            });
        }
        between
    }

    /// Most facets about a disc are on one side of the cylinder over it.
    fn is_aside(&self, corners: &[Vector3; 3]) -> bool {
        (0..3).any(|k| self.are_beyond(corners.map(|corner| corner[k])))
    }

    /// Whether all three are on one side of what lies as far from the middle as the disc reaches.
    fn are_beyond(&self, [p, q, r]: [f64; 3]) -> bool {
        let radius = self.radius;
        p > radius && q > radius && r > radius || p < -radius && q < -radius && r < -radius
    }

    /// The corners of a facet in the coordinates of the disc; `None` where they are all aside.
    fn corners_not_aside(&self, facet: &Facet) -> Option<[Vector3; 3]> {
        let [p, q, r] = &facet.corners;
        let ways = [p - self.middle, q - self.middle, r - self.middle];
        // PERF: many are told to be aside by one direction.
        let along = |axis: &Vector3| {
            let along = [axis.dot(&ways[0]), axis.dot(&ways[1]), axis.dot(&ways[2])];
            (!self.are_beyond(along)).then_some(along)
        };
        let [x, y, z] = [along(&self.across[0])?, along(&self.across[1])?, along(&self.normal)?];
        let corner = |k: usize| Vector3::new(x[k], y[k], z[k]);
        Some([corner(0), corner(1), corner(2)])
    }

    /// The heights that bound a facet within the cylinder.
    fn visit_heights(&self, facet: &Facet, corners: &[Vector3; 3], mut visit: impl FnMut(Reached)) {
        for k in 0..3 {
            let (from, to) = (&corners[k], &corners[(k + 1) % 3]);
            let Some(shares) = self.shares_within(from, to) else { continue };
            let along = to - from;
            for share in shares {
                let is_on_wall = share > 0.0 && share < 1.0;
                let pulled_by =
                    if is_on_wall { Pull::Wall(along) } else { Pull::Known(Vector3::z()) };
                visit(Reached { at: from + along * share, pulled_by });
            }
        }
        self.visit_steepest(facet, corners, visit);
    }

    /// The components of a vector across the normal and along it.
    fn local(&self, vector: &Vector3) -> Vector3 {
        let [x, y] = &self.across;
        Vector3::new(x.dot(vector), y.dot(vector), self.normal.dot(vector))
    }

    /// Where an edge enters the cylinder over the disc and leaves it, as shares of its length.
    fn shares_within(&self, from: &Vector3, to: &Vector3) -> Option<[f64; 2]> {
        let (p, d) = (from.xy(), to.xy() - from.xy());
        let (a, b, c) = (d.norm_squared(), p.dot(&d), p.norm_squared() - self.radius * self.radius);
        if a == 0.0 {
            return (c <= 0.0).then_some([0.0, 1.0]);
        }
        let discriminant = b * b - a * c;
        if discriminant < 0.0 {
            return None;
        }
        let root = discriminant.sqrt();
        let [start, end] = [((-b - root) / a).max(0.0), ((-b + root) / a).min(1.0)];
        (start <= end).then_some([start, end])
    }

    /// Where a facet's plane is highest and lowest on the rim of the disc, where these places are on
    /// the facet.
    fn visit_steepest(
        &self,
        facet: &Facet,
        corners: &[Vector3; 3],
        mut visit: impl FnMut(Reached),
    ) {
        let Some(normal) = facet.normal else { return };
        let n = self.local(&normal);
        let slope = n.xy().norm();
        if n.z.abs() < 1e-9 || slope == 0.0 {
            return;
        }
        let uphill = -n.xy() * (n.z.signum() / slope);
        for sign in [1.0, -1.0] {
            let at = uphill * (sign * self.radius);
            let side = |k: usize| {
                let (from, to) = (corners[k].xy(), corners[(k + 1) % 3].xy());
                (to - from).perp(&(at - from))
            };
            let sides = [side(0), side(1), side(2)];
            if sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0) {
                let z = corners[0].z - (n.xy().dot(&(at - corners[0].xy()))) / n.z;
                visit(Reached { at: Vector3::new(at.x, at.y, z), pulled_by: Pull::Rim(n) });
            }
        }
    }
}

/// Whether there are heights on either side of zero.
fn are_astride([p, q, r]: [f64; 3]) -> bool {
    let is_below = p < 0.0;
    is_below != (q < 0.0) || is_below != (r < 0.0)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn disc() -> Outline {
        Outline::new(Point3::origin(), Vector3::z(), 0.1)
    }

    fn facet(corners: [[f64; 3]; 3]) -> Facet {
        Facet::new(0, corners.map(Point3::from))
    }

    #[test]
    fn an_upright_sheet_is_as_high_and_deep_as_the_disc_is_wide() {
        let sheet = facet([[-9.0, 0.03, -9.0], [9.0, 0.03, -9.0], [0.0, 0.03, 9.0]]);
        let through = disc().through([sheet].iter());
        assert_eq!((through.above.value, through.below.value), (0.1, -0.1));
        assert!((through.off.value - 0.03).abs() < 1e-12 && through.place.z.abs() < 1e-12);
    }

    #[test]
    fn a_slanting_plane_rises_to_the_rim_whatever_its_triangles() {
        let height = |x: f64| 0.5 * x + 0.01;
        let corner = |x: f64, y: f64| [x, y, height(x)];
        let whole = [facet([corner(-9.0, -9.0), corner(9.0, -9.0), corner(0.0, 9.0)])];
        let grid = |i: i32| 0.013 * f64::from(i);
        let mut fine = Vec::new();
        for i in -20..20 {
            for j in -20..20 {
                let at = |di: i32, dj: i32| corner(grid(i + di), grid(j + dj));
                fine.push(facet([at(0, 0), at(1, 0), at(0, 1)]));
                fine.push(facet([at(1, 0), at(1, 1), at(0, 1)]));
            }
        }
        let (whole, fine) = (disc().through(whole.iter()), disc().through(fine.iter()));
        let of = |through: &Through| [through.above, through.below, through.off].map(|h| h.value);
        for (found, known) in of(&whole).into_iter().zip([0.06, -0.04, 0.02]) {
            assert!((found - known).abs() < 1e-12, "{found} {known}");
        }
        for (found, known) in of(&fine).into_iter().zip(of(&whole)) {
            assert!((found - known).abs() < 1e-9, "{found} {known}");
        }
    }

    #[test]
    fn a_thin_rod_between_samples_passes_and_one_beside_the_disc_does_not() {
        let rod = |x: f64| facet([[x, 0.0, -0.5], [x + 0.002, 0.0, 0.5], [x, 0.002, 0.5]]);
        let through = disc().through([rod(0.07)].iter());
        assert!(through.above.value > 0.09 && through.below.value < -0.09);
        assert!((through.off.value - 0.07).abs() < 2e-3);
        assert_eq!(disc().through([rod(0.12)].iter()).off.value, f64::INFINITY);
        let above = facet([[0.0, 0.0, 0.01], [0.2, 0.0, 0.01], [0.0, 0.2, 0.5]]);
        assert_eq!(disc().through([above].iter()).off.value, f64::INFINITY);
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn a_disc_is_passed_where_the_passage_has_a_place(
            corners in prop::array::uniform3(prop::array::uniform3(-0.2..0.2_f64)),
        ) {
            let facets = [facet(corners)];
            let through = disc().through(facets.iter());
            prop_assert_eq!(disc().is_passed_by(&facets), through.off.value.is_finite());
        }

        /// By the heights of all facets, of which most that come late change nothing.
        #[test]
        fn a_facet_is_left_out_only_where_it_changes_nothing(
            corners in prop::collection::vec(
                prop::array::uniform3(prop::array::uniform3(-0.2..0.2_f64)),
                1..12,
            ),
            flatter in prop_oneof![Just(1.0), 1e-3..0.5_f64],
        ) {
            let flat = |[x, y, z]: [f64; 3]| [x, y, flatter * z];
            let facets: Vec<Facet> = corners.iter().map(|c| facet(c.map(flat))).collect();
            let disc = disc();
            let through = disc.through(facets.iter());
            let [low, high] = disc.heights(facets.iter()).unwrap_or_default();
            prop_assert_eq!(through.above.value, high.clamp(0.0, disc.radius));
            prop_assert_eq!(through.below.value, low.clamp(-disc.radius, 0.0));
        }
    }
}
