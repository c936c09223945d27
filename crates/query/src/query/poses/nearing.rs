//! The motion of the object that brings two bodies nearer most quickly.

use cloudtouch_geom::{Motion, Pose};

use super::gradient::clearance_of_meshes;
use crate::body::BodyRef;
use crate::error::QueryError;
use crate::query::estimate::exact;
use crate::query::run::Query;
use crate::query::settings::Detail;
use crate::query::weigh::weigh;
use crate::report::Report;
use crate::search::{Wrench, force_at, in_object_frame};

impl Query {
    /// The answer to [`Self::run`], and the motion of the object, in its own frame, along which the
    /// clearance changes most; where there is none, that between the middles of the bodies.
    pub(super) fn run_and_nearing(
        &self,
        (a, b): (BodyRef<'_>, BodyRef<'_>),
        a_from_b: &Pose,
    ) -> Result<(Report, Wrench), QueryError> {
        let mut nearing = Wrench::zeros();
        let report =
            self.terms().ask((a.shape(), b.shape()), a_from_b, |start, local, evidence| {
                let motion = Motion::from(local);
                let between = || between_middles((a, b), &motion);
                let mut set = |wrench: Option<Wrench>| {
                    let wrench = wrench.unwrap_or_else(between);
                    nearing = in_object_frame(&wrench, &motion, &b.shape().origin()).into();
                };
                let task = self.task(start, (a, b));
                if let (BodyRef::Mesh(a), BodyRef::Mesh(b)) = (a, b) {
                    let estimate = exact((a, b), local, &task, evidence)?;
                    let is_told = !estimate.is_too_late;
                    set(if is_told { clearance_of_meshes((a, b), local)? } else { None });
                    return Ok(estimate);
                }
                let weighed = weigh((a, b), local, &task, &mut evidence.stats)?;
                let spots = weighed.spots((a, b), local);
                let is_full = self.settings().detail == Detail::Full;
                let estimate = weighed.estimate(is_full.then_some(&spots), &task, evidence);
                let nearest = weighed.nearest_spot(&spots, estimate.probability);
                set(nearest.map(|spot| weighed.gap_by_pose((a, b), &motion, spot)));
                Ok(estimate)
            })?;
        Ok((report, nearing))
    }
}

/// Local frames.
fn between_middles((a, b): (BodyRef<'_>, BodyRef<'_>), a_from_b: &Motion) -> Wrench {
    let middle = |body: BodyRef<'_>| {
        let [low, high] = body.shape().corners();
        nalgebra::center(&low, &high)
    };
    let (of_a, of_b) = (middle(a), a_from_b.point(&middle(b)));
    force_at(&nalgebra::center(&of_a, &of_b), &(of_b - of_a))
}
