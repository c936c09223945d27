//! Ordinary scenes with moderate noise, and the two bodies of a draw as queries take them.

use anyhow::Result;
use cloudtouch::{BodyRef, Cloud, Mesh};
use cloudtouch_testkit::family::Kind;

use crate::answers::{Answers, Pair};
use crate::methods::{Draw, Method, prepared};
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
        let (scene, object) = (prepared(draw.a)?, prepared(draw.b)?);
        Ok(Self { scene, object, mesh: Mesh::prepare(draw.mesh)? })
    }

    /// The scene, and the object as it is given.
    pub(super) fn pair(&self, pair: Pair) -> (BodyRef<'_>, BodyRef<'_>) {
        let object = pair.pick(BodyRef::from(&self.object), BodyRef::from(&self.mesh));
        (BodyRef::from(&self.scene), object)
    }
}
