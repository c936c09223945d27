//! Between what distances two bodies lie, from how likely they are within margins.

use std::time::Instant;

use cloudtouch_bvh::NodeId;
use cloudtouch_geom::{Point3, Pose};

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::judge::MOST_DEVIATIONS;
use crate::placement::boxes;
use crate::report::Report;
use crate::search::{Span, least_of_leaves, least_within};

use super::run::Query;
use super::within::{BeyondEvidence, Within};

/// The ends of an interval are told this well, relative to themselves.
const PRECISION: f64 = 1e-3;
/// Nothing is told finer, m.
const FINEST: f64 = 1e-5;

impl Query {
    /// Between what distances (m) the surfaces lie with a probability of `share`: a central interval, its ends the
    /// margins that the bounds of [`Self::within`] leave so likely. The first is 0 where a collision alone is, or may be: where nothing is known of what
    /// a camera did not see, nor of how far off it is.
    ///
    /// The nearest of many pieces that face each other count, so that surfaces are told nearer than they are:
    /// the true distance is hardly ever below the first, and beyond the second more often than it says.
    ///
    /// # Errors
    /// When the share is not between 0 and 1, and those of [`Self::run`].
    pub fn clearance_interval<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        a_from_b: &Pose,
        share: f64,
    ) -> Result<[f64; 2], QueryError> {
        if !(share > 0.0 && share < 1.0) {
            return Err(QueryError::Share { value: share });
        }
        let bodies = (a.into(), b.into());
        let this = self.with_probability().begun_now();
        let report = this.run(bodies.0, bodies.1, a_from_b)?;
        this.interval(bodies, a_from_b, &report, share)
    }

    /// The answers to [`Self::within`] and [`Self::clearance_interval`], by one query.
    ///
    /// # Errors
    /// Those of both.
    pub fn nearness<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        a_from_b: &Pose,
        margin: f64,
        share: f64,
    ) -> Result<(Report, Within, [f64; 2]), QueryError> {
        if !(share > 0.0 && share < 1.0) {
            return Err(QueryError::Share { value: share });
        }
        let bodies = (a.into(), b.into());
        let this = self.with_probability().begun_now();
        let (report, within) = this.within(bodies.0, bodies.1, a_from_b, margin)?;
        let interval = this.interval(bodies, a_from_b, &report, share)?;
        Ok((report, within, interval))
    }

    fn interval(
        &self,
        bodies: (BodyRef<'_>, BodyRef<'_>),
        a_from_b: &Pose,
        report: &Report,
        share: f64,
    ) -> Result<[f64; 2], QueryError> {
        let below = 0.5 * (1.0 - share);
        // What is not known may be either: nearer than the first end, and farther than the second.
        let ends = [End { wanted: below, bound: UPPER }, End { wanted: 1.0 - below, bound: LOWER }];
        // Beyond the far corners of both boxes there is no surface: there doubling ends.
        let most = span(boxes(bodies.0.shape(), bodies.1.shape(), a_from_b));
        let asked = (bodies, a_from_b, report);
        let local = bodies.0.shape().local_from(&bodies.1.shape(), a_from_b);
        let mut beyond = report.evidence.map(|evidence| Narrowing {
            beyond: BeyondEvidence::new(self, bodies, local, evidence),
            leaves: None,
        });
        let mut of = |end: End| match &mut beyond {
            _ if self.is_likely(asked, end, 0.0)? => Ok([0.0; 2]),
            Some(beyond) => beyond.margin_of(end, most),
            None => self.margin_of(asked, end, most),
        };
        let ([low, _], [_, high]) = (of(ends[0])?, of(ends[1])?);
        Ok([low, high.max(low)])
    }

    /// Whether they are as likely within a margin as wanted, by a query for it.
    fn is_likely(
        &self,
        (bodies, a_from_b, report): Asked<'_>,
        End { wanted, bound }: End,
        margin: f64,
    ) -> Result<bool, QueryError> {
        Ok(self.beyond_collision(bodies, a_from_b, margin, report)?.bounds[bound] >= wanted)
    }

    /// The least margin within which the bodies are as likely as wanted, and are not without one: it is between
    /// these.
    fn margin_of(&self, asked: Asked<'_>, end: End, most: f64) -> Result<[f64; 2], QueryError> {
        let mut is_likely = |margin: f64| self.is_likely(asked, end, margin);
        match around(most, &mut is_likely)? {
            Some(ends) => narrowed(ends, is_likely),
            None => Ok([most; 2]),
        }
    }
}

