//! How far the object has to move to be out of a collision.

mod along;
mod depth;
mod held;
mod overlap;
mod shortest;

use std::time::Instant;

use cloudtouch_geom::{Pose, Vector3};
use serde::Serialize;

use self::along::{PRECISION, Way};
use self::held::HeldBy;
use self::overlap::Overlap;
use super::directions::{axes, downhill};
use crate::body::BodyRef;
use crate::error::QueryError;
use crate::query::run::Query;
use crate::report::{Report, vector_as_array};

/// The shortest of many ways is also the luckiest: at its end a collision has to be less likely than asked for by
/// this factor, for it to be as likely as that.
const LUCKIEST: f64 = 0.5;

/// The least translation that was found to end a collision.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Penetration {
    /// Where to, as a unit vector in the frame of the scene; nothing where the object need not move.
    #[serde(serialize_with = "vector_as_array")]
    pub direction: Vector3,
    /// How far until a collision is less likely than asked for, m: than half of that by the bound of the query,
    /// for the shortest of many ways is also the luckiest.
    pub distance_m: f64,
    /// How far until it is as likely as not, whichever way that is shortest, m: how deep the object is in, as
    /// far as is known. Of the probability, not of its upper bound.
    pub depth_m: f64,
    /// Half the distance along that way between where a collision has the probability Φ(1) = .84 and where it has
    /// Φ(−1) = .16, m: what the surfaces leave open of the depth; and, unless both bodies are exact, not less than how
    /// closely the way was looked for.
    pub std_m: f64,
}

impl Query {
    /// The least translation of the object after which a collision is less likely than `probability`, and
    /// the answer to [`Self::run`]: how to get out, and how deep it is in.
    ///
    /// It is an upper bound on the least there is: the object is free there, upper bound and doubts
    /// included, but a nearer place may be. It looks along the normals of contacts, where the gradient says,
    /// along the axes of both bodies and evenly in all directions, and turns the best toward the normal at
    /// its end. Only translations are tried, and only where they end: on the way the object may pass through
    /// something. `None` where no direction frees it, as where a doubt about the bodies themselves, their
    /// units say, keeps every place from reading as free, and where the deadline is over before all is
    /// told. Takes some three hundred queries in a collision and one elsewhere.
    ///
    /// ```
    /// use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3};
    /// use cloudtouch::{Mesh, Query, QuerySettings};
    ///
    /// let corner = |i: u32| [i & 1, i >> 1 & 1, i >> 2].map(|c| 0.1 * f64::from(c));
    /// let faces = [
    ///     [0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
    ///     [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5],
    /// ];
    /// let vertices = (0..8).map(|i| Point3::from(corner(i))).collect();
    /// let cube = Mesh::prepare(&TriangleMesh::new(vertices, faces.to_vec())?)?;
    /// let query = Query::new(QuerySettings::default())?;
    /// let pose = Pose::from_translation(Vector3::new(0.01, 0.0, 0.08));
    /// let (_, out) = query.penetration(&cube, &cube, &pose, 0.1)?;
    /// let out = out.unwrap();
    /// assert!((out.distance_m - 0.02).abs() < 1e-3 && out.direction.z > 0.99);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// When the probability is not between 0 and 1, and those of [`Self::run`].
    pub fn penetration<'a>(
        &self,
        a: impl Into<BodyRef<'a>>,
        b: impl Into<BodyRef<'a>>,
        a_from_b: &Pose,
        probability: f64,
    ) -> Result<(Report, Option<Penetration>), QueryError> {
        if !(probability > 0.0 && probability < 1.0) {
            return Err(QueryError::Probability { value: probability });
        }
        let this = self.begun_now();
        let clock = this.clock(Instant::now());
        let bodies = (a.into(), b.into());
        let (report, gradient) = this.gradient(bodies.0, bodies.1, a_from_b)?;
        if report.bounds[1] < probability {
            return Ok((report, Some(Penetration::NONE)));
        }
        let query = this.deciding(LUCKIEST * probability);
        let (told, held_by) = (|report: &Report| report.bounds[1], &HeldBy::default());
        let overlap = Overlap { query, clock, told, bodies, a_from_b, held_by };
        let normals = report.contacts.iter().map(|contact| contact.normal_a_to_b);
        let likely = normals.chain(downhill(&gradient, a_from_b)).chain(axes(a_from_b));
        let (shortest, looked_along) = overlap.shortest(likely)?;
        let Some(way) = shortest else { return Ok((report, None)) };
        let way = overlap.turned_to_normals(way, &this)?;
        let way = overlap.turned_aside(way)?;
        let way = overlap.between(way, PRECISION)?;
        let (deep, std_m) = overlap.depth(&this, &report, &way, &looked_along)?;
        let way = overlap.or_along(way, &deep)?;
        // What was not looked at in time counted as no way out, which would tell too deep.
        if clock.is_over() {
            return Ok((report, None));
        }
        let Way { direction, free: distance_m, .. } = way;
        Ok((report, Some(Penetration { direction, distance_m, depth_m: deep.free, std_m })))
    }
}

impl Penetration {
    /// Of an object that need not move.
    const NONE: Self =
        Self { direction: Vector3::new(0.0, 0.0, 0.0), distance_m: 0.0, depth_m: 0.0, std_m: 0.0 };
}
