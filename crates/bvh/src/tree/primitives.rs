//! The primitives of a tree by their indices, in as little memory as they need.

use std::slice;
use std::sync::Arc;

use cloudtouch_geom::{Covariance, Point3, UncertainPoint};

use crate::tree::primitive::{check_coordinates, check_covariance};
use crate::{Primitive, TreeError};

/// Primitives by index, in the frame of a tree.
#[derive(Debug, Clone)]
pub enum Primitives {
    /// Points of weight 1 that are known equally well: a tree of them holds nothing but where they are,
    /// in a list that others may hold too.
    Alike {
        /// Where the points are expected, m.
        means: Arc<Vec<Point3>>,
        /// How far any of them may be from there, m².
        covariance: Covariance,
    },
    /// Points of weight 1 that have a covariance each, in lists as long as one another that others may hold
    /// too.
    Points {
        /// Where the points are expected, m.
        means: Arc<Vec<Point3>>,
        /// How far each may be from there, m².
        covariances: Arc<Vec<Covariance>>,
    },
    /// Each with what it has of its own.
    Each(Vec<Primitive>),
}

impl Primitives {
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Alike { means, .. } | Self::Points { means, .. } => means.len(),
            Self::Each(all) => all.len(),
        }
    }

    /// All of them, in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = Primitive> {
        (0..self.len() as u32).map(|index| self.get(index))
    }

    /// Refuses values that no box could hold.
    pub(crate) fn check(&self) -> Result<(), TreeError> {
        match self {
            Self::Alike { means, .. } => {
                if !means.is_empty() {
                    self.get(0).check(0)?;
                }
                means
                    .iter()
                    .enumerate()
                    .try_for_each(|(index, mean)| check_coordinates(slice::from_ref(mean), index))
            }
            Self::Points { means, covariances } => {
                if means.len() != covariances.len() {
                    let (expected, found) = (means.len(), covariances.len());
                    return Err(TreeError::Count { expected, found });
                }
                means.iter().zip(covariances.iter()).enumerate().try_for_each(
                    |(index, (mean, noise))| {
                        check_coordinates(slice::from_ref(mean), index)?;
                        check_covariance(noise, index)
                    },
                )
            }
            Self::Each(all) => {
                all.iter().enumerate().try_for_each(|(index, primitive)| primitive.check(index))
            }
        }
    }

    pub(crate) fn get(&self, index: u32) -> Primitive {
        match self {
            Self::Alike { means, covariance } => Primitive::point(UncertainPoint {
                mean: means[index as usize],
                covariance: *covariance,
            }),
            Self::Points { means, covariances } => Primitive::point(UncertainPoint {
                mean: means[index as usize],
                covariance: covariances[index as usize],
            }),
            Self::Each(all) => all[index as usize],
        }
    }

    /// See [`Primitive::corners`].
    pub(crate) fn corners(&self, index: u32) -> &[Point3] {
        match self {
            Self::Alike { means, .. } | Self::Points { means, .. } => {
                slice::from_ref(&means[index as usize])
            }
            Self::Each(all) => all[index as usize].corners(),
        }
    }

    /// See [`Primitive::covariance`].
    pub(crate) fn covariance(&self, index: u32) -> Option<&Covariance> {
        match self {
            Self::Alike { covariance, .. } => Some(covariance),
            Self::Points { covariances, .. } => Some(&covariances[index as usize]),
            Self::Each(all) => all[index as usize].covariance(),
        }
    }

    /// Whether it is a point.
    pub(crate) fn is_point(&self, index: u32) -> bool {
        match self {
            Self::Alike { .. } | Self::Points { .. } => true,
            Self::Each(all) => matches!(all[index as usize], Primitive::Point { .. }),
        }
    }

    pub(crate) fn set(&mut self, index: u32, primitive: Primitive) {
        self.make_room_for(&primitive);
        match self {
            Self::Alike { means, .. } => {
                Arc::make_mut(means)[index as usize] = primitive.centroid()
            }
            Self::Points { means, covariances } => {
                Arc::make_mut(means)[index as usize] = primitive.centroid();
                Arc::make_mut(covariances)[index as usize] = covariance_of(&primitive);
            }
            Self::Each(all) => all[index as usize] = primitive,
        }
    }

    pub(crate) fn push(&mut self, primitive: Primitive) {
        self.make_room_for(&primitive);
        match self {
            Self::Alike { means, .. } => Arc::make_mut(means).push(primitive.centroid()),
            Self::Points { means, covariances } => {
                Arc::make_mut(means).push(primitive.centroid());
                Arc::make_mut(covariances).push(covariance_of(&primitive));
            }
            Self::Each(all) => all.push(primitive),
        }
    }

    /// Those that had these indices before, in order, and something or other for those without one.
    pub(crate) fn renumber(&mut self, before: &[Option<u32>]) {
        let index = |before: &Option<u32>| before.map_or(0, |index| index as usize);
        match self {
            Self::Alike { means, .. } => {
                *means = Arc::new(before.iter().map(|before| means[index(before)]).collect());
            }
            Self::Points { means, covariances } => {
                *means = Arc::new(before.iter().map(|before| means[index(before)]).collect());
                *covariances =
                    Arc::new(before.iter().map(|before| covariances[index(before)]).collect());
            }
            Self::Each(all) => *all = before.iter().map(|before| all[index(before)]).collect(),
        }
    }

    /// Lists each by itself, should this one differ from the others by more than its place.
    fn make_room_for(&mut self, primitive: &Primitive) {
        let is_like_all = match (&*self, primitive) {
            (Self::Each(_), _) => true,
            (Self::Alike { covariance, .. }, Primitive::Point { point, weight }) => {
                let own = point.covariance.isotropic_variance();
                *weight == 1.0 && own.is_some() && own == covariance.isotropic_variance()
            }
            (Self::Points { .. }, Primitive::Point { weight, .. }) => *weight == 1.0,
            (_, Primitive::Triangle(_)) => false,
        };
        if !is_like_all {
            *self = Self::Each(self.iter().collect());
        }
    }
}

