//! How far the object has to move to be out of a collision.

use std::time::Instant;

use cloudtouch_geom::{Point3, Pose, Vector3};
use serde::Serialize;

use super::directions::{axes, ring, sphere};
use crate::body::BodyRef;
use crate::classifier::Clock;
use crate::error::QueryError;
use crate::placement::boxes;
use crate::query::run::Query;
use crate::report::{Report, vector_as_array};

/// The way out along a direction is told to this, relative and in metres.
const PRECISION: f64 = 0.01;
/// See [`PRECISION`].
const FINEST: f64 = 1e-4;
/// As long as others may be shorter it need not be known as well.
const ROUGHLY: f64 = 0.04;
/// A direction no farther than this from one that was looked along is not another, rad: contacts of one face
/// share their normal, and often an axis with it.
const SAME: f64 = 0.1;
/// A direction that is not free at this share of the shortest way out is given up.
const SHORTER: f64 = 0.97;
/// Of directions that nothing speaks for, a place this much nearer is tried too: on the way there may be
/// something else.
const NEARER: f64 = 0.6;
/// The shortest of many ways is also the luckiest: at its end a collision has to be less likely than asked for by
/// this factor, for it to be as likely as that.
const LUCKIEST: f64 = 0.5;
/// How often a direction is turned to the normal of the surfaces at the end of the way.
const TURNS: usize = 4;
/// Then others at these angles from it are tried, rad.
const ANGLES: [f64; 3] = [0.3, 0.15, 0.07];
/// How likely a number is above a standard deviation below its mean, above that, and above one more.
const LIKELY: [f64; 3] = [0.841_344_746, 0.5, 0.158_655_254];

/// The least translation that was found to end a collision.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
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
    /// Half of how much farther it is until a collision is one standard deviation less likely than not than
    /// until it is one more likely, along that way, m: what the surfaces leave open of the depth.
    pub std_m: f64,
}

/// Two bodies at a pose, and when the object is out.
struct Overlap<'a> {
    /// Decides at the probability it is out below.
    query: Query,
    /// Once it is over nothing more is out.
    clock: Clock,
    /// What is to be below it.
    told: fn(&Report) -> f64,
    bodies: (BodyRef<'a>, BodyRef<'a>),
    a_from_b: &'a Pose,
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
    /// let cube = Mesh::prepare(&TriangleMesh::try_new(vertices, faces.to_vec())?)?;
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
            let here = Penetration {
                direction: Vector3::zeros(),
                distance_m: 0.0,
                depth_m: 0.0,
                std_m: 0.0,
            };
            return Ok((report, Some(here)));
        }
        let query = this.deciding(LUCKIEST * probability);
        let overlap = Overlap { query, clock, told: |report| report.bounds[1], bodies, a_from_b };
        let mut likely: Vec<Vector3> = report.contacts.iter().map(|c| c.normal_a_to_b).collect();
        let climb = |gradient: &[f64; 6]| a_from_b.transform_vector(&first(gradient));
        likely.push(-climb(&gradient.log_odds));
        likely.extend(gradient.clearance.as_ref().map(climb));
        likely.extend(axes(a_from_b));
        let mut best = None;
        let mut known: Vec<Vector3> = Vec::new();
        for direction in likely.iter().filter_map(|d| d.try_normalize(0.0)) {
            if is_another(&mut known, direction) {
                overlap.shorten(&mut best, direction, &[SHORTER, 0.5, 0.25, 0.125, 0.0625])?;
            }
        }
        for direction in sphere() {
            if is_another(&mut known, direction) {
                overlap.shorten(&mut best, direction, &[SHORTER, NEARER])?;
            }
        }
        let Some(mut best) = best else { return Ok((report, None)) };
        for _ in 0..TURNS {
            let before = best;
            let toward = overlap.normal_at(best.direction * best.free, &this)?;
            if let Some(normal) = toward {
                best = overlap.shortened(best, normal, &[SHORTER])?;
            }
            if best.free > SHORTER * before.free {
                break;
            }
        }
        best = overlap.turned_aside(best)?;
        let Way { direction, free: distance_m, .. } = overlap.between(best, PRECISION)?;
        // No guarantees but expectations: bounds, which are wider the less is known, would only add to them.
        let until = |likely: f64| {
            let query = this.deciding(likely);
            Overlap { query, told: |report: &Report| report.collision_probability, ..overlap }
        };
        let [nearer, even, farther] = LIKELY.map(until);
        // The way that is shortest until then may be another.
        let mut depth = even.way_out(&report, direction, distance_m)?;
        if depth.free > FINEST {
            for direction in known {
                depth = even.shortened(depth, direction, &[SHORTER])?;
            }
            depth = even.between(even.turned_aside(depth)?, PRECISION)?;
        }
        let [near, far] = [nearer, farther]
            .map(|until| until.way_out(&report, depth.direction, depth.free).map(|way| way.free));
        let (depth_m, std_m) = (depth.free, 0.5 * (far? - near?));
        // What was not looked at in time counted as no way out, which would tell too deep.
        if clock.is_over() {
            return Ok((report, None));
        }
        Ok((report, Some(Penetration { direction, distance_m, depth_m, std_m })))
    }
}