/// Two bodies, a pose, and the report on them.
type Asked<'a> = ((BodyRef<'a>, BodyRef<'a>), &'a Pose, &'a Report);

const LOWER: usize = 0;
const UPPER: usize = 1;

/// The margin where a bound of [`Within`] becomes as large as wanted.
#[derive(Debug, Clone, Copy)]
struct End {
    wanted: f64,
    bound: usize,
}

/// The same margins in fewer searches: two leaves that are likely within one margin mostly are within the next one
/// too, and then no search is needed; and of a search no more is asked than whether it is likely.
struct Narrowing<'a> {
    beyond: BeyondEvidence<'a>,
    /// The leaves that were likely within the least margin so far.
    leaves: Option<[NodeId; 2]>,
}

impl Narrowing<'_> {
    /// As [`Query::margin_of`], to the bit: a margin that is wider than one that is likely is likely too, and one
    /// that is narrower than one that is not is not either.
    fn margin_of(&mut self, end: End, most: f64) -> Result<[f64; 2], QueryError> {
        let Some(widest) = around(most, |margin| self.is_likely(end, margin))? else {
            return Ok([most; 2]);
        };
        loop {
            let [low, high] = narrowed(widest, |margin| Ok(self.is_known_likely(end, margin)))?;
            // Where the leaves end being likely, others may be: one search tells, instead of one for each step.
            if low == widest[0] || !self.is_likely(end, low)? {
                return Ok([low, high]);
            }
            // The time is over: what is not known is likely, by no leaves.
            if !self.is_known_likely(end, low) {
                return narrowed(widest, |margin| self.is_likely(end, margin));
            }
        }
    }

    /// Whether it is as likely as wanted within a margin.
    fn is_likely(&mut self, end: End, margin: f64) -> Result<bool, QueryError> {
        if self.is_known_likely(end, margin) {
            return Ok(true);
        }
        let BeyondEvidence { query, bodies, local, .. } = &self.beyond;
        let clock = query.clock(Instant::now());
        let found = least_within(*bodies, local, margin, self.deciding(end, margin), &clock)?;
        let is_likely = self.beyond.probability(found.deviations, margin) >= end.wanted;
        if is_likely {
            self.leaves = found.leaves;
        }
        Ok(is_likely || (end.bound == UPPER && !found.is_complete))
    }

    /// Whether that is so by what is known without a search.
    fn is_known_likely(&self, end: End, margin: f64) -> bool {
        let BeyondEvidence { bodies, local, .. } = &self.beyond;
        let of = |leaves| least_of_leaves(*bodies, local, margin, MOST_DEVIATIONS, leaves);
        let deviations = self.leaves.map_or(MOST_DEVIATIONS, of);
        self.beyond.probability(deviations, margin) >= end.wanted
            || (end.bound == UPPER && self.beyond.may_be_hidden(margin))
    }

    /// The deviations that decide whether it is as likely as wanted within a margin: more than these are not, and
    /// fewer are.
    fn deciding(&self, end: End, margin: f64) -> Span {
        /// Deviations are told apart no finer: what is between is compared by its probability.
        const FINE: f64 = 0.05;
        let [mut enough, mut most] = [-MOST_DEVIATIONS, MOST_DEVIATIONS];
        while most - enough > FINE {
            let middle = 0.5 * (enough + most);
            if self.beyond.probability(middle, margin) >= end.wanted {
                enough = middle;
            } else {
                most = middle;
            }
        }
        Span { most, enough }
    }
}

/// A margin that is not likely and one that is, a few times as wide; none where none up to `most` is.
fn around(
    most: f64,
    mut is_likely: impl FnMut(f64) -> Result<bool, QueryError>,
) -> Result<Option<[f64; 2]>, QueryError> {
    let (mut low, mut high) = (0.0, FINEST);
    while !is_likely(high)? {
        if high > most {
            return Ok(None);
        }
        (low, high) = (high, 4.0 * high);
    }
    Ok(Some([low, high]))
}

