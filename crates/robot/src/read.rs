//! Reads a robot from its URDF, and which links of it may touch from an SRDF.

use std::path::{Path, PathBuf};

use cloudtouch_io::ReadLimits;

use crate::at_fault;
use crate::error::{RobotError, RobotFault};
use crate::essential::essential;
use crate::link::{Shape, Sources};
use crate::may_touch::MayTouch;
use crate::nesting;
use crate::robot::Robot;
use crate::root::{self, Wanted};
use crate::srdf::disabled_pairs;
use crate::text;
use crate::tree::Tree;

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
            urdf_rs::read_from_string(&essential(text)?).map_err(|error| {
                let reason = error.to_string();
                // So the parser calls what it did not expect.
                RobotFault::Xml { reason: reason.trim_start_matches("custom: ").to_owned() }
            })
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
        let may_touch = MayTouch::of_neighbors(&tree, &shapes);
        Ok(Self { tree, shapes, unchecked, unknown, may_touch })
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
            self.may_touch.add(a, b);
        }
        Ok(self)
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
