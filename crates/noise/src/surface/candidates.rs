//! A first plane that outliers and second faces cannot bend: the best supported of a few.

use cloudtouch_geom::Vector3;

use crate::lanes::{Lanes, Machine, WIDTH};
use crate::surface::patch::{Patch, Plane};
use crate::surface::reweight::{plane_of_sums, sums};
use crate::surface::vote::Vote;

/// Planes are laid through the point and each pair of this many nearest neighbours.
const PAIRED: usize = 8;
/// Planes are also laid through each three of this many.
const TRIPLED: usize = 6;
/// So many planes are laid.
const PLANE_COUNT: usize = PAIRED * (PAIRED - 1) / 2 + TRIPLED * (TRIPLED - 1) * (TRIPLED - 2) / 6;
/// How many neighbours vote on a plane.
const VOTERS: usize = 19;

/// The plane with the most support among the nearest neighbours; `None` when they are too few or
/// all on one line with the point.
///
/// That is the least-squares plane where it misses nobody. Else candidates are laid through three places, so that one of
/// them is likely to lie in one face even where two meet: the point and two neighbours, or three neighbours, since the
/// point itself may be the outlier.
#[inline(always)]
pub(crate) fn best_candidate<S: Machine>(machine: S, patch: &Patch) -> Option<Plane> {
    let voters = patch.nearest(VOTERS);
    let mut vote = Vote::new(machine, &voters);
    if let Some(plane) = least_squares(machine, &voters) {
        if vote.is_unanimous(&plane) {
            return Some(plane);
        }
        vote.consider(plane);
    }
    // The point itself first.
    let mut places = [Vector3::zeros(); 1 + PAIRED];
    let count = voters.len().min(PAIRED);
    for (i, place) in places[1..=count].iter_mut().enumerate() {
        *place = voters.offset(i);
    }
    for four in PLANES {
        let corners = four.map(|plane| plane.map(|corner| places[corner]));
        // PERF: of nearly all no more is told than that they do not win.
        let least = vote.least_costs(corners);
        for ((plane, [a, b, c]), least) in four.iter().zip(corners).zip(least) {
            if plane[2] > count || least > vote.best_cost {
                continue;
            }
            if let Some(normal) = across(&(b - a), &(c - a)) {
                vote.consider(Plane { normal, height: normal.dot(&a) });
            }
        }
    }
    vote.best
}

/// The places that planes are laid through, by fours: of the point, which is the first of them, and of each two of its
/// neighbours; then of each three of its neighbours. The last of three is the farthest.
const PLANES: [[[usize; 3]; WIDTH]; PLANE_COUNT / WIDTH] = {
    let mut planes = [[[0; 3]; WIDTH]; PLANE_COUNT / WIDTH];
    let (mut count, mut c) = (0, 2);
    while c <= PAIRED {
        let mut b = 1;
        while b < c {
            planes[count / WIDTH][count % WIDTH] = [0, b, c];
            (count, b) = (count + 1, b + 1);
        }
        c += 1;
    }
    c = 3;
    while c <= TRIPLED {
        let mut b = 2;
        while b < c {
            let mut a = 1;
            while a < b {
                planes[count / WIDTH][count % WIDTH] = [a, b, c];
                (count, a) = (count + 1, a + 1);
            }
            b += 1;
        }
        c += 1;
    }
    planes
};

/// The direction across two others; `None` when they are nearly parallel, which would leave a
/// direction of rounding error.
#[inline(always)]
fn across(a: &Vector3, b: &Vector3) -> Option<Vector3> {
    let cross = a.cross(b);
    let squared = cross.norm_squared();
    (squared > 1e-6 * a.norm_squared() * b.norm_squared()).then(|| cross / squared.sqrt())
}

#[inline(always)]
fn least_squares<S: Machine>(machine: S, voters: &Patch) -> Option<Plane> {
    let mut first = [Lanes::zero(machine); 3];
    let mut second = [Lanes::zero(machine); 6];
    // Where there is no neighbour the offsets are zero, which adds nothing, or another's.
    for group in 0..voters.groups() {
        let offsets = voters.group(machine, group);
        let present = voters.present(machine, group);
        let [x, y, z] = offsets;
        let [x, y, z] = [x * present, y * present, z * present];
        for (sum, value) in first.iter_mut().zip([x, y, z]) {
            *sum += value;
        }
        for (sum, product) in second.iter_mut().zip([x * x, x * y, x * z, y * y, y * z, z * z]) {
            *sum += product;
        }
    }
    plane_of_sums((voters.len() as f64, sums(first), sums(second)), voters.whitening())
}
