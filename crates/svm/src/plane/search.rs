//! The search for the plane between two clouds of ellipsoids.

use cloudtouch_geom::{Covariance, Point3, UncertainPoint, Vector3};

use crate::plane::gjk::{Effort, separating_direction};

/// Climbing converges quadratically; this bound only guards against rounding.
const MAX_CLIMBS: usize = 24;
/// Share of κ given up to keep exact points strictly on their side.
const BACK_OFF: f64 = 1e-4;
/// Shares of κ given up, one after the other while too little can be certified: none; what keeps clear of
/// exact points; and more far from the origin, where the plane itself is rounded.
const BACK_OFFS: [f64; 4] = [0.0, BACK_OFF, 1e-2, 0.5];

/// No κ beyond this is searched for: one that falls from farther off has lost the digits of a small one.
const LARGEST_SEARCHED: f64 = 1e9;

/// Share of a length, or of a standard deviation, that rounding can have added or taken.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// One cloud relative to the anchor.
pub(crate) struct Side {
    points: Vec<(Vector3, Covariance)>,
    middle: Vector3,
}

impl Side {
    /// Of a cloud that is not empty, and finite.
    pub(crate) fn new(cloud: &[UncertainPoint], anchor: &Point3) -> Self {
        let points: Vec<_> = cloud.iter().map(|p| (p.mean - anchor, p.covariance)).collect();
        let middle = points.iter().map(|p| p.0 / points.len() as f64).sum();
        Self { points, middle }
    }

    /// Lowest n·x − κ|S n| over the points, with the point and the |S n| it is reached at.
    fn lowest(&self, n: &Vector3, kappa: f64) -> (f64, Vector3, f64) {
        let mut best = (f64::INFINITY, 0, 0.0);
        for (index, (x, covariance)) in self.points.iter().enumerate() {
            let std = covariance.std_along(n);
            let value = n.dot(x) - kappa * std;
            if value < best.0 {
                best = (value, index, std);
            }
        }
        let (value, index, std) = best;
        let (x, covariance) = &self.points[index];
        let inward =
            if std > 0.0 { covariance.matrix() * n * (kappa / std) } else { Vector3::zeros() };
        (value, x - inward, std)
    }
}

/// A plane by its unit normal from B to A and a point of it.
pub(crate) struct Found {
    pub(crate) direction: Vector3,
    /// As coordinates can hold it: far from the origin not quite where it was meant to be.
    pub(crate) point: Point3,
    /// What was certified; not positive where rounding leaves nothing.
    pub(crate) kappa: f64,
}

pub(crate) struct Pair<'a> {
    /// Relative to the anchor, as the other.
    pub(crate) a: &'a Side,
    pub(crate) b: &'a Side,
    pub(crate) anchor: Point3,
    /// As asked for.
    pub(crate) kappa_max: f64,
}

