//! What the cleaning pipeline is asked to do.

use cloudtouch_geom::message::number;
use cloudtouch_noise::{NoiseError, SensorModel};

use super::SelfMesh;

/// Which stages run, and how. The default drops missing returns and exact duplicates only.
#[derive(Debug, Clone)]
pub struct FilterSettings {
    /// Points nearer to the sensor than this are dropped, m; 0 keeps all.
    pub min_range: f64,
    /// Points farther from the sensor than this are dropped, m; infinity keeps all.
    pub max_range: f64,
    /// Whether a point with exactly the coordinates of an earlier one is dropped.
    pub drop_duplicates: bool,
    /// The robot's own links: points inside one of them, or within its padding, are dropped.
    pub robot: Vec<SelfMesh>,
    /// Drops points between a near and a far surface that no surface explains.
    pub veil: Option<VeilSettings>,
    /// Drops points that are unusually far from their neighbours.
    pub outliers: Option<OutlierSettings>,
    /// Replaces points by the centres of the occupied cells of a grid of this resolution, m.
    pub collision_map: Option<f64>,
}

impl Default for FilterSettings {
    fn default() -> Self {
        Self {
            min_range: 0.0,
            max_range: f64::INFINITY,
            drop_duplicates: true,
            robot: Vec::new(),
            veil: None,
            outliers: None,
            collision_map: None,
        }
    }
}

impl FilterSettings {
    /// The stages that suit a kind of sensor: cameras and laser scanners see nothing nearer than
    /// 10 cm (such returns are placeholders), and cameras draw veils at depth edges.
    pub fn for_sensor(sensor: &SensorModel) -> Self {
        let camera = matches!(sensor, SensorModel::Stereo { .. } | SensorModel::Kinect);
        let ranging = camera || matches!(sensor, SensorModel::Lidar { .. });
        Self {
            min_range: if ranging { 0.1 } else { 0.0 },
            veil: camera.then(VeilSettings::default),
            ..Self::default()
        }
    }

    pub(super) fn check(&self) -> Result<(), FilterError> {
        if !(self.min_range >= 0.0 && self.max_range > self.min_range) {
            return Err(FilterError::Range { min: self.min_range, max: self.max_range });
        }
        for link in &self.robot {
            if !(link.padding >= 0.0 && link.padding.is_finite()) {
                return Err(FilterError::Padding { value: link.padding });
            }
        }
        if let Some(VeilSettings { max_angle: value }) = self.veil
            && !(value > 0.0 && value < std::f64::consts::FRAC_PI_2)
        {
            return Err(FilterError::VeilAngle { value });
        }
        if let Some(OutlierSettings { neighbors, deviations }) = self.outliers
            && (neighbors == 0 || deviations.is_nan())
        {
            return Err(FilterError::Outliers { neighbors, deviations });
        }
        match self.collision_map {
            Some(value) if !(value > 0.0 && value.is_finite()) => {
                Err(FilterError::Resolution { value })
            }
            _ => Ok(()),
        }
    }
}

/// When a point counts as veil: see [`super::filter`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VeilSettings {
    /// A point is veil when it continues, within this angle (radians) of its viewing ray, towards
    /// a nearer neighbour on one side and a farther one on the other.
    pub max_angle: f64,
}

impl Default for VeilSettings {
    fn default() -> Self {
        // A surface tilted to within 10° of the ray returns little light to a camera.
        Self { max_angle: 10_f64.to_radians() }
    }
}

/// When a point counts as an outlier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutlierSettings {
    /// How many neighbours the mean distance is taken over.
    pub neighbors: usize,
    /// How many standard deviations above the mean of all points that distance may lie.
    pub deviations: f64,
}

impl Default for OutlierSettings {
    fn default() -> Self {
        Self { neighbors: 8, deviations: 3.0 }
    }
}

/// A setting of the pipeline that is out of range, or a cloud whose lists do not fit together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FilterError {
    /// The cloud does not have one of something for each point.
    #[error("{count} {what} for {points} points: give one for each, or none")]
    Count {
        /// Of what.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many points there are.
        points: usize,
    },
    /// The range limits are not 0 ≤ min < max.
    #[error("range limits {} m to {} m: need 0 <= min < max", number(*min), number(*max))]
    Range {
        /// Lower limit, m.
        min: f64,
        /// Upper limit, m.
        max: f64,
    },
    /// The padding of a robot link is negative or not finite.
    #[error("robot padding {} m: give a finite value of 0 or more", number(*value))]
    Padding {
        /// What was given, m.
        value: f64,
    },
    /// The veil angle is not between 0 and 90 degrees.
    #[error("veil angle {} rad: give one between 0 and pi/2", number(*value))]
    VeilAngle {
        /// What was given, rad.
        value: f64,
    },
    /// The outlier settings make no sense.
    #[error(
        "outliers by {neighbors} neighbours and {} deviations: need at least one neighbour and a number",
        number(*deviations)
    )]
    Outliers {
        /// Neighbours asked for.
        neighbors: usize,
        /// Deviations asked for.
        deviations: f64,
    },
    /// The cloud does not have as many points as its image has pixels.
    #[error(
        "the cloud has {points} points and an image of {width} x {height}: give one for each pixel, \
         NaN where there is no return"
    )]
    ImageSize {
        /// How many points.
        points: usize,
        /// Pixels in a row.
        width: usize,
        /// Rows of the image.
        height: usize,
    },
    /// The points do not fit into a collision map.
    #[error(transparent)]
    CollisionMap(#[from] NoiseError),
    /// The collision map resolution is not positive.
    #[error("collision map resolution {} m: give a positive value such as 0.01", number(*value))]
    Resolution {
        /// What was given, m.
        value: f64,
    },
}
