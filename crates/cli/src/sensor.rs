//! Which sensor a cloud is taken to be from: one that is stated, or the one its layout suggests.

use std::fmt;
use std::str::FromStr;

use cloudtouch::geom::PointCloud;
use cloudtouch::noise::{NoiseError, SensorModel};

/// A sensor as an option states it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SensorChoice {
    /// What the layout and the extent of the cloud suggest.
    Auto,
    /// This one.
    Stated(SensorModel),
}

/// A sensor, and why it was chosen where nobody stated it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chosen {
    /// How noisy the points are.
    pub sensor: SensorModel,
    /// Why, in words; `None` where it was stated.
    pub because: Option<&'static str>,
}

impl SensorChoice {
    /// The sensor stated, or what this cloud suggests.
    pub fn of(self, cloud: &PointCloud) -> Chosen {
        match self {
            Self::Stated(sensor) => Chosen { sensor, because: None },
            Self::Auto => suggestion(cloud),
        }
    }
}

impl FromStr for SensorChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        if text.trim() == "auto" {
            return Ok(Self::Auto);
        }
        let sensor = text.parse::<SensorModel>();
        sensor.map(Self::Stated).map_err(|error| match error {
            NoiseError::UnknownSensor { .. } => {
                let small = text.trim().to_lowercase();
                let is_known = small == "auto" || small.parse::<SensorModel>().is_ok();
                let hint = if is_known {
                    format!("; write `{small}`")
                } else {
                    ", or auto for what the cloud suggests; a stereo camera such as a RealSense is \
                     stereo with the numbers of its data sheet"
                        .to_owned()
                };
                format!("{error}{hint}")
            }
            _ => error.to_string(),
        })
    }
}

impl fmt::Display for SensorChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Auto => f.write_str("auto"),
            Self::Stated(sensor) => sensor.fmt(f),
        }
    }
}

/// A file does not say which sensor made it: this is a guess from its layout and extent.
pub fn suggestion(cloud: &PointCloud) -> Chosen {
    let (far_from_origin, extent) = match cloud.bounding_box() {
        Some((low, high)) => (low.coords.amax().min(high.coords.amax()) > 1e4, (high - low).amax()),
        None => (false, 0.0),
    };
    let (sensor, because) = if cloud.covariances.is_some() {
        (SensorModel::PerPoint, "the file has covariance columns")
    } else if far_from_origin {
        (SensorModel::Axes { stds: [0.3, 0.3, 0.15] }, "map coordinates, as of an airborne scan")
    } else if cloud.is_image() {
        (SensorModel::Kinect, "a depth image; a stereo camera is noisier: iso:0.005")
    } else if extent > 4.0 {
        (SensorModel::Lidar { range_std: 0.02, beam_rad: 0.003 }, "metres across, as a laser scan")
    } else {
        (SensorModel::Isotropic { std: 0.005 }, "nothing in the file tells")
    };
    Chosen { sensor, because: Some(because) }
}
