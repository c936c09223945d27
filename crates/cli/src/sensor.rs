//! Which sensor a cloud is taken to be from: one that is stated, or the one its layout suggests.

use std::fmt;
use std::str::FromStr;

use cloudtouch::geom::{PointCloud, Vector3};
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

const LASER: SensorModel = SensorModel::Lidar { range_std: 0.02, beam_rad: 0.003 };

/// Whether a sensor at its stated place looked around itself, as no camera does. A laser scanner turns in
/// equal steps, so that its rays cancel; those to a cloud in another frame hardly do.
fn is_all_around(cloud: &PointCloud) -> bool {
    const MOST: f64 = 0.25;
    let origin = cloud.sensor_origin();
    let returns = cloud.points.iter().filter(|point| PointCloud::is_return(point));
    let rays = returns.filter_map(|point| (point - origin).try_normalize(0.0));
    let (sum, count) =
        rays.fold((Vector3::zeros(), 0_u32), |(sum, count), ray| (sum + ray, count + 1));
    sum.norm() < MOST * f64::from(count)
}

/// A file does not say which sensor made it: this is a guess from its layout and extent.
pub fn suggestion(cloud: &PointCloud) -> Chosen {
    let far_from_origin = cloud
        .bounding_box()
        .is_some_and(|(low, high)| low.coords.amax().min(high.coords.amax()) > 1e4);
    let (sensor, because) = if cloud.covariances.is_some() {
        (SensorModel::PerPoint, "the file has covariance columns")
    } else if far_from_origin {
        (SensorModel::Axes { stds: [0.3, 0.3, 0.15] }, "map coordinates, as of an airborne scan")
    } else if cloud.is_image() && !is_all_around(cloud) {
        (SensorModel::Kinect, "a depth image; a stereo camera is noisier: iso:0.005")
    } else if cloud.is_image() {
        (LASER, "rows and columns all around the sensor, as of a laser scanner")
    } else if extent(cloud) > 4.0 {
        (LASER, "metres across, as a laser scan")
    } else {
        (SensorModel::Isotropic { std: 0.005 }, "nothing in the file tells")
    };
    Chosen { sensor, because: Some(because) }
}

/// The longest side of a box around all returns but a hundredth at either end of each axis, m: a few strays are no laser scan.
fn extent(cloud: &PointCloud) -> f64 {
    const ONE_STRAY_OF: usize = 100;
    let side = |axis: usize| {
        let returns = cloud.points.iter().filter(|point| PointCloud::is_return(point));
        let mut places: Vec<f64> = returns.map(|point| point[axis]).collect();
        if places.is_empty() {
            return 0.0;
        }
        let strays = places.len() / ONE_STRAY_OF;
        let last = places.len() - 1 - strays;
        let mut at = |rank: usize| *places.select_nth_unstable_by(rank, f64::total_cmp).1;
        at(last) - at(strays)
    };
    [0, 1, 2].map(side).into_iter().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use cloudtouch::geom::Point3;

    use super::*;

    /// Sixteen rings of a full turn, 2 m away, and as many of a sixth of a turn.
    #[test]
    fn a_scan_all_around_with_rows_and_columns_was_taken_for_a_depth_image() {
        let scan = |turn: f64, sensor: [f64; 3]| {
            let at = |i: u32| {
                let (across, up) =
                    (turn * f64::from(i % 90) / 90.0, 0.04 * f64::from(i / 90) - 0.3);
                let far = if i == 7 { f64::NAN } else { 2.0 };
                Point3::new(far * across.cos(), far * across.sin(), far * up)
                    - Vector3::from(sensor)
            };
            let points = (0..16 * 90).map(at).collect();
            PointCloud { image_size: Some((90, 16)), ..PointCloud::from_points(points) }
        };
        let full = std::f64::consts::TAU;
        assert_eq!(suggestion(&scan(full, [0.0; 3])).sensor, LASER);
        assert_eq!(suggestion(&scan(full / 6.0, [0.0; 3])).sensor, SensorModel::Kinect);
        // In another frame nobody knows: a camera, whose place is then asked for.
        assert_eq!(suggestion(&scan(full, [0.0, 0.0, 3.0])).sensor, SensorModel::Kinect);
    }

    /// One point 10 m off made a table top a laser scan.
    #[test]
    fn a_few_strays_were_taken_for_the_extent() {
        let table = |strays: usize| {
            let at = |i: usize| Point3::new(0.01 * (i % 60) as f64, 0.01 * (i / 60) as f64, 0.8);
            let far = (0..strays).map(|i| Point3::new(0.0, i as f64, 10.0));
            PointCloud::from_points((0..3600).map(at).chain(far).collect())
        };
        let small = SensorModel::Isotropic { std: 0.005 };
        assert_eq!([0, 1, 20].map(|strays| suggestion(&table(strays)).sensor), [small; 3]);
        assert_eq!(suggestion(&table(400)).sensor, LASER);
        assert_eq!(suggestion(&PointCloud::from_points(Vec::new())).sensor, small);
    }
}
