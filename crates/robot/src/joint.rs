//! Joints: what moves a link against its parent.

use std::f64::consts::TAU;

use cloudtouch::geom::{Pose, UnitVector3, Vector3};
use nalgebra::UnitQuaternion;

use crate::error::RobotFault;

/// How a joint moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointKind {
    /// Not at all.
    Fixed,
    /// It turns, rad.
    Revolute,
    /// It turns without limits, rad.
    Continuous,
    /// It slides, m.
    Prismatic,
}

/// A joint of a robot.
#[derive(Debug, Clone)]
pub struct Joint {
    /// Its name in the URDF.
    pub name: String,
    /// How it moves.
    pub kind: JointKind,
    /// Lower and upper, rad or m; none for continuous and fixed joints.
    pub limits: Option<[f64; 2]>,
    /// The joint that it follows, if it does not move by itself.
    pub mimics: Option<Mimic>,
    /// By its place among the links.
    pub(crate) parent: usize,
    pub(crate) child: usize,
    /// From its frame at position 0 into that of the parent.
    pub(crate) origin: Pose,
    axis: UnitVector3,
}

/// Follows another joint: at `multiplier` times its position and `offset`.
#[derive(Debug, Clone, PartialEq)]
pub struct Mimic {
    /// Name of the joint followed.
    pub joint: String,
    /// rad or m for each rad or m of that.
    pub multiplier: f64,
    /// rad or m.
    pub offset: f64,
}

impl Joint {
    /// Checks all numbers; `parent` and `child` are places among the links.
    pub(crate) fn try_from_urdf(
        urdf: &urdf_rs::Joint,
        parent: usize,
        child: usize,
    ) -> Result<Self, RobotFault> {
        use urdf_rs::JointType;
        let name = urdf.name.clone();
        let place = format!("joint `{name}`");
        let unplaced = |kind| Err(RobotFault::JointKind { joint: name.clone(), kind });
        let kind = match urdf.joint_type {
            JointType::Fixed => JointKind::Fixed,
            JointType::Revolute => JointKind::Revolute,
            JointType::Continuous => JointKind::Continuous,
            JointType::Prismatic => JointKind::Prismatic,
            JointType::Floating => return unplaced("floating"),
            JointType::Planar => return unplaced("planar"),
            JointType::Spherical => return unplaced("spherical"),
        };
        let origin = pose(&urdf.origin, &place)?;
        let along = finite(&urdf.axis.xyz.0, &place, "axis")?;
        // That of a fixed joint is not used.
        let Some(axis) =
            direction(along.into()).or((kind == JointKind::Fixed).then(Vector3::x_axis))
        else {
            return Err(RobotFault::NoAxis { joint: name });
        };
        let limits = match kind {
            // As what is left out is read; 0 .. 0 beside an effort or a velocity keeps the joint there.
            JointKind::Revolute | JointKind::Prismatic
                if urdf.limit == urdf_rs::JointLimit::default() =>
            {
                let (kind, instead) = match kind {
                    JointKind::Revolute => ("revolute", "continuous"),
                    _ => ("prismatic", "fixed"),
                };
                return Err(RobotFault::NoLimit { joint: name, kind, instead });
            }
            JointKind::Revolute | JointKind::Prismatic => Some(limits(&urdf.limit, &name)?),
            JointKind::Fixed | JointKind::Continuous => None,
        };
        let mimics = urdf.mimic.as_ref().filter(|_| kind != JointKind::Fixed).map(|mimic| {
            let (multiplier, offset) =
                (mimic.multiplier.unwrap_or(1.0), mimic.offset.unwrap_or(0.0));
            finite(&[multiplier, offset], &place, "mimic")?;
            Ok(Mimic { joint: mimic.joint.clone(), multiplier, offset })
        });
        Ok(Self { name, kind, limits, mimics: mimics.transpose()?, parent, child, origin, axis })
    }

    /// From the frame of the child into that of the parent, at a position.
    pub(crate) fn parent_from_child(&self, position: f64) -> Pose {
        let by = match self.kind {
            JointKind::Fixed => Pose::identity(),
            JointKind::Revolute | JointKind::Continuous => Pose::from_translation_rotation(
                Vector3::zeros(),
                UnitQuaternion::from_axis_angle(&self.axis, position),
            ),
            JointKind::Prismatic => Pose::from_translation(self.axis.scale(position)),
        };
        self.origin.after(&by)
    }

    /// Whether it has a position of its own.
    pub fn is_free(&self) -> bool {
        self.kind != JointKind::Fixed && self.mimics.is_none()
    }
}

/// Of a vector of any length but about zero.
fn direction(along: Vector3) -> Option<UnitVector3> {
    let largest = along.amax();
    // By its largest entry, for squares of large ones are infinite.
    (largest > 1e-9).then(|| UnitVector3::new_normalize(along / largest))
}

/// URDF 1.2 writes no limit as none at all; infinite ones are none.
fn limits(limit: &urdf_rs::JointLimit, joint: &str) -> Result<[f64; 2], RobotFault> {
    let (lower, upper) = (limit.lower, limit.upper);
    if lower <= upper {
        return Ok([lower, upper]);
    }
    Err(RobotFault::Limits { joint: joint.to_owned(), lower, upper })
}

/// What a whole turn may be more, rad, where it is written with few digits.
const ROUNDED: f64 = 0.01;

/// An origin of the URDF.
pub(crate) fn pose(origin: &urdf_rs::Pose, of: &str) -> Result<Pose, RobotFault> {
    let offset = finite(&origin.xyz.0, of, "origin xyz")?;
    let turn = finite(&origin.rpy.0, of, "origin rpy")?;
    if let Some(&value) = turn.iter().find(|angle| angle.abs() > TAU + ROUNDED) {
        return Err(RobotFault::Turn { of: of.to_owned(), value });
    }
    Ok(Pose::from_translation_rpy(offset.into(), turn))
}

/// The numbers, where all are finite.
pub(crate) fn finite<const N: usize>(
    numbers: &[f64; N],
    of: &str,
    what: &'static str,
) -> Result<[f64; N], RobotFault> {
    match numbers.iter().find(|value| !value.is_finite()) {
        Some(&value) => Err(RobotFault::NotFinite { of: of.to_owned(), what, value }),
        None => Ok(*numbers),
    }
}
