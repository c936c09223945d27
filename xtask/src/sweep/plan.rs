//! Which scenes are asked about, under which conditions, by which methods.

use cloudtouch_testkit::{family::Family, noise::NoiseKind};

use super::record::Condition;

/// Standard deviations of the noise, m.
pub(super) const STDS: [f64; 5] = [0.0, 0.002, 0.005, 0.01, 0.02];
/// Points of each cloud that results are pooled over.
pub(super) const POINTS: [usize; 3] = [2_500, 5_000, 10_000];
/// Clouds as dense as a depth image.
pub(super) const DENSE: usize = 40_000;
/// Variants of each family, each with a part of the poses.
const VARIANTS: u64 = 4;

/// One family with its poses and conditions.
pub(crate) struct Part {
    pub family: Family,
    /// Poses of each variant.
    pub poses_of_variant: usize,
    pub variants: u64,
    pub conditions: Vec<Condition>,
}

/// Who answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Methods {
    /// Ours alone.
    Ours,
    /// Ours, which gathers all evidence however clear the first of it is.
    Evidence,
    /// Ours, the paper's mode and the alternatives.
    All,
}

/// What a sweep consists of.
pub(crate) struct Plan {
    pub parts: Vec<Part>,
    pub methods: Methods,
}

impl Plan {
    /// Every family under every noise and density, dense clouds at 2 mm, heavy tails at 5 mm.
    pub(super) fn full(poses: usize) -> Self {
        let part = |&family: &Family| Part {
            family,
            poses_of_variant: poses.div_ceil(VARIANTS as usize),
            variants: VARIANTS,
            conditions: conditions(family.name()),
        };
        Self { parts: Family::ALL.iter().map(part).collect(), methods: Methods::All }
    }

    /// The evidence on poses that [`Self::full`] does not ask about, of every family of clouds.
    pub(crate) fn evidence(poses: usize) -> Self {
        let mut plan = Self::full(poses);
        // Against a mesh there is another model.
        plan.parts.retain(|part| part.family != Family::Tabletop);
        Self { methods: Methods::Evidence, ..plan }
    }

    /// One condition of a few families, ours alone.
    pub(super) fn short(families: &[Family], poses: usize, points: usize, std: f64) -> Self {
        let part = |&family: &Family| Part {
            family,
            poses_of_variant: poses,
            variants: 1,
            conditions: vec![gaussian(family.name(), points, std)],
        };
        Self { parts: families.iter().map(part).collect(), methods: Methods::Ours }
    }
}

fn conditions(family: &'static str) -> Vec<Condition> {
    let mut all: Vec<Condition> =
        POINTS.iter().flat_map(|&points| STDS.map(|std| gaussian(family, points, std))).collect();
    all.push(gaussian(family, DENSE, 0.002));
    all.push(Condition { noise: NoiseKind::HeavyTailed, ..gaussian(family, 10_000, 0.005) });
    all
}

fn gaussian(family: &'static str, points: usize, std: f64) -> Condition {
    Condition { family, points, noise: NoiseKind::Gaussian, std }
}
