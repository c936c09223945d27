//! Whether the object is out of a collision, and where out is.

use cloudtouch_geom::{Point3, Pose, Vector3};

use super::held::HeldBy;
use crate::body::BodyRef;
use crate::classifier::Clock;
use crate::error::QueryError;
use crate::placement::boxes;
use crate::query::poses::directions::downhill;
use crate::query::run::Query;
use crate::report::Report;

/// Two bodies at a pose, and when the object is out.
#[derive(Clone, Copy)]
pub(super) struct Overlap<'a> {
    /// Decides at the probability it is out below.
    pub query: Query,
    /// Once it is over nothing more is out.
    pub clock: Clock,
    /// What is to be below it.
    pub told: fn(&Report) -> f64,
    pub bodies: (BodyRef<'a>, BodyRef<'a>),
    pub a_from_b: &'a Pose,
    pub held_by: &'a HeldBy,
}

impl Overlap<'_> {
    /// Whether the object is out after a translation.
    pub(super) fn is_free(&self, offset: Vector3) -> Result<bool, QueryError> {
        let pose = Pose::from_translation(offset).after(self.a_from_b);
        if self.clock.is_over() || self.held_by.is_still(&self.query, self.bodies, &pose) {
            return Ok(false);
        }
        Ok(self.reads_free(&self.held_by.run(&self.query, self.bodies, &pose)?))
    }

    /// Whether it is out by this report.
    pub(super) fn reads_free(&self, report: &Report) -> bool {
        (self.told)(report) < self.query.settings().reject
    }

    /// Where the surfaces lead out most directly after a translation, as a unit vector.
    pub(super) fn normal_at(
        &self,
        offset: Vector3,
        query: &Query,
    ) -> Result<Option<Vector3>, QueryError> {
        let (a, b) = self.bodies;
        let pose = Pose::from_translation(offset).after(self.a_from_b);
        let (_, gradient) = query.gradient(a, b, &pose)?;
        Ok(downhill(&gradient, &pose).find_map(|direction| direction.try_normalize(0.0)))
    }

    /// How far it is until the boxes of both bodies are apart by their size, m.
    pub(super) fn apart(&self, direction: &Vector3) -> f64 {
        let (a, b) = self.bodies;
        let [of_a, of_b] = boxes(a.shape(), b.shape(), self.a_from_b);
        let reach = |corners: [Point3; 2], sign: f64| -> f64 {
            let along = sign * direction;
            let [low, high] = corners.map(|corner| along.component_mul(&corner.coords));
            low.sup(&high).sum()
        };
        let until = reach(of_a, 1.0) + reach(of_b, -1.0);
        until.max(0.0) + b.shape().size()
    }
}
