//! The position noise of every point of a cloud, stored once where it is the same for all.

use std::ops::Index;
use std::sync::Arc;

use cloudtouch_geom::Covariance;

/// One covariance Σᵢ for each point of a cloud, m², in its frame.
///
/// Noise that is the same everywhere takes no room per point; else each point has its own, in a list that copies
/// share.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorNoise(Form);

#[derive(Debug, Clone, PartialEq)]
enum Form {
    Uniform { covariance: Covariance, points: usize },
    Each(Arc<Vec<Covariance>>),
}

impl SensorNoise {
    /// The same noise for so many points.
    pub fn uniform(covariance: Covariance, points: usize) -> Self {
        Self(Form::Uniform { covariance, points })
    }

    /// How many points there are.
    pub fn len(&self) -> usize {
        match &self.0 {
            Form::Uniform { points, .. } => *points,
            Form::Each(all) => all.len(),
        }
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The noise of all points, where it is stored once.
    pub fn as_uniform(&self) -> Option<&Covariance> {
        match &self.0 {
            Form::Uniform { covariance, .. } => Some(covariance),
            Form::Each(_) => None,
        }
    }

    /// The noise of each point, in a list that others may hold too; `None` where it is stored once for all.
    pub fn shared(&self) -> Option<Arc<Vec<Covariance>>> {
        match &self.0 {
            Form::Uniform { .. } => None,
            Form::Each(all) => Some(all.clone()),
        }
    }

    /// The noise of every point in order.
    pub fn iter(&self) -> impl Iterator<Item = &Covariance> {
        (0..self.len()).map(|index| &self[index])
    }
}

impl From<Vec<Covariance>> for SensorNoise {
    fn from(all: Vec<Covariance>) -> Self {
        Self(Form::Each(Arc::new(all)))
    }
}

impl Index<usize> for SensorNoise {
    type Output = Covariance;

    /// # Panics
    /// When there is no such point.
    fn index(&self, index: usize) -> &Covariance {
        match &self.0 {
            Form::Uniform { covariance, points } => {
                assert!(index < *points, "point {index} of {points}");
                covariance
            }
            Form::Each(all) => &all[index],
        }
    }
}
