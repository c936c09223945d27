//! A point cloud as read from a sensor or a file.

use crate::bounding_box::bounding_box;
use crate::covariance::Covariance;
use crate::pose::Pose;
use crate::vectors::{Point3, UnitVector3};

/// What some sensors write for "no return" is the largest float, 3.4e38; no scene is so large, m.
const PLACEHOLDER: f64 = 1e30;

/// Points in one frame, in file order, NaN rows included.
///
/// What the points mean (which sensor, how noisy) is not known here.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PointCloud {
    /// Positions, m. A row without a return is NaN in an organised cloud.
    pub points: Vec<Point3>,
    /// One covariance per point, when the file has them.
    pub covariances: Option<Vec<Covariance>>,
    /// One normal per point, of either sign, when the surface is known: the cloud was sampled
    /// from a model, for instance. They are believed, so leave out what was fitted to noisy points.
    /// [`unit`](crate::unit()) makes them of plain vectors.
    pub normals: Option<Vec<UnitVector3>>,
    /// Where the sensor was and which way it looked: from its frame (for a camera x right, y down,
    /// z forward) into that of the points. `None` where nobody said: then it counts as the identity, and
    /// nothing is concluded from where it was.
    pub sensor_pose: Option<Pose>,
    /// Width and height when the cloud is an image, row by row.
    pub image_size: Option<(usize, usize)>,
}

impl PointCloud {
    /// A cloud of points, of which nothing else is said.
    pub fn from_points(points: Vec<Point3>) -> Self {
        Self { points, ..Self::default() }
    }

    /// From the frame of the sensor into that of the points; the identity where nobody said.
    pub fn from_sensor(&self) -> Pose {
        self.sensor_pose.unwrap_or_else(Pose::identity)
    }

    /// Where the sensor was, in the frame of the points, m; the origin where nobody said.
    pub fn sensor_origin(&self) -> Point3 {
        Point3::from(self.from_sensor().translation())
    }

    /// How many rows there are, NaN ones included.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The rows named by `indices`, in that order; the image layout is lost.
    ///
    /// # Panics
    /// When an index is out of range.
    #[must_use]
    pub fn select(&self, indices: &[usize]) -> Self {
        Self {
            points: pick(&self.points, indices),
            covariances: self.covariances.as_ref().map(|all| pick(all, indices)),
            normals: self.normals.as_ref().map(|all| pick(all, indices)),
            sensor_pose: self.sensor_pose,
            image_size: None,
        }
    }

    /// Every `columns`-th column and `rows`-th row of an image, from the first on. Pixels stay as they were, and the
    /// result is an image still, which shows what the camera did not see. `None` if the cloud is no image.
    ///
    /// # Panics
    /// When one of the two numbers is 0.
    ///
    /// ```
    /// use cloudtouch_geom::{Point3, PointCloud};
    ///
    /// let pixels = (0..640 * 480).map(|i| Point3::new((i % 640) as f64, (i / 640) as f64, 500.0));
    /// let image = PointCloud { image_size: Some((640, 480)), ..PointCloud::from_points(pixels.collect()) };
    /// let fewer = image.every(3, 2).unwrap();
    /// assert_eq!(fewer.image_size, Some((214, 240)));
    /// assert_eq!(fewer.points[215], Point3::new(3.0, 2.0, 500.0));
    /// ```
    #[must_use]
    pub fn every(&self, columns: usize, rows: usize) -> Option<Self> {
        let (width, height) = self.image_size.filter(|_| self.is_image())?;
        let starts = (0..height).step_by(rows).map(|row| row * width);
        let pixels: Vec<usize> =
            starts.flat_map(|start| (start..start + width).step_by(columns)).collect();
        let image_size = Some((width.div_ceil(columns), height.div_ceil(rows)));
        Some(Self { image_size, ..self.select(&pixels) })
    }

    /// The same cloud in the frame that `pose` maps its own into: points, covariances, normals and
    /// where the sensor was. If `sensor_pose` is `None`, an image is taken to have been in its camera's frame; for any
    /// other cloud it stays `None`: set it to the identity first if the cloud is in its sensor's frame.
    #[must_use]
    pub fn transformed(&self, pose: &Pose) -> Self {
        let turned = |c: &Covariance| c.rotated(pose.rotation());
        let unit = |n: &UnitVector3| UnitVector3::new_normalize(pose.transform_vector(n));
        Self {
            points: self.points.iter().map(|p| pose.transform_point(p)).collect(),
            covariances: self.covariances.as_ref().map(|all| all.iter().map(turned).collect()),
            normals: self.normals.as_ref().map(|all| all.iter().map(unit).collect()),
            sensor_pose: match self.sensor_pose {
                Some(sensor) => Some(pose.after(&sensor)),
                None => self.is_image().then_some(*pose),
            },
            image_size: self.image_size,
        }
    }

