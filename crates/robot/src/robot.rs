//! A robot: links as meshes, joined to a tree.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use cloudtouch::SelfMesh;
use cloudtouch::geom::Pose;
use cloudtouch_io::ReadLimits;

use crate::at_fault;
use crate::error::{JointsError, RobotError, RobotFault, UnknownLink};
use crate::essential::essential;
use crate::joint::{Joint, JointKind};
use crate::link::{Shape, Sources};
use crate::nesting;
use crate::root::{self, Wanted};
use crate::srdf::disabled_pairs;
use crate::text;
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
    unchecked: Vec<String>,
    unknown: Vec<String>,
    /// Pairs of links that may touch, by their names in order.
    may_touch: BTreeSet<[String; 2]>,
}

/// A mesh this many times as large as the robot by its joints is in another unit.
const LARGEST_LINK: f64 = 20.0;
/// What a robot reaches at least, m: some have one link and no joint.
const LEAST_REACH: f64 = 0.5;
/// A mesh smaller than this is no link, m.
const SMALLEST_LINK: f64 = 1e-3;

impl Robot {
    /// Reads a URDF and the meshes it names: `.stl`, `.obj` and `.ply`, in metres times their `scale`.
    ///
    /// `packages` are names and folders for `package://`; those in folders around the URDF are found
    /// without.
    ///
    /// # Errors
    /// When a file is missing or malformed, a number is no number, links are no tree, or a mesh is of
    /// a size that cannot be meant; see [`RobotFault`].
    pub fn from_urdf(
        path: impl AsRef<Path>,
        packages: &[(String, PathBuf)],
    ) -> Result<Self, RobotError> {
        Self::from_urdf_within(path, packages, &ReadLimits::default())
    }

    /// As [`Self::from_urdf`], with other limits on the file and its meshes than the default ones.
    ///
    /// # Errors
    /// As [`Self::from_urdf`].
    pub fn from_urdf_within(
        path: impl AsRef<Path>,
        packages: &[(String, PathBuf)],
        limits: &ReadLimits,
    ) -> Result<Self, RobotError> {
        let path = path.as_ref();
        let folder = path.parent().unwrap_or(Path::new(""));
        let read =
            || Self::parse(&text::read(path, limits.bytes)?, Sources { folder, packages, limits });
        read().map_err(|fault| fault.of(path))
    }

    fn parse(text: &str, sources: Sources<'_>) -> Result<Self, RobotFault> {
        if text.trim().is_empty() {
            return Err(RobotFault::Empty);
        }
        nesting::check(text)?;
        root::check(text, Wanted::Urdf)?;
        let read = |text: &str| {
            urdf_rs::read_from_string(&essential(text)?)
                .map_err(|error| RobotFault::Xml { reason: error.to_string() })
        };
        let urdf =
            read(text).map_err(|fault| at_fault::named(fault, text, |alone| read(alone).err()))?;
        let tree = Tree::try_from_urdf(&urdf)?;
        let mut shapes = Vec::new();
        for (index, link) in urdf.links.iter().enumerate() {
            for collision in &link.collision {
                shapes.push(Shape::try_from_urdf((index, &link.name), collision, sources)?);
            }
        }
        if shapes.is_empty() {
            return Err(RobotFault::NoGeometry);
        }
        check_sizes(&tree, &shapes)?;
        let unchecked =
            urdf.links.iter().filter(|of| of.collision.is_empty() && !of.visual.is_empty());
        let unchecked = unchecked.map(|link| link.name.clone()).collect();
        let unknown = Vec::new();
        let mut robot = Self { tree, shapes, unchecked, unknown, may_touch: BTreeSet::new() };
        robot.allow_neighbors();
        Ok(robot)
    }

    /// Adds the pairs of links that an SRDF says not to check (`disable_collisions`). Links that
    /// the robot does not have are passed over, for many an SRDF is for several variants, and are named by
    /// [`Self::unknown_links`].
    ///
    /// # Errors
    /// When the file is missing or malformed.
    pub fn with_srdf(self, path: impl AsRef<Path>) -> Result<Self, RobotError> {
        self.with_srdf_within(path, &ReadLimits::default())
    }

    /// As [`Self::with_srdf`], with other limits on the file than the default ones.
    ///
    /// # Errors
    /// As [`Self::with_srdf`].
    pub fn with_srdf_within(
        mut self,
        path: impl AsRef<Path>,
        limits: &ReadLimits,
    ) -> Result<Self, RobotError> {
        let path = path.as_ref();
        let pairs = text::read(path, limits.bytes).and_then(|text| disabled_pairs(&text));
        for [a, b] in pairs.map_err(|fault| fault.of(path))? {
            for link in [&a, &b] {
                if !self.tree.links.contains(link) && !self.unknown.contains(link) {
                    self.unknown.push(link.clone());
                }
            }
            self.allow(a, b);
        }
        Ok(self)
    }

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
        self.may_touch.contains(&in_order(a.to_owned(), b.to_owned()))
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

    fn allow(&mut self, a: String, b: String) {
        self.may_touch.insert(in_order(a, b));
    }

    fn allow_neighbors(&mut self) {
        let solid: BTreeSet<usize> = self.shapes.iter().map(|shape| shape.link).collect();
        let groups = self.rigid_groups();
        for &link in &solid {
            let with_it =
                solid.iter().filter(|&&other| other < link && groups[other] == groups[link]);
            // The next with geometry on the way to the base: flanges between have none.
            let carriers = self.tree.chain(link).map(|joint| self.tree.joints[joint].parent);
            let next = carriers.into_iter().find(|carrier| solid.contains(carrier));
            for other in with_it.copied().chain(next).collect::<Vec<usize>>() {
                self.allow(self.tree.links[link].clone(), self.tree.links[other].clone());
            }
        }
    }

    /// For each link a link that it never moves against, the same for all of them.
    fn rigid_groups(&self) -> Vec<usize> {
        let mut groups: Vec<usize> = (0..self.tree.links.len()).collect();
        for joint in self.tree.joints.iter().filter(|joint| joint.kind == JointKind::Fixed) {
            groups[joint.child] = groups[joint.parent];
        }
        groups
    }
}

/// Meshes in millimetres, or scaled twice.
fn check_sizes(tree: &Tree, shapes: &[Shape]) -> Result<(), RobotFault> {
    let lengths = tree.joints.iter().map(|joint| joint.origin.translation().norm());
    // The sum of none is -0.
    let reach = lengths.fold(0.0, |sum, length| sum + length);
    for shape in shapes {
        let (Some(uri), size) = (&shape.uri, shape.size()) else { continue };
        if size > LARGEST_LINK * reach.max(LEAST_REACH) || size < SMALLEST_LINK {
            let (link, uri) = (tree.links[shape.link].clone(), uri.clone());
            return Err(RobotFault::LinkSize { link, uri, size, reach });
        }
    }
    Ok(())
}

fn in_order(a: String, b: String) -> [String; 2] {
    let mut pair = [a, b];
    pair.sort();
    pair
}
