//! How the moving body comes to a first contact.

use cloudtouch_geom::Vector3;
use nalgebra::UnitQuaternion;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{
    ends::Ends,
    grasp::Grasp,
    guided::{Flat, Reach, Upright},
    pair::Pair,
    seeing::Seen,
    wanted::Wanted,
};
use crate::{
    poses::Approach,
    random::{between, direction, direction_near, small_rotation},
};

/// The kind of path to contact.
pub(super) enum Motion {
    /// Turned at random, from anywhere in or around the scene's box to a point of its surface.
    Open { ends: Ends, deepest: f64 },
    /// Down on the face z = `top` of a plate of side `size`, an edge or corner ahead; the body's
    /// edge is `length` long on its y axis.
    EdgeFirst { top: f64, size: f64, length: f64 },
    /// Inside a hole along z, sideways to its wall; from outside when the contact need not be near.
    InHole { ends: Ends, depth: f64, peg_length: f64, clearance: f64 },
    /// Linked with a ring about z, to its tube; sometimes from outside.
    Linked { ends: Ends, major: f64 },
    /// A gripper, from above or from where the camera is.
    Grasp(Grasp),
    /// A hand or tool, ahead.
    Reach { reach: Reach, deepest: f64 },
    /// Upright, as a robot drives or a box is carried.
    Upright(Upright),
    /// Set down, or put against something.
    Flat(Flat),
}

impl Motion {
    /// How far into contact poses go, m.
    pub(super) fn deepest(&self) -> f64 {
        match self {
            Self::Open { deepest, .. } | Self::Reach { deepest, .. } => *deepest,
            Self::EdgeFirst { .. }
            | Self::InHole { .. }
            | Self::Linked { .. }
            | Self::Upright { .. } => 0.2,
            Self::Flat(_) => 0.1,
            Self::Grasp(_) => 0.06,
        }
    }

    /// A path to contact with what is `seen` of the body that stays; `None` when this draw gave
    /// none.
    pub(super) fn approach(
        &self,
        pair: Pair,
        seen: &Seen,
        wanted: Wanted,
        rng: &mut ChaCha8Rng,
    ) -> Option<Approach> {
        let inside_share = if wanted.is_near() { 0.8 } else { 0.5 };
        match self {
            Self::Open { ends, .. } => Some(ends.approach(pair, rng)),
            Self::EdgeFirst { top, size, length } => {
                pair.straight(edge_first(*top, *size, *length, rng))
            }
            Self::InHole { ends, depth, peg_length, clearance } => {
                // A near pose out of the hole is an easy one.
                if wanted == Wanted::Free || rng.random::<f64>() > inside_share {
                    return Some(ends.approach(pair, rng));
                }
                pair.straight(in_hole(*depth, *peg_length, *clearance, rng))
            }
            Self::Linked { ends, major } => {
                if rng.random::<f64>() > inside_share {
                    return Some(ends.approach(pair, rng));
                }
                pair.straight(linked(*major, rng))
            }
            Self::Grasp(grasp) => grasp.approach(pair, seen, rng),
            Self::Reach { reach, .. } => reach.approach(pair, rng),
            Self::Upright(upright) => upright.approach(pair, rng),
            Self::Flat(flat) => flat.approach(pair, rng),
        }
    }
}

/// From a metre above the plate, nearly straight down, half of them with a corner ahead.
fn edge_first(top: f64, size: f64, length: f64, rng: &mut ChaCha8Rng) -> Approach {
    let lean = if rng.random() { between(0.0, 0.1, rng) } else { between(0.3, 0.8, rng) };
    let rotation =
        UnitQuaternion::from_scaled_axis(Vector3::z() * between(0.0, std::f64::consts::TAU, rng))
            * small_rotation(0.15, rng)
            * UnitQuaternion::from_scaled_axis(Vector3::x() * lean);
    let grip = rotation * Vector3::new(0.0, length * between(-0.5, 0.5, rng), 0.0);
    let mut across = || size * between(-0.5, 0.5, rng);
    let target = Vector3::new(across(), across(), top);
    let direction = direction_near(&-Vector3::z(), 0.4, rng);
    Approach { rotation, start: target - grip - direction, direction, contact: 0.0 }
}

/// From near the axis of the hole, turned as far as the clearance may allow, mostly sideways.
fn in_hole(depth: f64, peg_length: f64, clearance: f64, rng: &mut ChaCha8Rng) -> Approach {
    let tilt = small_rotation(2.0 * clearance / depth, rng);
    let roll = between(0.0, std::f64::consts::TAU, rng);
    let inserted = between(0.2 * depth, depth.min(peg_length), rng);
    // The peg's lower end is so far below the upper rim of the hole.
    let height = 0.5 * (depth + peg_length) - inserted;
    let axis = tilt * Vector3::z();
    // The middle of the inserted part stays about the hole's axis.
    let along = 0.5 * (peg_length - inserted);
    let middle = Vector3::z() * (height - along);
    let mut offset = direction(rng) * between(0.0, 0.5 * clearance, rng);
    offset.z = 0.0;
    let sideways = UnitQuaternion::from_scaled_axis(Vector3::z() * between(0.0, 7.0, rng));
    Approach {
        rotation: tilt * UnitQuaternion::from_scaled_axis(Vector3::z() * roll),
        start: middle + axis * along + offset,
        direction: direction_near(&(sideways * Vector3::x()), 0.2, rng),
        contact: 0.0,
    }
}

/// From a place where the moving ring passes near the middle of the other, somehow turned.
fn linked(major: f64, rng: &mut ChaCha8Rng) -> Approach {
    let around = UnitQuaternion::from_scaled_axis(Vector3::z() * between(0.0, 7.0, rng));
    // A ring about z stood up, so that it goes around the x axis' tube.
    let upright = UnitQuaternion::from_scaled_axis(Vector3::x() * std::f64::consts::FRAC_PI_2);
    Approach {
        rotation: around * small_rotation(0.7, rng) * upright,
        start: around * Vector3::x() * major + direction(rng) * between(0.0, 0.2 * major, rng),
        direction: direction(rng),
        contact: 0.0,
    }
}
