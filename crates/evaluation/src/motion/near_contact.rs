//! Ordinary scenes with moderate noise, and the two bodies of a draw as queries take them.

use anyhow::Result;
use cloudtouch::{BodyRef, Cloud, CloudSettings, Mesh};
use cloudtouch_testkit::family::{Kind, Observation};

use crate::answers::{Answers, Pair};
use crate::methods::{Draw, Method, sensor_of};
use crate::sweep::{Asked, Plan, ask};

/// Standard deviations of the noise in these scenes, m.
pub(super) const STDS: [f64; 2] = [0.002, 0.01];

/// What a method says of the ordinary families at up to 10 mm of noise.
pub(super) fn answers(draws: u32, poses: usize, method: impl Method + 'static) -> Result<Answers> {
    let mut plan = Plan::full(draws, poses);
    plan.families.retain(|family| family.kind == Kind::Ordinary);
    plan.conditions.retain(|c| c.points == 10_000 && STDS.contains(&c.std));
    ask(&plan, &[Asked::always(method)])
}

/// The bodies of a draw, prepared.
pub(super) struct Bodies {
    scene: Cloud,
    object: Cloud,
    mesh: Mesh,
}

impl Bodies {
    pub(super) fn prepare(draw: &Draw<'_>) -> Result<Self> {
        let cloud =
            |seen: &Observation| Cloud::prepare(&seen.cloud, &CloudSettings::new(sensor_of(seen)));
        let (scene, object) = (cloud(draw.a)?, cloud(draw.b)?);
        Ok(Self { scene, object, mesh: Mesh::prepare(draw.mesh)? })
    }

    /// The scene, and the object as it is given.
    pub(super) fn pair(&self, pair: Pair) -> (BodyRef<'_>, BodyRef<'_>) {
        let object = match pair {
            Pair::CloudCloud => BodyRef::from(&self.object),
            Pair::CloudMesh => BodyRef::from(&self.mesh),
        };
        (BodyRef::from(&self.scene), object)
    }
}
