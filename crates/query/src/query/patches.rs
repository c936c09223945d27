//! Contact patches: the surroundings of the places where two clouds are least apart, across the
//! borders of leaves, for the classifier.

use cloudtouch_geom::{Motion, Point3, Pose, UncertainPoint};
use cloudtouch_noise::Scratch;

use crate::body::BodyRef;
use crate::classifier::{PairPoint, PairPoints};
use crate::cloud::{Cloud, Surfel};
use crate::error::SubdivisionError;
use crate::mesh::{Mesh, SampleRegion, nearest_in_region};

use crate::search::{Finding, Found};

/// More patches than this add little: the first is the least apart.
const MOST_PATCHES: usize = 3;
/// No patch is about a place with so many deviations more than the least ...
const FURTHER_DEVIATIONS: f64 = 1.5;
/// ... nor, but for the least, about one with so many.
const CLEARLY_FREE: f64 = 3.5;
/// Nor about one whose errors are rather those of all samples there: a classifier takes them for each one's own, by which
/// surfaces that are all off by as much seem to be parted.
const MOST_SHARED: f64 = 0.5;
/// Places whose deviations differ by less than about this are as near as each other.
const TIED: f64 = 1e-6;
/// Points of one cloud in a patch, at most.
const MOST_POINTS: usize = 20;
/// What these are chosen from: the points nearest as measured.
const GATHERED_POINTS: usize = 30;
/// A patch reaches so many spacings ...
const REACH_SPACINGS: f64 = 3.0;
/// ... and so many standard deviations of the position noise.
const REACH_DEVIATIONS: f64 = 2.0;

/// Of a mesh it reaches no more spacings than this.
const MESH_SPACINGS: f64 = 4.0;

/// A place the classifier is asked about.
#[derive(Debug, Clone, Copy)]
struct Seed {
    place: Point3,
    reach: f64,
    /// Distance between samples there, m.
    spacing: f64,
}

/// The patches of a search, the least apart first, no two of which have their middles within reach; `None` where no
/// place is one that a classifier could say anything of.
pub(super) fn patches(
    (a, b): (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    found: &Found<'_>,
    max_parts: usize,
) -> Result<Option<Vec<PairPoints>>, SubdivisionError> {
    let here = Pose::identity();
    let findings = findings(found);
    let own: Vec<&Finding> =
        findings.iter().copied().filter(|f| f.nearest.shared <= MOST_SHARED).collect();
    if own.is_empty() && !findings.is_empty() {
        return Ok(None);
    }
    let mut patches = Vec::new();
    for seed in seeds((a, b), &own) {
        let patch = PairPoints {
            a: around(&seed, a, &here, max_parts)?,
            b: around(&seed, b, a_from_b, max_parts)?,
            a_is_mesh: matches!(a, BodyRef::Mesh(_)),
            b_is_mesh: matches!(b, BodyRef::Mesh(_)),
        };
        if !patch.a.is_empty() && !patch.b.is_empty() {
            patches.push(patch);
        }
    }
    Ok(Some(patches))
}

/// What was found about as near as the nearest, that first.
fn findings<'f>(found: &'f Found<'_>) -> Vec<&'f Finding> {
    let most = found.deviations_up_to(FURTHER_DEVIATIONS, CLEARLY_FREE);
    let mut findings: Vec<&Finding> =
        found.findings.iter().filter(|f| f.meeting.deviations <= most).collect();
    // A piece may be as near to two triangles; rounding is not to choose, nor which body is called A.
    let key = |f: &Finding| {
        let [a, b] = f.nearest.between;
        ((f.meeting.deviations / TIED).round(), [a.min(b), a.max(b)])
    };
    findings.sort_by(|f, g| {
        let [(less, of_f), (more, of_g)] = [f, g].map(|finding| key(finding));
        less.total_cmp(&more).then(of_f.cmp(&of_g))
    });
    findings
}

fn seeds((a, b): (BodyRef<'_>, BodyRef<'_>), findings: &[&Finding]) -> Vec<Seed> {
    let std_of = |body: BodyRef<'_>, piece| match body {
        BodyRef::Cloud(cloud) => cloud.sensor_std(piece),
        BodyRef::Mesh(_) => 0.0,
    };
    let mut seeds: Vec<Seed> = Vec::new();
    for finding in findings {
        let [of_a, of_b] = finding.nearest.between;
        let noise = std_of(a, of_a).max(std_of(b, of_b));
        let reach = REACH_SPACINGS * finding.nearest.spacing + REACH_DEVIATIONS * noise;
        let place = finding.meeting.place;
        if seeds.iter().all(|seed| (seed.place - place).norm() > seed.reach.max(reach)) {
            seeds.push(Seed { place, reach, spacing: finding.nearest.spacing });
            if seeds.len() == MOST_PATCHES {
                break;
            }
        }
    }
    seeds
}

/// The points of one body nearest to a seed, in the frame of A.
fn around(
    seed: &Seed,
    body: BodyRef<'_>,
    a_from_body: &Pose,
    max_parts: usize,
) -> Result<Vec<PairPoint>, SubdivisionError> {
    let place = a_from_body.inverse().transform_point(&seed.place);
    Ok(match body {
        BodyRef::Cloud(cloud) => {
            let motion = Motion::from(a_from_body);
            let moved = |surfel: &Surfel| PairPoint::from(&surfel.moved(&motion));
            of_cloud(seed, cloud, &place).iter().map(moved).collect()
        }
        BodyRef::Mesh(mesh) => of_mesh(seed, mesh, &place, max_parts)?
            .iter()
            .map(|point| PairPoint {
                index: None,
                point: UncertainPoint::exact(a_from_body.transform_point(point)),
                spacing: seed.spacing,
                radius: None,
            })
            .collect(),
    })
}

/// The pieces of surface of a cloud nearest to a seed at this place of its frame.
fn of_cloud(seed: &Seed, cloud: &Cloud, place: &Point3) -> Vec<Surfel> {
    let mut scratch = Scratch::default();
    let distance = |(_, s): &(u32, Surfel)| (s.point.mean - place).norm();
    let mut near = cloud.prepared().fits_near(place, GATHERED_POINTS, &mut scratch);
    near.retain(|s| distance(s) <= seed.reach);
    near.sort_by(|s, t| distance(s).total_cmp(&distance(t)).then(s.1.index.cmp(&t.1.index)));
    near.truncate(MOST_POINTS);
    let near: Vec<u32> = near.iter().map(|(piece, _)| *piece).collect();
    cloud.prepared().told_together(&near, &mut scratch)
}

/// The samples of a mesh, as dense as the cloud it faces, nearest to a seed.
fn of_mesh(
    seed: &Seed,
    mesh: &Mesh,
    place: &Point3,
    max_parts: usize,
) -> Result<Vec<Point3>, SubdivisionError> {
    // One point alone has no spacing to sample a mesh by, and tells no side.
    if seed.spacing <= 0.0 {
        return Ok(Vec::new());
    }
    // The place is on the mesh as a rule: so far there are more samples than are wanted.
    let radius = seed.reach.min(MESH_SPACINGS * seed.spacing);
    let mut triangles = Vec::new();
    mesh.visit_triangles_near(place, radius, |_, corners| triangles.push(corners));
    let region = SampleRegion { center: *place, core: radius, radius, spacing: seed.spacing };
    nearest_in_region(triangles, &region, MOST_POINTS, max_parts)
}
