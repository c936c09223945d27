//! A robot: links as meshes, joined to a tree.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use cloudtouch::SelfMesh;
use cloudtouch::geom::Pose;

use crate::error::{JointsError, UnknownLink};
use crate::joint::Joint;
use crate::link::Shape;
use crate::may_touch::MayTouch;
use crate::tree::Tree;
use crate::uri::in_package;

/// A robot read from a URDF, with the `<collision>` geometry of its links prepared for queries.
///
/// Meshes and boxes are exact; round primitives reach beyond what they stand for by at most
/// [`EXCESS`](crate::EXCESS) of their radius, and nowhere less far. A link without `<collision>` is not
/// there for any query, as URDF means it: [`Self::unchecked_links`] names those that can be seen.
#[derive(Debug, Clone)]
pub struct Robot {
    pub(crate) tree: Tree,
    pub(crate) shapes: Vec<Shape>,
    pub(crate) unchecked: Vec<String>,
    pub(crate) unknown: Vec<String>,
    pub(crate) may_touch: MayTouch,
}

impl Robot {
    /// The joints from the root outwards.
    pub fn joints(&self) -> &[Joint] {
        &self.tree.joints
    }

    /// The names of all links, in the order of the URDF.
    pub fn links(&self) -> &[String] {
        &self.tree.links
    }

    /// Links that have `<visual>` geometry and no `<collision>`: no query sees them.
    pub fn unchecked_links(&self) -> &[String] {
        &self.unchecked
    }

    /// Links that an SRDF says not to check and that are not there: of another variant, or misspelt, so
    /// that the pair that was meant is checked.
    pub fn unknown_links(&self) -> &[String] {
        &self.unknown
    }

    /// The packages that meshes of links are in, by the names in their `package://`.
    pub fn packages(&self) -> BTreeSet<&str> {
        let uris = self.shapes.iter().filter_map(|shape| shape.uri.as_deref());
        uris.filter_map(in_package).map(|(package, _)| package).collect()
    }

    /// Whether two links may touch: where no joint between them moves, where one is the next with
    /// geometry along the chain from the other, and where an SRDF says so.
    ///
    /// # Errors
    /// When the robot has no link of one of these names.
    pub fn may_touch(&self, a: &str, b: &str) -> Result<bool, UnknownLink> {
        for name in [a, b] {
            if !self.tree.links.iter().any(|link| link == name) {
                return Err(UnknownLink::new(name, &self.tree.links));
            }
        }
        Ok(self.is_allowed(a, b))
    }

    /// The same of links that there are.
    pub(crate) fn is_allowed(&self, a: &str, b: &str) -> bool {
        self.may_touch.has(a, b)
    }

    /// Where every link is by positions of the joints, rad and m: from its frame into that of the
    /// base, by name. Joints that mimic others follow them.
    ///
    /// # Errors
    /// When a joint is unknown, left out, not finite or beyond its limits.
    pub fn link_poses(
        &self,
        joints: &BTreeMap<String, f64>,
    ) -> Result<BTreeMap<&str, Pose>, JointsError> {
        let poses = self.tree.poses(&self.tree.positions(joints)?);
        Ok(self.tree.links.iter().map(String::as_str).zip(poses).collect())
    }

    /// The links where a camera saw them, for [`FilterSettings::robot`](cloudtouch::FilterSettings::robot):
    /// points inside, or within `padding` metres of the surface, are removed from its scan. `joints` are
    /// those at the time of the *scan*; at those asked about the filter would remove what is in the way. Meshes are
    /// those of the robot, shared.
    ///
    /// # Errors
    /// As [`Self::link_poses`].
    pub fn self_filter(
        &self,
        joints: &BTreeMap<String, f64>,
        cloud_from_base: &Pose,
        padding: f64,
    ) -> Result<Vec<SelfMesh>, JointsError> {
        let poses = self.tree.poses(&self.tree.positions(joints)?);
        let seen = self.shapes.iter().map(|shape| {
            let cloud_from_link = cloud_from_base.after(&poses[shape.link]);
            SelfMesh { mesh: Arc::clone(&shape.mesh), cloud_from_link, padding }
        });
        Ok(seen.collect())
    }

    /// By the names that bodies of a scene have: that of the link, with a number from 0 where it has
    /// several shapes.
    pub(crate) fn body_names(&self) -> Vec<String> {
        let several: BTreeSet<usize> = self
            .shapes
            .windows(2)
            .filter(|two| two[0].link == two[1].link)
            .map(|two| two[0].link)
            .collect();
        let mut count = BTreeMap::new();
        let name = |shape: &Shape| {
            let link = &self.tree.links[shape.link];
            let place = count.entry(shape.link).or_insert(0);
            *place += 1;
            if several.contains(&shape.link) {
                format!("{link}/{}", *place - 1)
            } else {
                link.clone()
            }
        };
        self.shapes.iter().map(name).collect()
    }
}
