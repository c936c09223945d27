//! How far it is out along one direction.

use cloudtouch_geom::Vector3;

use super::overlap::Overlap;
use crate::error::QueryError;
use crate::report::Report;

/// The way out along a direction is told to this, relative and in metres.
pub(super) const PRECISION: f64 = 0.01;
/// See [`PRECISION`].
pub(super) const FINEST: f64 = 1e-4;
/// As long as others may be shorter it need not be known as well.
pub(super) const ROUGHLY: f64 = 0.04;

/// A way out along a unit vector.
#[derive(Clone, Copy)]
pub(super) struct Way {
    pub direction: Vector3,
    /// So far along it the object is not out, or has not moved, m.
    pub stuck: f64,
    /// So far along it is, m.
    pub free: f64,
}

impl Overlap<'_> {
    /// The nearest free place along a direction as far as doubling steps show, up to where the boxes of
    /// both bodies are apart.
    pub(super) fn first_way(&self, direction: Vector3) -> Result<Option<Way>, QueryError> {
        let far = self.apart(&direction);
        let mut way = Way { direction, stuck: 0.0, free: 10.0 * FINEST };
        while !self.is_free(direction * way.free)? {
            if way.free > far {
                return Ok(None);
            }
            way = Way { stuck: way.free, free: 2.0 * way.free, ..way };
        }
        self.between(way, ROUGHLY).map(Some)
    }

    /// The way along a direction to where it is free, near to where it is for another probability; none
    /// where it is free `here` already.
    pub(super) fn way_out(
        &self,
        here: &Report,
        direction: Vector3,
        near: f64,
    ) -> Result<Way, QueryError> {
        let far = self.apart(&direction);
        if self.reads_free(here) {
            return Ok(Way { direction, stuck: 0.0, free: 0.0 });
        }
        let mut way = Way { direction, stuck: 0.0, free: near.max(FINEST) };
        while !self.is_free(direction * way.free)? {
            if way.free > far {
                return Ok(way);
            }
            way = Way { stuck: way.free, free: 1.5 * way.free, ..way };
        }
        self.between(way, PRECISION)
    }

    /// The same way, known to a share of it by bisection.
    pub(super) fn between(&self, mut way: Way, precision: f64) -> Result<Way, QueryError> {
        while way.free - way.stuck > FINEST.max(precision * way.free) {
            let middle = 0.5 * (way.stuck + way.free);
            match self.is_free(way.direction * middle)? {
                true => way.free = middle,
                false => way.stuck = middle,
            }
        }
        Ok(way)
    }
}