/// Whether a direction is none of those known, to which it is added.
fn is_another(known: &mut Vec<Vector3>, direction: Vector3) -> bool {
    let is_new = known.iter().all(|other| other.dot(&direction) < SAME.cos());
    if is_new {
        known.push(direction);
    }
    is_new
}

/// The translation of a gradient.
fn first(gradient: &[f64; 6]) -> Vector3 {
    Vector3::new(gradient[0], gradient[1], gradient[2])
}

/// A way out along a unit vector.
#[derive(Clone, Copy)]
struct Way {
    direction: Vector3,
    /// So far along it the object is not out, or has not moved, m.
    stuck: f64,
    /// So far along it is, m.
    free: f64,
}

impl Overlap<'_> {
    fn is_free(&self, offset: Vector3) -> Result<bool, QueryError> {
        let (a, b) = self.bodies;
        let pose = Pose::from_translation(offset).after(self.a_from_b);
        Ok(!self.clock.is_over() && self.reads_free(&self.query.run(a, b, &pose)?))
    }

    fn reads_free(&self, report: &Report) -> bool {
        (self.told)(report) < self.query.settings().reject
    }

    /// Takes a way along `direction` that is free at one of these shares of the best, if there is one.
    fn shorten(
        &self,
        best: &mut Option<Way>,
        direction: Vector3,
        shares: &[f64],
    ) -> Result<(), QueryError> {
        *best = match *best {
            Some(known) => Some(self.shortened(known, direction, shares)?),
            None => self.first_way(direction)?,
        };
        Ok(())
    }

    fn shortened(&self, best: Way, direction: Vector3, shares: &[f64]) -> Result<Way, QueryError> {
        for share in shares {
            let free = share * best.free;
            if self.is_free(direction * free)? {
                return self.between(Way { direction, stuck: 0.0, free }, ROUGHLY);
            }
        }
        Ok(best)
    }

    /// The nearest free place along a direction as far as doubling steps show, up to where the boxes of
    /// both bodies are apart.
    fn first_way(&self, direction: Vector3) -> Result<Option<Way>, QueryError> {
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
    fn way_out(&self, here: &Report, direction: Vector3, near: f64) -> Result<Way, QueryError> {
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

    /// The best of ways a little aside.
    fn turned_aside(&self, mut best: Way) -> Result<Way, QueryError> {
        for angle in ANGLES {
            let around = best.direction;
            for direction in ring(&around, angle) {
                best = self.shortened(best, direction, &[SHORTER])?;
            }
        }
        Ok(best)
    }

    /// The same way, known to a share of it by bisection.
    fn between(&self, mut way: Way, precision: f64) -> Result<Way, QueryError> {
        while way.free - way.stuck > FINEST.max(precision * way.free) {
            let middle = 0.5 * (way.stuck + way.free);
            match self.is_free(way.direction * middle)? {
                true => way.free = middle,
                false => way.stuck = middle,
            }
        }
        Ok(way)
    }

    /// Where the surfaces lead out most directly after a translation, as a unit vector.
    fn normal_at(&self, offset: Vector3, query: &Query) -> Result<Option<Vector3>, QueryError> {
        let (a, b) = self.bodies;
        let pose = Pose::from_translation(offset).after(self.a_from_b);
        let (_, gradient) = query.gradient(a, b, &pose)?;
        let climb =
            |gradient: &[f64; 6]| pose.transform_vector(&first(gradient)).try_normalize(0.0);
        Ok(climb(&gradient.log_odds).map(|n| -n).or_else(|| climb(&gradient.clearance?)))
    }

    /// How far it is until the boxes of both bodies are apart by their size, m.
    fn apart(&self, direction: &Vector3) -> f64 {
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
