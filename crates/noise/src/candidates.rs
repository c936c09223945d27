//! A first plane that outliers and second faces cannot bend: the best supported of a few.

use cloudtouch_geom::{Matrix3, Vector3};

use crate::patch::{Patch, Plane};
use crate::smallest_axis::smallest_axis;

/// Planes are laid through the point and each pair of this many nearest neighbours.
const PAIRED: usize = 8;
/// Planes are also laid through each three of this many.
const TRIPLED: usize = 6;
/// How many neighbours vote on a plane.
const VOTERS: usize = 19;
/// A voter farther off than this many standard deviations counts as off the plane, however far.
const CUT: f64 = 3.0;
/// By so much at most an outlier costs more the farther it is.
const TAIL: f64 = 0.1;
/// A plane that misses the point itself costs as much as one that misses this many voters.
const OWN_VOTES: f64 = 4.0;

/// The plane with the most support among the nearest neighbours; `None` when they are too few or
/// all on one line with the point.
///
/// Candidates pass through three places, so that one of them is likely to lie in one face even
/// where two meet: the point and two neighbours, or three neighbours, since the point itself may be
/// the outlier. With them goes the least-squares plane of the voters, which is the better start
/// where noise exceeds the spacing.
pub(crate) fn best_candidate(patch: &Patch) -> Option<Plane> {
    let voters = patch.nearest(patch.offsets.len().min(VOTERS));
    let scale = patch.largest_own_variance();
    let mut best = None;
    let mut best_cost = f64::INFINITY;
    let mut consider = |plane: Plane| {
        let cost = disagreement(&voters, &plane, scale, best_cost);
        if cost < best_cost {
            best_cost = cost;
            best = Some(plane);
        }
    };
    if let Some(plane) = least_squares(voters.offsets) {
        consider(plane);
    }
    let nearest = |count: usize| &voters.offsets[..voters.offsets.len().min(count)];
    let paired = nearest(PAIRED);
    for (j, b) in paired.iter().enumerate() {
        for a in &paired[..j] {
            if let Some(normal) = across(a, b) {
                consider(Plane { normal, height: 0.0 });
            }
        }
    }
    let tripled = nearest(TRIPLED);
    for (j, c) in tripled.iter().enumerate() {
        for (i, b) in tripled[..j].iter().enumerate() {
            for a in &tripled[..i] {
                if let Some(normal) = across(&(b - a), &(c - a)) {
                    consider(Plane { normal, height: normal.dot(a) });
                }
            }
        }
    }
    best
}

/// The truncated negative log-likelihood of the voters, given up once it reaches `enough`.
///
/// The logarithm matters where noise depends on direction: without it a plane facing the noisy
/// direction explains anything. `scale` makes it at most zero, so that an outlier costs the same
/// whatever the plane.
fn disagreement(voters: &Patch, plane: &Plane, scale: f64, enough: f64) -> f64 {
    let variance = voters.own_variance(&plane.normal);
    let narrowness = (variance / scale).ln();
    let (inverse, most) = (1.0 / variance, CUT * CUT);
    let floor = narrowness * voters.offsets.len() as f64;
    // The plane is to be the one the point is on, unless the point is far beyond its noise.
    let mut cost = capped(plane.height * plane.height * inverse, OWN_VOTES * most);
    for offset in voters.offsets {
        let residual = plane.normal.dot(offset) - plane.height;
        cost += capped(residual * residual * inverse + narrowness, most);
        // Every term left is at least the narrowness, and all of them together at least `floor`.
        if cost + floor.min(0.0) >= enough {
            return f64::INFINITY;
        }
    }
    cost
}

/// The cost up to the cap, and hardly more beyond it.
///
/// Where samples are far sharper than their spacing every plane misses all voters but those it was
/// laid through. Planes that cost the same to the last bit would be told apart by rounding, and the
/// surface would jump when the cloud is moved.
fn capped(cost: f64, most: f64) -> f64 {
    if cost <= most { cost } else { most + TAIL * (cost - most) / cost }
}

/// The direction across two others; `None` when they are nearly parallel, which would leave a
/// direction of rounding error.
fn across(a: &Vector3, b: &Vector3) -> Option<Vector3> {
    let cross = a.cross(b);
    let squared = cross.norm_squared();
    (squared > 1e-6 * a.norm_squared() * b.norm_squared()).then(|| cross / squared.sqrt())
}

fn least_squares(offsets: &[Vector3]) -> Option<Plane> {
    let count = offsets.len() as f64;
    let centre = offsets.iter().sum::<Vector3>() / count;
    let scatter = offsets
        .iter()
        .map(|offset| (offset - centre) * (offset - centre).transpose())
        .sum::<Matrix3>();
    let normal = smallest_axis(&scatter)?;
    Some(Plane { normal, height: normal.dot(&centre) })
}
