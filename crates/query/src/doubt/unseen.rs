//! Space that was never seen: an object where a single depth image saw nothing may be inside
//! something, and no search of what was measured can tell.

use cloudtouch_geom::{Motion, Point3, Pose, Vector3};
use serde::Serialize;

use crate::cloud::{Prepared, Sight};
use crate::doubt::warning::Which;
use crate::shape::{Shape, TURNED};

/// Where a body's surface lies as the single depth image of the other sees it: shares of the surface,
/// from 0 to 1. What is in none of them was seen to be empty, or is on a measured surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Unseen {
    /// Whose surface.
    pub body: Which,
    /// Behind the back of the camera.
    pub behind_camera: f64,
    /// Beside what it looked at.
    pub outside_view: f64,
    /// Where no return came from, or the body fits between the pixels.
    pub hole: f64,
    /// Farther than returns were kept ([`FilterSettings::max_range`](crate::FilterSettings::max_range)). In a depth
    /// image those that were left out say that there is nothing before.
    pub out_of_range: f64,
    /// Behind a surface that it met.
    pub behind_returns: f64,
    /// Of these, behind by no more than 3 cm beyond what noise may do: rather inside what it met than in the shadow
    /// of it.
    pub close_behind: f64,
}

impl Unseen {
    /// The share that was not seen, for whatever reason.
    pub fn share(&self) -> f64 {
        self.behind_camera + self.outside_view + self.hole + self.out_of_range + self.behind_returns
    }
}

/// How much of one body lies where the other, a single depth image, saw nothing. Of two images the
/// larger one looks at the smaller; `None` without any. `a_from_b` maps local frames. Where they may be free, small parts
/// are looked for, unless they are known to be clear of each other and in sight.
pub(crate) fn unseen(
    a: Shape<'_>,
    b: Shape<'_>,
    a_from_b: &Pose,
    may_be_free: bool,
    is_clear: bool,
) -> Option<Unseen> {
    let at = |samples: Samples| unseen_around((a, b), a_from_b, samples, &[Vector3::zeros()]);
    let usual = at(Samples::Usual)?;
    // PERF: it takes four times as long.
    let matters = may_be_free && (!is_clear || usual.share() > 0.0);
    if matters { at(Samples::Dense) } else { Some(usual) }
}

/// At how many places of a body is looked.
#[derive(Debug, Clone, Copy)]
enum Samples {
    Few,
    Usual,
    Dense,
}

impl Samples {
    fn of(self, body: Shape<'_>) -> Vec<Point3> {
        match self {
            Self::Few => body.samples().into_iter().step_by(LOOKED_AROUND).collect(),
            Self::Usual => body.samples(),
            Self::Dense => body.dense_samples().collect(),
        }
    }
}

/// Distances that are looked at about a place, from the first on each so many times as far as the one before, m.
const FIRST_DISTANCE: f64 = 2e-3;
const FARTHER: f64 = 1.25;
/// One in so many samples is looked around.
const LOOKED_AROUND: usize = 2;

/// Whether as much as counts of a body may not have been seen somewhere within a margin (m), or a little more.
/// What may be so for one margin may for a larger one.
pub(crate) fn may_be_unseen_within(
    bodies: (Shape<'_>, Shape<'_>),
    a_from_b: &Pose,
    margin: f64,
    exceeds: impl Fn(&Unseen) -> bool,
) -> bool {
    let mut around = vec![Vector3::zeros()];
    let mut distance = 0.0;
    while distance < margin {
        distance = FIRST_DISTANCE.max(distance * FARTHER);
        around.extend(directions().map(|direction| distance * direction));
    }
    // PERF: all take eight times as long as few of them, and are left out where these are all in sight, or more
    // unseen than may be.
    let looked_at = [Samples::Few, Samples::Dense].into_iter();
    looked_at
        .map_while(|samples| unseen_around(bodies, a_from_b, samples, &around))
        .take_while(|unseen| unseen.share() > 0.0)
        .any(|unseen| exceeds(&unseen))
}

/// Toward the middles of the faces of a cube and its corners.
fn directions() -> impl Iterator<Item = Vector3> {
    let signs = [-1.0, 1.0];
    let faces = (0..3).flat_map(move |k| signs.map(|sign| sign * Vector3::ith(k, 1.0)));
    let corners = signs.into_iter().flat_map(move |x| {
        signs.into_iter().flat_map(move |y| signs.map(|z| Vector3::new(x, y, z).normalize()))
    });
    faces.chain(corners)
}

fn unseen_around(
    (a, b): (Shape<'_>, Shape<'_>),
    a_from_b: &Pose,
    samples: Samples,
    around: &[Vector3],
) -> Option<Unseen> {
    let of_b = || look(image(a)?, (b, Which::B), a_from_b, samples, around);
    let of_a = || look(image(b)?, (a, Which::A), &a_from_b.inverse(), samples, around);
    if knows_unseen(a) && knows_unseen(b) && a.size() < b.size() {
        of_a()
    } else {
        of_b().or_else(of_a)
    }
}

/// Whether a body knows what it did not see, as a depth image does.
pub(crate) fn knows_unseen(body: Shape<'_>) -> bool {
    image(body).is_some()
}

fn image(body: Shape<'_>) -> Option<&Prepared> {
    match body {
        Shape::Cloud(cloud) if cloud.knows_unseen() => Some(cloud),
        _ => None,
    }
}

/// Looks at samples of a body, each with what is `around` it: the least known of it counts.
fn look(
    image: &Prepared,
    (other, body): (Shape<'_>, Which),
    image_from_other: &Pose,
    samples: Samples,
    around: &[Vector3],
) -> Option<Unseen> {
    let sights = image.sights()?;
    // PERF: thousands of places; most bodies, and most samples, have nothing unseen about them.
    let motion = Motion::from(image_from_other);
    let farthest = around.iter().map(Vector3::norm).fold(0.0, f64::max);
    let radius = 0.5 * other.size() + farthest;
    let is_all_seen =
        sights.are_all_seen(&motion.point(&other.middle()), radius, other.size() / TURNED);
    let (samples, breadth) =
        if is_all_seen { (Vec::new(), 0.0) } else { (samples.of(other), other.breadth()) };
    let mut counts = [0_usize; 6];
    for sample in &samples {
        let place = motion.point(sample);
        if farthest > 0.0 && sights.are_all_seen(&place, farthest, breadth) {
            continue;
        }
        let (mut least, mut is_close) = (Sight::Seen, false);
        for offset in around {
            let sight = sights.of(&(place + offset), breadth);
            least = least.max(sight);
            is_close |= sight == Sight::CloseBehind;
        }
        match least {
            Sight::Seen => {}
            Sight::BehindCamera => counts[0] += 1,
            Sight::OutsideView => counts[1] += 1,
            Sight::Hole => counts[2] += 1,
            Sight::CloseBehind | Sight::BehindReturns => counts[3] += 1,
            Sight::OutOfRange => counts[4] += 1,
        }
        counts[5] += usize::from(is_close);
    }
    let [behind_camera, outside_view, hole, behind_returns, out_of_range, close_behind] =
        counts.map(|count| count as f64 / samples.len().max(1) as f64);
    Some(Unseen {
        body,
        behind_camera,
        outside_view,
        hole,
        out_of_range,
        behind_returns,
        close_behind,
    })
}
