//! The neighbourhood of one point as the surface fit sees it.

use cloudtouch_geom::{Covariance, Matrix3, Vector3};

use crate::lanes::{Lanes, Machine, Stored, WIDTH};

/// The most neighbours a patch can hold.
pub(crate) const MOST_NEIGHBORS: usize = 60;
/// Groups of lanes that these and one more take.
pub(crate) const GROUPS: usize = MOST_NEIGHBORS / WIDTH + 1;

/// Vectors xⱼ − xᵢ to neighbours in order of distance, m: x, y and z in lanes of their own; zero
/// where there are no more.
#[derive(Debug, Clone)]
pub(crate) struct Offsets {
    groups: [[Stored; 3]; GROUPS],
    count: usize,
}

impl Default for Offsets {
    fn default() -> Self {
        Self { groups: [[[0.0; WIDTH]; 3]; GROUPS], count: 0 }
    }
}

impl Offsets {
    /// Takes others instead, as many as there is room for.
    pub(crate) fn set(&mut self, offsets: impl Iterator<Item = Vector3>) {
        let mut count = 0;
        for offset in offsets.take(GROUPS * WIDTH) {
            self.put(count, offset);
            count += 1;
        }
        self.count = count;
        for rest in count..count.next_multiple_of(WIDTH) {
            self.put(rest, Vector3::zeros());
        }
    }

    fn put(&mut self, index: usize, offset: Vector3) {
        for (lanes, value) in self.groups[index / WIDTH].iter_mut().zip(offset.iter()) {
            lanes[index % WIDTH] = *value;
        }
    }

    /// One of them.
    pub(crate) fn get(&self, index: usize) -> Vector3 {
        let [x, y, z] = self.groups[index / WIDTH];
        let lane = index % WIDTH;
        Vector3::new(x[lane], y[lane], z[lane])
    }

    pub(crate) fn len(&self) -> usize {
        self.count
    }
}

/// Covariances Σⱼ of neighbours, m²: the six entries xx, xy, xz, yy, yz, zz in lanes of their own.
#[derive(Debug, Default)]
pub(crate) struct NoiseLanes {
    groups: Vec<[Stored; 6]>,
}

impl NoiseLanes {
    /// Takes others instead.
    pub(crate) fn set<'a>(&mut self, noise: impl Iterator<Item = &'a Covariance>) {
        self.groups.clear();
        for (index, covariance) in noise.enumerate() {
            if index % WIDTH == 0 {
                // Lanes without a neighbour have a precision that a weight of zero makes zero.
                self.groups.push([[1.0; WIDTH]; 6]);
            }
            let group = &mut self.groups[index / WIDTH];
            for (lanes, entry) in group.iter_mut().zip(covariance.upper_triangle()) {
                lanes[index % WIDTH] = entry;
            }
        }
    }
}

/// Neighbours in order of distance, relative to the point they surround.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patch<'a> {
    offsets: &'a Offsets,
    /// How many of them count.
    count: usize,
    /// Σⱼ of each of them.
    noise: PatchNoise<'a>,
    /// Σᵢ of the point itself.
    own_noise: &'a Covariance,
    /// The least variance a residual is judged by, m².
    floor: f64,
    /// Makes the noise of the point the same in all directions, where it is not.
    whitening: Option<Matrix3>,
    /// The precision of all along all normals, where neither matters, 1/m².
    same: Option<f64>,
}

/// Σⱼ of each neighbour.
#[derive(Debug, Clone, Copy)]
pub(crate) enum PatchNoise<'a> {
    /// The same for all.
    Uniform(&'a Covariance),
    Each(&'a NoiseLanes),
}

/// The inverse variances of neighbours along a direction, 1/m².
pub(crate) enum Precisions<'a> {
    Same(f64),
    Each {
        noise: &'a NoiseLanes,
        along: Vector3,
        /// The least variance, m².
        floor: f64,
    },
}

impl Precisions<'_> {
    #[inline(always)]
    pub(crate) fn group<S: Machine>(&self, machine: S, group: usize) -> Lanes<S> {
        let (noise, n, floor) = match self {
            Self::Same(precision) => return Lanes::splat(machine, *precision),
            Self::Each { noise, along, floor } => (noise, along, *floor),
        };
        let [xx, xy, xz, yy, yz, zz] = noise.groups[group];
        let load = |entries| Lanes::load(machine, entries);
        let (xx, xy, xz, yy, yz, zz) = (load(xx), load(xy), load(xz), load(yy), load(yz), load(zz));
        let variance = (xx * n.x + (xy * n.y + xz * n.z) * 2.0) * n.x
            + (yy * n.y + yz * 2.0 * n.z) * n.y
            + zz * n.z * n.z;
        variance.at_least(floor).inverse()
    }
}

/// A plane n·y = height in coordinates relative to the point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane {
    /// Unit normal, of either sign.
    pub(crate) normal: Vector3,
    /// Height of the plane above the point along the normal, m.
    pub(crate) height: f64,
}