    /// Whether its rows are those of an image: a depth image as its camera delivers it.
    pub fn is_image(&self) -> bool {
        self.image_size.is_some_and(|(width, height)| width > 1 && height > 1)
    }

    /// Whether a row stands for a return: NaN and infinity do not, nor what is farther than any scene is large, as
    /// the largest float that some sensors write for "none".
    #[inline]
    pub fn is_return(point: &Point3) -> bool {
        point.iter().all(|v| v.abs() < PLACEHOLDER)
    }

    /// Lowest and highest corner of the points that are returns; `None` when there is none.
    pub fn bounding_box(&self) -> Option<(Point3, Point3)> {
        bounding_box(self.points.iter().filter(|p| Self::is_return(p)))
    }
}

fn pick<T: Copy>(all: &[T], indices: &[usize]) -> Vec<T> {
    indices.iter().map(|&i| all[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vectors::Vector3;

    #[test]
    fn a_transformed_cloud_takes_its_sensor_along() {
        let pose = Pose::from_translation_rpy([1.0, 2.0, 3.0].into(), [0.3, 0.2, 0.1]);
        let cloud = PointCloud {
            covariances: Some(vec![Covariance::diagonal([4.0, 1.0, 1.0])]),
            normals: Some(vec![UnitVector3::new_normalize([1.0, 0.0, 0.0].into())]),
            image_size: Some((1, 1)),
            sensor_pose: Some(Pose::identity()),
            ..PointCloud::from_points(vec![Point3::new(0.5, 0.0, 0.0)])
        };
        let moved = cloud.transformed(&pose);
        let normal = moved.normals.as_ref().unwrap()[0];
        let ray = moved.points[0] - moved.sensor_origin();
        assert!((ray - 0.5 * normal.into_inner()).norm() < 1e-15);
        assert!((moved.covariances.as_ref().unwrap()[0].std_along(&normal) - 2.0).abs() < 1e-12);
        let back = moved.transformed(&pose.inverse());
        assert!((back.points[0] - cloud.points[0]).norm() < 1e-15);
        assert_eq!(back.image_size, cloud.image_size);
    }

    /// A cloud of who knows where became one whose sensor stood within it, and what it hides read free.
    #[test]
    fn only_of_an_image_it_goes_without_saying_where_the_sensor_was() {
        let pose = Pose::from_translation([1.0, 2.0, 3.0].into());
        let cloud = PointCloud::from_points(vec![Point3::origin(); 4]);
        assert_eq!(cloud.transformed(&pose).sensor_pose, None);
        let image = PointCloud { image_size: Some((2, 2)), ..cloud };
        assert_eq!(image.transformed(&pose).sensor_pose, Some(pose));
    }

    #[test]
    fn every_third_column_of_an_image_is_an_image_by_the_same_camera() {
        let place = |i: usize| Point3::new((i % 7) as f64, (i / 7) as f64, 1.0);
        let cloud = PointCloud {
            covariances: Some((0..35).map(|i| Covariance::isotropic(i as f64)).collect()),
            sensor_pose: Some(Pose::from_translation([1.0, 2.0, 3.0].into())),
            ..PointCloud::from_points((0..35).map(place).collect())
        };
        assert_eq!(cloud.every(1, 1), None);
        let image = PointCloud { image_size: Some((7, 5)), ..cloud };
        assert_eq!(image.every(1, 1).as_ref(), Some(&image));
        let fewer = image.every(3, 2).unwrap();
        let kept: Vec<f64> =
            fewer.covariances.iter().flatten().map(|c| c.variance_along(&Vector3::x())).collect();
        assert_eq!(kept, [0.0, 3.0, 6.0, 14.0, 17.0, 20.0, 28.0, 31.0, 34.0]);
        assert_eq!((fewer.image_size, fewer.sensor_pose), (Some((3, 3)), image.sensor_pose));
        // Of a single column no image is left.
        assert!(!image.every(7, 1).unwrap().is_image());
    }

    #[test]
    fn bounding_box_passes_over_missing_returns() {
        let cloud = PointCloud::from_points(vec![
            Point3::new(f64::NAN, 0.0, 0.0),
            Point3::new(1.0, 2.0, 3.0),
            Point3::new(-1.0, 5.0, 0.0),
        ]);
        let (low, high) = cloud.bounding_box().unwrap();
        assert_eq!((low, high), (Point3::new(-1.0, 2.0, 0.0), Point3::new(1.0, 5.0, 3.0)));
        assert!(PointCloud::default().bounding_box().is_none());
        // By a box of 3.4e38 m a cloud of centimetres was taken for a laser scan.
        let none = Point3::new(f64::from(f32::MAX), 0.0, 0.0);
        let with_none = PointCloud::from_points([&cloud.points[..], &[none]].concat());
        assert_eq!(with_none.bounding_box(), cloud.bounding_box());
    }
}
