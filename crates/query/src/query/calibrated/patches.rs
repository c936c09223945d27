//! Contact patches: the surroundings of the places where two clouds are least apart, across the
//! borders of leaves, for the classifier.

use cloudtouch_geom::{Motion, Point3, Pose};

use crate::classifier::{PairPoint, PairPoints};
use crate::cloud::{Cloud, Surfel};

use super::search::{Finding, Found};

/// More patches than this add little: the first is the least apart.
const MOST_PATCHES: usize = 3;
/// Points of one cloud in a patch, at most.
const MOST_POINTS: usize = 20;
/// What these are chosen from: the points nearest as measured.
const GATHERED_POINTS: usize = 30;
/// A patch reaches so many spacings ...
const REACH_SPACINGS: f64 = 3.0;
/// ... and so many standard deviations of the position noise.
const REACH_DEVIATIONS: f64 = 2.0;

/// A place the classifier is asked about.
#[derive(Debug, Clone, Copy)]
struct Seed {
    place: Point3,
    reach: f64,
}

/// The patches of a search, the least apart first, no two of which have their middles within reach.
pub(super) fn patches(
    (a, b): (&Cloud, &Cloud),
    a_from_b: &Pose,
    found: &Found<'_>,
) -> Vec<PairPoints> {
    let (motion, b_from_a) = (Motion::from(a_from_b), a_from_b.inverse());
    let gather = |seed: Seed| {
        let in_b = Seed { place: b_from_a.transform_point(&seed.place), ..seed };
        let moved = |surfel: &Surfel| PairPoint::from(&surfel.moved(&motion));
        PairPoints {
            a: around(&seed, a).iter().map(PairPoint::from).collect(),
            b: around(&in_b, b).iter().map(moved).collect(),
            a_is_mesh: false,
            b_is_mesh: false,
        }
    };
    let is_whole = |patch: &PairPoints| !patch.a.is_empty() && !patch.b.is_empty();
    seeds((a, b), found).into_iter().map(gather).filter(is_whole).collect()
}

fn seeds((a, b): (&Cloud, &Cloud), found: &Found<'_>) -> Vec<Seed> {
    let most = found.deviations_of_interest();
    let mut findings: Vec<&Finding> =
        found.findings.iter().filter(|f| f.meeting.deviations <= most).collect();
    let key = |f: &Finding| f.meeting.deviations;
    findings.sort_by(|f, g| key(f).total_cmp(&key(g)).then(f.between.cmp(&g.between)));
    let mut seeds: Vec<Seed> = Vec::new();
    for finding in findings {
        let [of_a, of_b] = finding.between;
        let noise = a.sensor_std(of_a).max(b.sensor_std(of_b));
        let reach = REACH_SPACINGS * finding.spacing + REACH_DEVIATIONS * noise;
        let place = finding.meeting.place;
        if seeds.iter().all(|seed| (seed.place - place).norm() > seed.reach.max(reach)) {
            seeds.push(Seed { place, reach });
            if seeds.len() == MOST_PATCHES {
                break;
            }
        }
    }
    seeds
}

/// The pieces of surface of one cloud nearest to a seed in its frame.
fn around(seed: &Seed, cloud: &Cloud) -> Vec<Surfel> {
    let distance = |s: &Surfel| (s.point.mean - seed.place).norm();
    let mut near = cloud.surfels_near(&seed.place, GATHERED_POINTS);
    near.retain(|s| distance(s) <= seed.reach);
    near.sort_by(|s, t| distance(s).total_cmp(&distance(t)).then(s.index.cmp(&t.index)));
    near.truncate(MOST_POINTS);
    near
}
