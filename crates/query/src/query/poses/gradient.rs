//! How a collision probability and a clearance change with the pose.

use cloudtouch_geom::{Motion, Pose};
use serde::Serialize;

use super::gap_by_pose::gap_by_pose;
use super::misclassified_by_pose::misclassified_by_pose;
use crate::body::BodyRef;
use crate::error::QueryError;
use crate::exact::nearest_places;
use crate::mesh::Mesh;
use crate::query::estimate::exact;
use crate::query::misclassified::MisclassifiedBy;
use crate::query::places::spots::{Spot, ToldBy};
use crate::query::run::Query;
use crate::query::task::Task;
use crate::query::weigh::{Weighed, weigh};
use crate::report::Report;
use crate::search::{Wrench, force_at, in_object_frame};
use crate::stats::Stats;

/// What an answer changes by for a small motion of the object before its pose, in the object's own frame,
/// as in a [`PoseDistribution`](crate::PoseDistribution): per metre of translation along x, y and z, then
/// per radian of rotation about x, y and z through the origin of that frame.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[non_exhaustive]
pub struct PoseGradient {
    /// Of [`Report::collision_probability`].
    pub probability: [f64; 6],
    /// Of its log odds, ln(P/(1−P)): they go on changing where the probability is all but 0 or 1. Nothing
    /// where no two pieces are within six deviations, and deep in collision; nothing for two meshes.
    pub log_odds: [f64; 6],
    /// Of the mean of [`Report::clearance_m`], where there is one. Of surfaces that cross it is that of the
    /// depth as the place tells it, though the clearance tells half a spacing of it at most.
    #[serde(rename = "clearance_m")]
    pub clearance: Option<[f64; 6]>,
}

impl Query {
    /// The answer to [`Self::run`], and what it changes by with the pose: what an optimiser or a controller
    /// follows.
    ///
    /// The evidence is that of single places (the two pieces with the least deviations, the crossings at one
    /// place, the deepest point), and where another takes over the gradient is that of either; of the extent it
    /// is that of all pieces that count in part. Crossings that
    /// come into reach of a place or leave it change the evidence in a step, which no gradient tells; so do
    /// the points of a classifier's patch. It is analytic but for the classifier, which is asked only in
    /// doubt: its patch is separated twelve times more, a little aside. The search does not stop early, so that
    /// a probability above [`QuerySettings::stop_above`](crate::QuerySettings::stop_above) may be told higher than by [`Self::run`].
    ///
    /// ```
    /// use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
    /// use cloudtouch::noise::SensorModel;
    /// use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings};
    ///
    /// let sheet: Vec<Point3> =
    ///     (0..400).map(|i| Point3::new(0.01 * (i % 20) as f64, 0.01 * (i / 20) as f64, 0.0)).collect();
    /// let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.002 });
    /// let table = Cloud::prepare(&PointCloud::from_points(sheet), &settings)?;
    /// let query = Query::new(QuerySettings::default())?;
    /// let above = Pose::from_translation(Vector3::new(0.0, 0.0, 0.004));
    /// let (_, gradient) = query.gradient(&table, &table, &above)?;
    /// // Up is away from a collision.
    /// assert!(gradient.log_odds[2] < 0.0 && gradient.probability[2] < 0.0);
    /// assert!((gradient.clearance.unwrap()[2] - 1.0).abs() < 0.01);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Self::run`].
    pub fn gradient<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        a_from_b: &Pose,
    ) -> Result<(Report, PoseGradient), QueryError> {
        let (a, b) = (a.into(), b.into());
        let query = self.unstopped();
        let mut gradient = PoseGradient::default();
        let report =
            query.terms().ask((a.shape(), b.shape()), a_from_b, |start, local, evidence| {
                let motion = Motion::from(local);
                let of = |wrench: Wrench| in_object_frame(&wrench, &motion, &b.shape().origin());
                let task = query.task(start, (a, b));
                if let (BodyRef::Mesh(a), BodyRef::Mesh(b)) = (a, b) {
                    let estimate = exact((a, b), local, &task, evidence)?;
                    if !estimate.is_too_late {
                        gradient.clearance = clearance_of_meshes((a, b), local)?.map(of);
                    }
                    return Ok(estimate);
                }
                let weighed = weigh((a, b), local, &task, &mut evidence.stats)?;
                let spots = weighed.spots((a, b), local);
                let estimate = weighed.estimate(Some(&spots), &task, evidence);
                let p = estimate.probability;
                let log_odds =
                    weighed.log_odds_by_pose((a, b), local, &task, &mut evidence.stats)?;
                gradient.log_odds = of(log_odds);
                gradient.probability = of(log_odds * (p * (1.0 - p)));
                let is_told = estimate.places.as_ref().is_some_and(|at| at.clearance.is_some());
                let nearest = weighed.nearest_spot(&spots, p).filter(|_| is_told);
                gradient.clearance =
                    nearest.map(|spot| of(weighed.gap_by_pose((a, b), &motion, spot)));
                Ok(estimate)
            })?;
        Ok((report, gradient))
    }
}

