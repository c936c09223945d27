//! How the moving body comes to a first contact.

use cloudtouch_geom::{Point3, TriangleMesh, Vector3, seed};
use nalgebra::UnitQuaternion;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{FamilyScene, grasp::Grasp, labels::Wanted};
use crate::{
    exact::{ExactMesh, Touch},
    poses::Approach,
    random::{between, direction, direction_near, small_rotation},
    surface::{SurfaceSample, sample_surface},
};

/// The kind of path to contact, besides the one from anywhere that all but two families have.
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
}

/// Points of the two surfaces between which paths lead.
pub(super) struct Ends {
    targets: Vec<SurfaceSample>,
    grips: Vec<SurfaceSample>,
}

impl Ends {
    /// A thousand points of each surface that sensors see.
    pub(super) fn of(scene: &TriangleMesh, object: &TriangleMesh, seed: u64) -> Self {
        let points = |mesh, stream| sample_surface(mesh, 1000, seed::derive(seed, 100, stream));
        Self { targets: points(scene, 0), grips: points(object, 1) }
    }

    fn approach(
        &self,
        a: &ExactMesh,
        b: &ExactMesh,
        touch: Touch,
        rng: &mut ChaCha8Rng,
    ) -> Approach {
        Approach::draw(a, b, touch, &self.targets, &self.grips, rng)
    }
}

impl Motion {
    /// How far into contact poses go, m.
    pub(super) fn deepest(&self) -> f64 {
        match self {
            Self::Open { deepest, .. } => *deepest,
            Self::EdgeFirst { .. } | Self::InHole { .. } | Self::Linked { .. } => 0.2,
            Self::Grasp(_) => 0.06,
        }
    }
}

impl FamilyScene {
    /// A path to contact; `None` when this draw gave none.
    pub(super) fn approach(&self, wanted: Wanted, rng: &mut ChaCha8Rng) -> Option<Approach> {
        let open =
            |ends: &Ends, rng: &mut ChaCha8Rng| ends.approach(&self.a, &self.b, self.touch, rng);
        let inside_share = if wanted.is_near() { 0.8 } else { 0.5 };
        match &self.motion {
            Motion::Open { ends, .. } => Some(open(ends, rng)),
            Motion::EdgeFirst { top, size, length } => {
                self.straight(edge_first(*top, *size, *length, rng))
            }
            Motion::InHole { ends, depth, peg_length, clearance } => {
                // A near pose out of the hole is an easy one.
                if wanted == Wanted::Free || rng.random::<f64>() > inside_share {
                    return Some(open(ends, rng));
                }
                self.straight(in_hole(*depth, *peg_length, *clearance, rng))
            }
            Motion::Linked { ends, major } => {
                if rng.random::<f64>() > inside_share {
                    return Some(open(ends, rng));
                }
                self.straight(linked(*major, rng))
            }
            Motion::Grasp(grasp) => grasp.approach(self, rng),
        }
    }

    /// The path from a start on to contact; `None` when the start is not free.
    ///
    /// There must be a contact ahead.
    pub(super) fn straight(&self, mut approach: Approach) -> Option<Approach> {
        if self.a.touches(&self.b, &approach.pose(0.0), self.touch) {
            return None;
        }
        approach.advance(&self.a, &self.b);
        Some(approach)
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

/// The points of samples.
pub(super) fn points(samples: &[SurfaceSample]) -> Vec<Point3> {
    samples.iter().map(|s| s.position).collect()
}