/// The same, closer together.
fn narrowed(
    [mut low, mut high]: [f64; 2],
    mut is_likely: impl FnMut(f64) -> Result<bool, QueryError>,
) -> Result<[f64; 2], QueryError> {
    while high - low > PRECISION * high + FINEST {
        let middle = 0.5 * (low + high);
        if is_likely(middle)? {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok([low, high])
}

/// The longest way from a corner of the boxes of both bodies to another, m.
fn span([[low, high], [low_of_b, high_of_b]]: [[Point3; 2]; 2]) -> f64 {
    (high.sup(&high_of_b) - low.inf(&low_of_b)).norm()
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{PointCloud, TriangleMesh, Vector3};
    use cloudtouch_noise::SensorModel;
    use cloudtouch_testkit::camera::DepthCamera;
    use cloudtouch_testkit::exact::ExactMesh;
    use cloudtouch_testkit::noise::{NoiseKind, add_noise};
    use cloudtouch_testkit::{scene, surface};
    use proptest::prelude::*;

    use super::*;
    use crate::body::Body;
    use crate::mesh::Mesh;
    use crate::query::QuerySettings;
    use crate::{Cloud, CloudSettings};

    /// By a whole query for each margin.
    fn by_queries(query: &Query, asked: Asked<'_>, share: f64) -> [f64; 2] {
        let (bodies, a_from_b, _) = asked;
        let most = span(boxes(bodies.0.shape(), bodies.1.shape(), a_from_b));
        let below = 0.5 * (1.0 - share);
        let of = |wanted: f64, bound: usize| {
            let end = End { wanted, bound };
            match query.is_likely(asked, end, 0.0).unwrap() {
                true => [0.0; 2],
                false => query.margin_of(asked, end, most).unwrap(),
            }
        };
        let ([low, _], [_, high]) = (of(below, UPPER), of(1.0 - below, LOWER));
        [low, high.max(low)]
    }

    fn cloud(of: &TriangleMesh, count: usize, std: f64, seed: u64) -> Body {
        let samples = surface::positions(&surface::sample_surface(of, count, seed));
        let points = add_noise(&samples, NoiseKind::Gaussian, std, seed);
        let settings = CloudSettings::new(SensorModel::Isotropic { std });
        Body::Cloud(Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap())
    }

    /// A block before a wall, with a shadow behind it.
    fn image(seed: u64) -> Body {
        let at = |z: f64| Pose::from_translation(Vector3::z() * z);
        let block = ExactMesh::new(&scene::moved(&scene::cuboid([0.5; 3]), &at(1.5)));
        let wall = ExactMesh::new(&scene::moved(&scene::plane_patch(6.0), &at(3.0)));
        let seen = DepthCamera::default().scan(&[&block, &wall], &Pose::identity(), seed);
        let settings = CloudSettings::new(SensorModel::Kinect);
        Body::Cloud(Cloud::prepare(&seen, &settings).unwrap())
    }

    fn assert_same(bodies: [&Body; 2], pose: &Pose, share: f64) {
        let query = Query::new(QuerySettings::default()).unwrap();
        let bodies = (bodies[0].into(), bodies[1].into());
        let report = query.run(bodies.0, bodies.1, pose).unwrap();
        let told = query.interval(bodies, pose, &report, share).unwrap();
        assert_eq!(told, by_queries(&query, (bodies, pose, &report), share), "{pose:?} {share}");
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

        #[test]
        fn an_interval_is_that_of_a_query_for_each_margin(
            mesh in 0..3_usize,
            counts in [60_usize..600, 60_usize..600],
            std in prop_oneof![Just(0.0), 0.0002_f64..0.01],
            way in [-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64],
            far in 0.0..3.0_f64,
            turn in -3.0_f64..3.0,
            share in 0.05..0.99_f64,
            seed in any::<u64>(),
        ) {
            let shapes = [scene::cuboid([0.3, 0.2, 0.1]), scene::sphere(0.08, 2)];
            let [a, b] = [0, 1].map(|k| match k == mesh {
                true => Body::Mesh(Mesh::prepare(&shapes[k]).unwrap()),
                false => cloud(&shapes[k], counts[k], std, seed.wrapping_add(k as u64)),
            });
            let pose = Pose::from_translation_rpy(Vector3::from(way) * far, [turn, 0.3, 0.0]);
            assert_same([&a, &b], &pose, share);
        }
    }

    #[test]
    fn an_interval_beside_what_was_not_seen_is_that_of_a_query_for_each_margin() {
        let (seen, ball) = (image(1), Body::Mesh(Mesh::prepare(&scene::sphere(0.08, 2)).unwrap()));
        for (x, z) in [(0.0, 0.8), (0.6, 1.5), (0.45, 1.9), (-0.9, 2.5), (0.05, 2.3), (0.3, 1.1)] {
            let pose = Pose::from_translation(Vector3::new(x, 0.0, z));
            for share in [0.5, 0.9] {
                assert_same([&seen, &ball], &pose, share);
            }
        }
    }
}
