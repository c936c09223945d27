//! What the cleaning pipeline is asked to do.

use cloudtouch_noise::SensorModel;

use crate::error::FilterError;

use super::SelfMesh;

/// Which stages run, and how. The default drops missing returns and exact duplicates only.
#[derive(Debug, Clone)]
pub struct FilterSettings {
    /// Points nearer to the sensor than this are dropped, m; 0 keeps all. `None` drops what no camera or
    /// laser scanner sees, where it is known that they are so near: within 10 cm of the sensor of a cloud
    /// with the rows and columns of an image; else only what is at the very place (some
    /// drivers write missing returns so), for in the frame of a map the origin is a place like others.
    pub min_range: Option<f64>,
    /// Points farther from the sensor than this are dropped, m; infinity keeps all.
    pub max_range: f64,
    /// Whether of points with exactly the same coordinates one alone is kept: the first, and of those that bring their
    /// noise the least certain. Of a cloud without the rows and columns of an image of which a tenth or more is nearer
    /// to another point than a two-hundredth of the spacing, as in a scan that was put together with itself after
    /// rounding, [`Cloud::prepare`](crate::Cloud::prepare) keeps the first of these too.
    pub drop_duplicates: bool,
    /// The robot's own links: points inside one of them, or within its padding, are dropped, and these places count as
    /// seen to be empty. So they should stand on nothing and lean on nothing; points of what they hold and grasped
    /// from a table are rather taken out by [`Cloud::remove`](crate::Cloud::remove).
    pub robot: Vec<SelfMesh>,
    /// Drops points between a near and a far surface that no surface explains, of clouds with the rows and columns of
    /// an image.
    pub veil: Option<VeilSettings>,
    /// Drops points that are unusually far from their neighbours. In an image nothing counts as seen past them.
    pub outliers: Option<OutlierSettings>,
    /// Replaces points by the centres of the occupied cells of a grid of this resolution, m. Their noise is that of
    /// [`SensorModel::Grid`]: state it, else cells count as known as well as returns. What was seen to be empty is still
    /// told by the returns.
    pub collision_map: Option<f64>,
}

impl Default for FilterSettings {
    fn default() -> Self {
        Self {
            min_range: Some(0.0),
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
    /// The stages that suit a kind of sensor: of cameras and laser scanners what they cannot have seen so
    /// near is dropped (see [`Self::min_range`]), and cameras draw veils at depth edges.
    pub fn for_sensor(sensor: &SensorModel) -> Self {
        let camera = sensor.is_camera();
        let ranging = camera || matches!(sensor, SensorModel::Lidar { .. });
        Self {
            min_range: if ranging { None } else { Some(0.0) },
            veil: camera.then(VeilSettings::default),
            ..Self::default()
        }
    }

    /// Checks every field.
    ///
    /// # Errors
    /// Names the setting that is out of range, and its value.
    pub fn validate(&self) -> Result<(), FilterError> {
        let min = self.min_range.unwrap_or(0.0);
        if !(min >= 0.0 && self.max_range > min) {
            return Err(FilterError::Range { min, max: self.max_range });
        }
        for link in &self.robot {
            if !(link.padding >= 0.0 && link.padding.is_finite()) {
                return Err(FilterError::Padding { value: link.padding });
            }
            if let Some(value) = link.cloud_from_link.non_finite_entry() {
                return Err(FilterError::LinkPose { value });
            }
        }
        if let Some(VeilSettings { max_angle: value }) = self.veil
            && !(value > 0.0 && value < std::f64::consts::FRAC_PI_2)
        {
            return Err(FilterError::VeilAngle { value });
        }
        if let Some(OutlierSettings { neighbors, deviations }) = self.outliers
            && (neighbors == 0 || deviations.is_nan() || deviations <= 0.0)
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
    /// a nearer neighbour on one side and a farther one on the other, and no surface goes on so.
    pub max_angle: f64,
}

impl Default for VeilSettings {
    fn default() -> Self {
        // Few surfaces are as steep, and those go on.
        Self { max_angle: 10_f64.to_radians() }
    }
}

/// When a point counts as an outlier.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutlierSettings {
    /// How many neighbours the mean distance is taken over.
    pub neighbors: usize,
    /// How many standard deviations above the mean of all points that distance may lie, above 0.
    pub deviations: f64,
}

impl Default for OutlierSettings {
    fn default() -> Self {
        Self { neighbors: 8, deviations: 3.0 }
    }
}