impl Plane {
    /// How far places are above it, m.
    #[inline(always)]
    pub(crate) fn residuals<S: Machine>(&self, machine: S, [x, y, z]: [Lanes<S>; 3]) -> Lanes<S> {
        let n = &self.normal;
        x * n.x + y * n.y + z * n.z - Lanes::splat(machine, self.height)
    }
}

/// Even a noise-free surface bends between its samples: residuals of this part of the spacing
/// are taken for nothing.
const FLOOR_PER_SPACING: f64 = 0.03;

impl<'a> Patch<'a> {
    /// Neighbours about a point whose local spacing is `spacing`, m.
    pub(crate) fn new(
        offsets: &'a Offsets,
        noise: PatchNoise<'a>,
        own_noise: &'a Covariance,
        spacing: f64,
    ) -> Self {
        let floor = (FLOOR_PER_SPACING * spacing).powi(2);
        let same = match noise {
            PatchNoise::Uniform(noise) => noise.isotropic_variance().map(|v| 1.0 / v.max(floor)),
            PatchNoise::Each(_) => None,
        };
        let whitening = match own_noise.isotropic_variance() {
            Some(_) => None,
            None => whitening(own_noise, floor),
        };
        Self { offsets, count: offsets.len(), noise, own_noise, floor, whitening, same }
    }

    /// The first `count` neighbours only, if there are as many.
    pub(crate) fn nearest(&self, count: usize) -> Self {
        Self { count: count.min(self.count), ..*self }
    }

    pub(crate) fn len(&self) -> usize {
        self.count
    }

    /// The vector to one of the neighbours, m.
    pub(crate) fn offset(&self, index: usize) -> Vector3 {
        self.offsets.get(index)
    }

    /// How many groups of lanes they take.
    #[inline(always)]
    pub(crate) fn groups(&self) -> usize {
        self.count.div_ceil(WIDTH)
    }

    /// The vectors to the neighbours of a group: x, y and z.
    #[inline(always)]
    pub(crate) fn group<S: Machine>(&self, machine: S, group: usize) -> [Lanes<S>; 3] {
        let [x, y, z] = self.offsets.groups[group];
        [Lanes::load(machine, x), Lanes::load(machine, y), Lanes::load(machine, z)]
    }

    /// Ones in the lanes of a group that hold a neighbour, zeros in the others.
    #[inline(always)]
    pub(crate) fn present<S: Machine>(&self, machine: S, group: usize) -> Lanes<S> {
        let left = (self.count - group * WIDTH).min(WIDTH);
        Lanes::load(machine, PRESENT[left - 1])
    }

    /// The inverse of the variances that residuals of the neighbours along a unit normal are judged
    /// by.
    #[inline(always)]
    pub(crate) fn precisions(&self, normal: &Vector3) -> Precisions<'a> {
        if let Some(precision) = self.same {
            return Precisions::Same(precision);
        }
        match self.noise {
            PatchNoise::Uniform(noise) => {
                Precisions::Same(1.0 / noise.variance_along(normal).max(self.floor))
            }
            PatchNoise::Each(noise) => {
                Precisions::Each { noise, along: *normal, floor: self.floor }
            }
        }
    }

    /// A matrix that makes the noise of the point the same in all directions; `None` where it is.
    pub(crate) fn whitening(&self) -> Option<&Matrix3> {
        self.whitening.as_ref()
    }

    /// Σᵢ of the point itself.
    pub(crate) fn own_noise(&self) -> &'a Covariance {
        self.own_noise
    }

    /// The least variance a residual is judged by, m².
    pub(crate) fn floor(&self) -> f64 {
        self.floor
    }

    /// The variance of the point itself along a unit normal, by the same measure.
    pub(crate) fn own_variance(&self, normal: &Vector3) -> f64 {
        let isotropic = self.own_noise.isotropic_variance();
        isotropic.unwrap_or_else(|| self.own_noise.variance_along(normal)).max(self.floor)
    }

    /// How surely residuals would show the noise along a unit normal, from 0 to 1: not where it is no more than those that
    /// are taken for nothing.
    pub(crate) fn shows_noise(&self, normal: &Vector3) -> f64 {
        let noise = self.own_noise.variance_along(normal);
        if noise > self.floor { (noise / self.floor - 1.0).min(1.0) } else { 0.0 }
    }

    /// An upper bound of [`Self::own_variance`] over all normals.
    pub(crate) fn largest_own_variance(&self) -> f64 {
        self.own_noise.std_bound().powi(2).max(self.floor)
    }

    /// [`Self::own_variance`] where it is the same along all normals.
    pub(crate) fn isotropic_own_variance(&self) -> Option<f64> {
        self.own_noise.isotropic_variance().map(|variance| variance.max(self.floor))
    }
}

/// L⁻¹, L Lᵀ being a covariance and no less than the `floor` in all directions, m².
fn whitening(noise: &Covariance, floor: f64) -> Option<Matrix3> {
    let noise = noise.matrix() + Matrix3::from_diagonal_element(floor);
    noise.cholesky()?.l().try_inverse()
}

/// By how many lanes of a group hold a neighbour, less one.
const PRESENT: [[f64; WIDTH]; WIDTH] =
    [[1.0, 0.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0], [1.0, 1.0, 1.0, 0.0], [1.0; WIDTH]];
