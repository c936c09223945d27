//! A body as both paths see it: what does not depend on how its points are understood.

use std::time::Duration;

use cloudtouch_bvh::Tree;
use cloudtouch_geom::{Point3, Pose, Vector3};

use crate::cloud::Prepared;
use crate::mesh::Mesh;
use crate::some::some_of;

/// Places that stand for the whole surface, at most, ...
const SAMPLES: usize = 500;
/// ... and where small parts of it matter.
const DENSE_SAMPLES: usize = 2000;

/// The diagonals of the boxes of one body, however it is turned, are within this factor (√3, and some).
pub(crate) const TURNED: f64 = 1.8;

/// A prepared cloud of either path, or a mesh.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Shape<'a> {
    /// A noisy cloud.
    Cloud(&'a Prepared),
    /// An exact mesh.
    Mesh(&'a Mesh),
}

impl<'a> Shape<'a> {
    pub(crate) fn prepare_time(&self) -> Duration {
        match self {
            Self::Cloud(cloud) => cloud.prepare_time(),
            Self::Mesh(mesh) => mesh.prepare_time(),
        }
    }

    /// How many points stand for the body: those of a cloud, the corners of a mesh.
    pub(crate) fn point_count(&self) -> usize {
        match self {
            Self::Cloud(cloud) => cloud.len(),
            Self::Mesh(mesh) => 3 * mesh.triangle_count(),
        }
    }

    /// Distance between neighbouring samples, m; a mesh is known everywhere.
    pub(crate) fn spacing(&self) -> f64 {
        match self {
            Self::Cloud(cloud) => cloud.makeup().spacing,
            Self::Mesh(_) => 0.0,
        }
    }

    /// Diagonal of the box around the body, m.
    pub(crate) fn size(&self) -> f64 {
        let [low, high] = self.corners();
        (high - low).norm()
    }

    /// The same but for a few strays of a cloud that are far from all else.
    pub(crate) fn core_size(&self) -> f64 {
        match self {
            Self::Cloud(cloud) => cloud.makeup().core,
            Self::Mesh(_) => self.size(),
        }
    }

    /// Of the ball about the middle of its samples that holds them, if that is smaller: the same however the file is
    /// turned, which the box is not.
    pub(crate) fn breadth(&self) -> f64 {
        let samples = self.samples();
        let sum = samples.iter().map(|sample| sample.coords).sum::<Vector3>();
        let middle = Point3::from(sum / samples.len().max(1) as f64);
        let farthest = samples.iter().map(|sample| (sample - middle).norm()).fold(0.0, f64::max);
        self.size().min(2.0 * farthest)
    }

    /// Lowest and highest corner of the body along the axes of its local frame, m.
    pub(crate) fn corners(&self) -> [Point3; 2] {
        match self {
            Self::Cloud(cloud) => cloud.makeup().corners,
            Self::Mesh(mesh) => mesh.corners_of_box(),
        }
    }

    /// The middle of that box.
    pub(crate) fn middle(&self) -> Point3 {
        let [low, high] = self.corners();
        nalgebra::center(&low, &high)
    }

    /// At most some hundred places that stand for the whole surface, in the local frame, m.
    pub(crate) fn samples(&self) -> Vec<Point3> {
        self.spread(SAMPLES).collect()
    }

    /// At most some thousand of them.
    pub(crate) fn dense_samples(&self) -> impl Iterator<Item = Point3> + 'a {
        self.spread(DENSE_SAMPLES)
    }

    fn spread(&self, most: usize) -> impl Iterator<Item = Point3> + 'a {
        let places = match self {
            Self::Cloud(cloud) => cloud.points(),
            Self::Mesh(mesh) => mesh.samples(),
        };
        some_of(places.len(), most).map(|index| places[index])
    }

    pub(crate) fn origin(&self) -> Vector3 {
        match self {
            Self::Cloud(cloud) => cloud.origin(),
            Self::Mesh(mesh) => mesh.origin(),
        }
    }

    pub(crate) fn tree(&self) -> &'a Tree {
        match self {
            Self::Cloud(cloud) => cloud.tree(),
            Self::Mesh(mesh) => mesh.tree(),
        }
    }

    /// Maps the local frame of `other` into the local frame of `self`, given how their file
    /// frames relate. Large offsets cancel here, once, in double precision.
    pub(crate) fn local_from(&self, other: &Self, self_from_other: &Pose) -> Pose {
        Pose::from_translation(-self.origin())
            .after(self_from_other)
            .after(&Pose::from_translation(other.origin()))
    }
}
