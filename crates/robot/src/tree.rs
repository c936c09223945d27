//! Forward kinematics: where all links are by the positions of the joints.

use std::collections::{BTreeMap, BTreeSet};

use cloudtouch::geom::Pose;

use crate::error::{JointsError, RobotFault};
use crate::joint::{Joint, JointKind};

/// Links joined to one tree.
#[derive(Debug, Clone)]
pub(crate) struct Tree {
    /// Names of the links in the order of the URDF.
    pub links: Vec<String>,
    /// From the root outwards: a joint comes after that which carries its parent.
    pub joints: Vec<Joint>,
    /// For each link the joint that carries it.
    pub carried_by: Vec<Option<usize>>,
}

/// Positions that exceed a limit by so little are rounded, rad or m.
const ROUNDING: f64 = 1e-6;

impl Tree {
    pub(crate) fn try_from_urdf(urdf: &urdf_rs::Robot) -> Result<Self, RobotFault> {
        let links: Vec<String> = urdf.links.iter().map(|link| link.name.clone()).collect();
        let mut index_of = BTreeMap::new();
        for (index, name) in links.iter().enumerate() {
            if index_of.insert(name.as_str(), index).is_some() {
                return Err(RobotFault::Repeated { what: "link", name: name.clone() });
            }
        }
        let mut names = BTreeSet::new();
        let mut carrier: Vec<Option<Joint>> = vec![None; links.len()];
        for joint in &urdf.joints {
            let name = || joint.name.clone();
            if !names.insert(&joint.name) {
                return Err(RobotFault::Repeated { what: "joint", name: name() });
            }
            let place = |role, link: &urdf_rs::LinkName| {
                let unknown =
                    || RobotFault::UnknownLink { joint: name(), role, link: link.link.clone() };
                index_of.get(link.link.as_str()).copied().ok_or_else(unknown)
            };
            let (parent, child) = (place("parent", &joint.parent)?, place("child", &joint.child)?);
            if carrier[child].replace(Joint::try_from_urdf(joint, parent, child)?).is_some() {
                return Err(RobotFault::TwoParents { link: links[child].clone(), joint: name() });
            }
        }
        let tree = outwards(links, carrier)?;
        tree.check_mimics()?;
        Ok(tree)
    }

    /// The position of every joint in the order of [`Self::joints`], 0 of the fixed ones.
    pub(crate) fn positions(&self, given: &BTreeMap<String, f64>) -> Result<Vec<f64>, JointsError> {
        let free: BTreeSet<&str> = self
            .joints
            .iter()
            .filter(|joint| joint.is_free())
            .map(|joint| joint.name.as_str())
            .collect();
        let moves = |name: &str| {
            free.contains(name)
                || self.joints.iter().any(|joint| joint.mimics.is_some() && joint.name == name)
        };
        for (name, &value) in given {
            if !moves(name) {
                return Err(JointsError::Unknown { name: name.clone(), known: listed(&free) });
            }
            if !value.is_finite() {
                return Err(JointsError::NotFinite { name: name.clone(), value });
            }
        }
        let missing: BTreeSet<&str> =
            free.iter().copied().filter(|&name| !given.contains_key(name)).collect();
        if !missing.is_empty() {
            return Err(JointsError::Missing { names: listed(&missing) });
        }
        self.joints.iter().map(|joint| position(joint, given)).collect()
    }

    /// From the frame of every link into that of the base.
    pub(crate) fn poses(&self, positions: &[f64]) -> Vec<Pose> {
        let mut poses = vec![Pose::identity(); self.links.len()];
        for (joint, &position) in self.joints.iter().zip(positions) {
            poses[joint.child] = poses[joint.parent].after(&joint.parent_from_child(position));
        }
        poses
    }

    /// The link that nothing carries.
    pub(crate) fn root(&self) -> usize {
        self.joints.first().map_or(0, |joint| joint.parent)
    }