impl Pair<'_> {
    /// The largest κ to search for.
    fn top(&self) -> f64 {
        self.kappa_max.min(LARGEST_SEARCHED)
    }

    /// The best plane there is time for; `None` when no direction separates the means.
    pub(crate) fn best_plane(&self) -> Option<Found> {
        let kappa_max = self.top();
        let toward_a = self.a.middle - self.b.middle;
        let start = toward_a.try_normalize(0.0).unwrap_or_else(Vector3::x);
        let mut best = self.best_kappa(&start);
        let mut direction = start;
        if best < kappa_max
            && let Some(found) = self.direction_at(kappa_max, &start, Effort::First)
        {
            (direction, best) = (found, self.best_kappa(&found));
        }
        if best < kappa_max {
            best = best.max(0.0);
            for _ in 0..MAX_CLIMBS {
                let Some(found) = self.direction_at(best, &direction, Effort::Closest) else {
                    break;
                };
                let kappa = self.best_kappa(&found);
                if kappa <= best {
                    break;
                }
                let gained = kappa - best;
                (direction, best) = (found, kappa);
                if best >= kappa_max || gained <= 1e-5 * best {
                    break;
                }
            }
        }
        self.plane(&direction)
    }

    /// A direction from B to A that separates the ellipsoids of radius `kappa`.
    fn direction_at(&self, kappa: f64, start: &Vector3, effort: Effort) -> Option<Vector3> {
        let lowest = |n: &Vector3| self.a.lowest(n, kappa).1 - self.b.lowest(&-n, kappa).1;
        separating_direction(lowest, start, effort)
    }

    /// The largest κ up to the maximum for which planes across `n` separate; −∞ for none.
    ///
    /// The free width between the two clouds of ellipsoids is concave and falling in κ, so Newton's
    /// method from above falls onto its root in finitely many steps.
    fn best_kappa(&self, n: &Vector3) -> f64 {
        let mut kappa = self.top();
        for _ in 0..64 {
            let (low_a, _, std_a) = self.a.lowest(n, kappa);
            let (low_b, _, std_b) = self.b.lowest(&-n, kappa);
            let width = low_a + low_b;
            if width >= 0.0 {
                break;
            }
            let next = kappa + width / (std_a + std_b);
            if !next.is_finite() {
                return f64::NEG_INFINITY;
            }
            if next >= kappa {
                break;
            }
            kappa = next;
        }
        kappa
    }

    /// The plane across `direction` (from B to A) with the best κ of some: in the middle of the width left
    /// at the best κ, or of that left at a smaller one. Where an exact point bounds the best κ it lies on
    /// the first plane itself, and only the others keep clear of it.
    fn plane(&self, direction: &Vector3) -> Option<Found> {
        let kappa = self.best_kappa(direction);
        if !kappa.is_finite() || kappa < 0.0 {
            return None;
        }
        let mut best: Option<Found> = None;
        for share in BACK_OFFS {
            let found = self.middle(direction, kappa * (1.0 - share));
            let is_enough = found.kappa >= kappa * (1.0 - share - BACK_OFF);
            if best.as_ref().is_none_or(|best| found.kappa > best.kappa) {
                best = Some(found);
            }
            if is_enough {
                break;
            }
        }
        best
    }

    /// The plane in the middle of the width left at a κ, with what can be certified of it.
    fn middle(&self, direction: &Vector3, kappa: f64) -> Found {
        let low_a = self.a.lowest(direction, kappa).0;
        let high_b = -self.b.lowest(&-direction, kappa).0;
        let point = self.anchor + direction * (0.5 * (low_a + high_b));
        let from_anchor = point - self.anchor;
        let of_a = self.certified(self.a, direction, &from_anchor);
        let of_b = self.certified(self.b, &-direction, &from_anchor);
        Found { direction: *direction, point, kappa: of_a.min(of_b) }
    }

    /// Least n·(x − point)/std over a side, margins shortened and standard deviations lengthened by what
    /// rounding can have done to them. The point is the one that is returned, not the one aimed at.
    fn certified(&self, side: &Side, n: &Vector3, point: &Vector3) -> f64 {
        let ratio = |(x, covariance): &(Vector3, Covariance)| {
            let margin = n.dot(&(x - point)) - ROUNDING * (x.norm() + point.norm());
            // Also sorts out 0/0: a point on the plane is not on its own side.
            if margin > 0.0 { margin / longest_std(covariance, n) } else { f64::NEG_INFINITY }
        };
        side.points.iter().map(ratio).fold(self.kappa_max, f64::min)
    }
}

/// |S n| with an allowance for rounding: of the products for a covariance that knows its axes, of the
/// variance n·Σn where only the summed matrix is left, whose entries are rounded themselves.
fn longest_std(covariance: &Covariance, n: &Vector3) -> f64 {
    let bound = covariance.std_bound();
    let std = covariance.std_along(n);
    if covariance.isotropic_variance().is_some() || covariance.axis_form().is_some() {
        std + ROUNDING * bound
    } else {
        std.hypot(ROUNDING.sqrt() * bound)
    }
}