/// What the distance of two meshes changes by, where they are apart. Local frames.
pub(super) fn clearance_of_meshes(
    meshes: (&Mesh, &Mesh),
    a_from_b: &Pose,
) -> Result<Option<Wrench>, QueryError> {
    let places = nearest_places(meshes, a_from_b)?;
    Ok(places.map(|[on_a, on_b]| {
        let away = (on_b - on_a).try_normalize(0.0).unwrap_or_default();
        force_at(&on_b, &away)
    }))
}

impl Weighed<'_> {
    fn log_odds_by_pose(
        &self,
        (a, b): (BodyRef<'_>, BodyRef<'_>),
        a_from_b: &Pose,
        task: &Task<'_>,
        stats: &mut Stats,
    ) -> Result<Wrench, QueryError> {
        let judge = &task.judge;
        let (deviations, crossing) = (self.of_geometry.deviations, self.of_geometry.crossing);
        let mesh_is_a = matches!(a, BodyRef::Mesh(_));
        let of_deviations = self.looked.deviations_by_pose(
            self.found.deviations,
            self.found.deviations_by_pose(),
            mesh_is_a,
        );
        // The crossing is ln(1 + s).
        let of_crossing = self.found.crossings.clearness_by_pose() * (-crossing).exp();
        let [by_deviations, by_crossing] = judge.slopes_by_place(deviations, crossing);
        let of_place = of_deviations * by_deviations + of_crossing * by_crossing;
        let [by_place, by_extent] =
            judge.slopes_with_extent(self.by_place, self.of_geometry.extent);
        let mut of_geometry = of_place * by_place;
        if by_extent != 0.0 {
            of_geometry += self.found.extent_by_pose((a, b), a_from_b) * by_extent;
        }
        let [by_geometry, by_count] = self.misclassified.slopes(judge, self.by_geometry);
        let mut all = of_geometry * by_geometry;
        if by_count != 0.0 {
            let of_count = match self.misclassified.told_by {
                MisclassifiedBy::Nothing => Wrench::zeros(),
                MisclassifiedBy::Inside => self.looked.surely_inside_by_pose(mesh_is_a),
                MisclassifiedBy::Patch(patch) => {
                    misclassified_by_pose((a, b), a_from_b, (&self.found, patch), task, stats)?
                }
            };
            all += of_count * by_count;
        }
        Ok(all)
    }

    /// What the gap of a spot changes by.
    pub(super) fn gap_by_pose(
        &self,
        (a, b): (BodyRef<'_>, BodyRef<'_>),
        a_from_b: &Motion,
        spot: &Spot,
    ) -> Wrench {
        match spot.told_by {
            ToldBy::Pieces(index) => {
                gap_by_pose((a, b), a_from_b, &self.found.findings[index], spot)
            }
            ToldBy::Crossing(depth) => -depth,
            ToldBy::Inside => {
                let mesh_is_a = matches!(a, BodyRef::Mesh(_));
                let inside = self.looked.deepest.map(|inside| inside.depth_by_pose(mesh_is_a));
                -inside.unwrap_or_else(Wrench::zeros)
            }
        }
    }
}
