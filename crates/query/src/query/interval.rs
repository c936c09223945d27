//! Between what distances two bodies lie, from how likely they are within margins.

use cloudtouch_geom::{Point3, Pose};

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::placement::boxes;
use crate::report::Report;

use super::narrowing::{End, LOWER, Narrowing, UPPER, around, narrowed};
use super::run::Query;
use super::within::{BeyondEvidence, Within};

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
        let mut beyond = report
            .evidence
            .map(|evidence| Narrowing::of(BeyondEvidence::new(self, bodies, local, evidence)));
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
                true => Body::from(Mesh::prepare(&shapes[k]).unwrap()),
                false => cloud(&shapes[k], counts[k], std, seed.wrapping_add(k as u64)),
            });
            let pose = Pose::from_translation_rpy(Vector3::from(way) * far, [turn, 0.3, 0.0]);
            assert_same([&a, &b], &pose, share);
        }
    }

    #[test]
    fn an_interval_beside_what_was_not_seen_is_that_of_a_query_for_each_margin() {
        let (seen, ball) = (image(1), Body::from(Mesh::prepare(&scene::sphere(0.08, 2)).unwrap()));
        for (x, z) in [(0.0, 0.8), (0.6, 1.5), (0.45, 1.9), (-0.9, 2.5), (0.05, 2.3), (0.3, 1.1)] {
            let pose = Pose::from_translation(Vector3::new(x, 0.0, z));
            for share in [0.5, 0.9] {
                assert_same([&seen, &ball], &pose, share);
            }
        }
    }
}