    /// The joints that carry a link, outermost first.
    pub(crate) fn chain(&self, link: usize) -> impl Iterator<Item = usize> {
        let parent = |&joint: &usize| self.carried_by[self.joints[joint].parent];
        std::iter::successors(self.carried_by[link], parent)
    }

    /// A joint that mimics follows one that is given.
    fn check_mimics(&self) -> Result<(), RobotFault> {
        for joint in &self.joints {
            let Some(mimic) = &joint.mimics else { continue };
            let is_followed = |other: &Joint| other.name == mimic.joint && other.is_free();
            if !self.joints.iter().any(is_followed) {
                let (joint, followed) = (joint.name.clone(), mimic.joint.clone());
                return Err(RobotFault::Mimic { joint, followed });
            }
        }
        Ok(())
    }
}

/// Orders joints from the root outwards.
fn outwards(links: Vec<String>, mut carrier: Vec<Option<Joint>>) -> Result<Tree, RobotFault> {
    let mut hanging: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for joint in carrier.iter().flatten() {
        hanging.entry(joint.parent).or_default().push(joint.child);
    }
    let root = carrier.iter().position(Option::is_none);
    let mut joints = Vec::new();
    let mut carried_by = vec![None; links.len()];
    let mut reached: Vec<usize> = root.into_iter().collect();
    let mut next = 0;
    while let Some(&link) = reached.get(next) {
        next += 1;
        for &child in hanging.get(&link).into_iter().flatten() {
            carried_by[child] = Some(joints.len());
            joints.extend(carrier[child].take());
            reached.push(child);
        }
    }
    let reached: BTreeSet<usize> = reached.into_iter().collect();
    if let Some(lost) = (0..links.len()).find(|link| !reached.contains(link)) {
        let root = root.map_or(String::new(), |root| links[root].clone());
        return Err(not_a_tree(&links, &carrier, root, lost));
    }
    Ok(Tree { links, joints, carried_by })
}

/// Why no chain of joints leads from the root to a link, by the joints that are not under it.
fn not_a_tree(
    links: &[String],
    carrier: &[Option<Joint>],
    root: String,
    lost: usize,
) -> RobotFault {
    let name = |link: usize| links[link].clone();
    let up = |&link: &usize| carrier[link].as_ref().map(|joint| joint.parent);
    // More steps than there are links lead around a circle.
    match std::iter::successors(Some(lost), up).take(links.len() + 1).enumerate().last() {
        Some((steps, link)) if steps < links.len() => {
            RobotFault::NotATree { root, link: name(link) }
        }
        at => RobotFault::Circle { link: name(at.map_or(lost, |(_, link)| link)) },
    }
}

/// Where a joint is; all that it follows are given.
fn position(joint: &Joint, given: &BTreeMap<String, f64>) -> Result<f64, JointsError> {
    let of = |name: &str| given.get(name).copied();
    let value = match &joint.mimics {
        None => of(&joint.name).unwrap_or(0.0),
        Some(mimic) => {
            let followed = of(&mimic.joint).unwrap_or(f64::NAN);
            let implied = mimic.multiplier * followed + mimic.offset;
            match of(&joint.name) {
                Some(value) if (value - implied).abs() > ROUNDING => {
                    let (name, followed) = (joint.name.clone(), mimic.joint.clone());
                    return Err(JointsError::Mimic { name, followed, implied, value });
                }
                _ => implied,
            }
        }
    };
    match joint.limits {
        Some([lower, upper]) if !(lower - ROUNDING..=upper + ROUNDING).contains(&value) => {
            let name = joint.name.clone();
            if lower == 0.0 && upper == 0.0 {
                let turns = joint.kind == JointKind::Revolute;
                let instead = if turns { ", or make it continuous" } else { "" };
                return Err(JointsError::NoRange { name, value, instead });
            }
            let hint = if value.abs() > std::f64::consts::TAU {
                ", or is it in degrees or mm?"
            } else {
                ""
            };
            Err(JointsError::Limit { name, value, lower, upper, hint })
        }
        _ => Ok(value),
    }
}

fn listed(names: &BTreeSet<&str>) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    names.join(", ")
}