/// That of a point.
fn covariance_of(primitive: &Primitive) -> Covariance {
    primitive.covariance().copied().unwrap_or(Covariance::zero())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64) -> Primitive {
        let covariance = Covariance::isotropic(0.5);
        Primitive::point(UncertainPoint { mean: Point3::new(x, 0.0, 0.0), covariance })
    }

    /// Whatever is done to them, they are what a plain list of them would be.
    #[test]
    fn points_that_are_alike_read_as_if_each_were_listed() {
        let means = Arc::new(vec![Point3::origin(), Point3::new(1.0, 0.0, 0.0)]);
        let kept = means.clone();
        let covariances = Arc::new(vec![Covariance::isotropic(0.5); 2]);
        let mut points = Primitives::Points { means: means.clone(), covariances };
        let mut all = Primitives::Alike { means, covariance: Covariance::isotropic(0.5) };
        let mut listed = Primitives::Each(vec![at(0.0), at(1.0)]);
        let other = Primitive::Triangle([Point3::origin(); 3]);
        let heavy = Primitive::Point {
            point: UncertainPoint::exact(Point3::new(9.0, 0.0, 0.0)),
            weight: 2.0,
        };
        for step in 0..6 {
            for primitives in [&mut all, &mut points, &mut listed] {
                match step {
                    0 => primitives.push(at(5.0)),
                    1 => primitives.set(0, at(7.0)),
                    2 => primitives.renumber(&[Some(2), Some(0), Some(1)]),
                    3 => primitives.set(1, heavy),
                    4 => primitives.push(other),
                    _ => primitives.renumber(&[Some(3), Some(1)]),
                }
            }
            assert_eq!(matches!(all, Primitives::Alike { .. }), step < 3);
            assert_eq!(matches!(points, Primitives::Points { .. }), step < 3);
            for primitives in [&all, &points] {
                assert!(primitives.iter().eq(listed.iter()), "{step}");
                for index in 0..primitives.len() as u32 {
                    let own = primitives.get(index);
                    assert_eq!(primitives.corners(index), own.corners());
                    assert_eq!(primitives.covariance(index), own.covariance());
                    assert_eq!(primitives.is_point(index), own.covariance().is_some());
                }
            }
        }
        assert_eq!(*kept, [Point3::origin(), Point3::new(1.0, 0.0, 0.0)]);
    }
}
