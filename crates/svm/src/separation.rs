//! Rung 0, the linear certificate: a plane that keeps every point of two clouds on its own side by
//! so many standard deviations that no kernel problem needs to be solved.

use cloudtouch_geom::{Covariance, Matrix3, Point3, UncertainPoint, Vector3, normal};

use crate::gjk::{Effort, separating_direction};

/// The κ at which a search usually stops: every probability is then below 1.1e-6.
pub const DEFAULT_KAPPA_MAX: f64 = 4.75;

/// A plane between two clouds, with a guarantee.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Separation {
    /// A point of the plane, in the frame of the clouds.
    pub point: Point3,
    /// Unit normal from cloud A to cloud B.
    pub normal: Vector3,
    /// Every point is at least this many of its standard deviations on its own side of the plane,
    /// exact points strictly so; positive, and at most the maximum asked for.
    pub kappa: f64,
}

impl Separation {
    /// Upper bound on the probability that any one point is on the wrong side: 1 − Φ(κ).
    ///
    /// This bounds the points one by one; it says nothing on the surface between them.
    pub fn point_probability_bound(&self) -> f64 {
        normal::upper_tail(self.kappa)
    }

    /// Distance from the plane, positive on the side of cloud A (as the decision function is).
    pub fn signed_distance(&self, point: &Point3) -> f64 {
        (self.point - point).dot(&self.normal)
    }
}

/// Finds a plane between two clouds that is as many standard deviations as possible, up to
/// `kappa_max`, from every point.
///
/// `None` when no plane with κ > 0 was found, when a cloud is empty, or when something is not
/// finite; it is no proof that the clouds touch. A returned κ is checked against every point, with
/// an allowance for rounding, whatever the search did; it can only be too small, usually by less
/// than one part in a thousand of the best possible.
///
/// The search asks whether the clouds of ellipsoids of radius κ can be separated, by GJK on the
/// difference of their hulls with the support function v·x ± κ|S v|: at once for `kappa_max`, and
/// failing that by climbing (each separating direction has an exact best κ, from which the next
/// search starts). Cost: a few passes over the points when `kappa_max` is reached, some dozens
/// otherwise.
pub fn separate(a: &[UncertainPoint], b: &[UncertainPoint], kappa_max: f64) -> Option<Separation> {
    if a.is_empty() || b.is_empty() || kappa_max.is_nan() || kappa_max <= 0.0 {
        return None;
    }
    let anchor = a[0].mean;
    let (side_a, side_b) = (Side::new(a, &anchor)?, Side::new(b, &anchor)?);
    let pair = Pair { a: &side_a, b: &side_b, kappa_max };
    let toward_a = side_a.middle - side_b.middle;
    let start = toward_a.try_normalize(0.0).unwrap_or_else(Vector3::x);
    let mut best = pair.best_kappa(&start);
    let mut direction = start;
    if best < kappa_max
        && let Some(found) = pair.direction_at(kappa_max, &start, Effort::First)
    {
        (direction, best) = (found, pair.best_kappa(&found));
    }
    if best < kappa_max {
        best = best.max(0.0);
        for _ in 0..MAX_CLIMBS {
            let Some(found) = pair.direction_at(best, &direction, Effort::Closest) else { break };
            let kappa = pair.best_kappa(&found);
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
    pair.plane(&direction, &anchor)
}

/// Climbing converges quadratically; this bound only guards against rounding.
const MAX_CLIMBS: usize = 24;
/// Share of κ given up to keep exact points strictly on their side.
const BACK_OFF: f64 = 1e-4;

/// One cloud relative to the anchor.
struct Side {
    points: Vec<(Vector3, Matrix3)>,
    middle: Vector3,
}

impl Side {
    fn new(cloud: &[UncertainPoint], anchor: &Point3) -> Option<Self> {
        let finite = |p: &UncertainPoint| {
            p.mean.iter().all(|v| v.is_finite()) && Covariance::is_finite(&p.covariance)
        };
        if !cloud.iter().all(finite) {
            return None;
        }
        let points: Vec<_> =
            cloud.iter().map(|p| (p.mean - anchor, p.covariance.matrix())).collect();
        let middle = points.iter().map(|p| p.0 / points.len() as f64).sum();
        Some(Self { points, middle })
    }

    /// Lowest n·x − κ|S n| over the points, with the point and the |S n| it is reached at.
    fn lowest(&self, n: &Vector3, kappa: f64) -> (f64, Vector3, f64) {
        let mut best = (f64::INFINITY, 0, 0.0);
        for (index, (x, covariance)) in self.points.iter().enumerate() {
            let std = std_along(covariance, n);
            let value = n.dot(x) - kappa * std;
            if value < best.0 {
                best = (value, index, std);
            }
        }
        let (value, index, std) = best;
        let (x, covariance) = &self.points[index];
        let inward = if std > 0.0 { covariance * n * (kappa / std) } else { Vector3::zeros() };
        (value, x - inward, std)
    }
}

fn std_along(covariance: &Matrix3, n: &Vector3) -> f64 {
    n.dot(&(covariance * n)).max(0.0).sqrt()
}

struct Pair<'a> {
    a: &'a Side,
    b: &'a Side,
    kappa_max: f64,
}

impl Pair<'_> {
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
        let mut kappa = self.kappa_max;
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

    /// The plane across `direction` (from B to A) with the better κ of two: in the middle of the
    /// width left at the best κ, or of that left at a slightly smaller one. Where an exact point
    /// bounds the best κ it lies on the first plane itself, and only the second keeps clear of it.
    fn plane(&self, direction: &Vector3, anchor: &Point3) -> Option<Separation> {
        let kappa = self.best_kappa(direction);
        if !kappa.is_finite() {
            return None;
        }
        let middle = |kappa: f64| {
            let low_a = self.a.lowest(direction, kappa).0;
            let high_b = -self.b.lowest(&-direction, kappa).0;
            let offset = 0.5 * (low_a + high_b);
            let of_a = self.certified(self.a, direction, offset);
            (of_a.min(self.certified(self.b, &-direction, -offset)), offset)
        };
        let (mut certified, mut offset) = middle(kappa);
        if certified < kappa * (1.0 - BACK_OFF) {
            (certified, offset) = middle(kappa * (1.0 - BACK_OFF));
        }
        (certified > 0.0).then(|| Separation {
            point: anchor + direction * offset,
            normal: -direction,
            kappa: certified,
        })
    }

    /// Least (n·x − offset)/std over a side, margins shortened by what rounding can have added.
    fn certified(&self, side: &Side, n: &Vector3, offset: f64) -> f64 {
        let ratio = |(x, covariance): &(Vector3, Matrix3)| {
            let rounding = 8.0 * f64::EPSILON * (x.norm() + offset.abs());
            let margin = n.dot(x) - offset - rounding;
            let std = std_along(covariance, n);
            // Also sorts out 0/0: a point on the plane is not on its own side.
            if margin > 0.0 { margin / std } else { f64::NEG_INFINITY }
        };
        side.points.iter().map(ratio).fold(self.kappa_max, f64::min)
    }
}
