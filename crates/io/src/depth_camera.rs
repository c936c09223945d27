//! What turns the pixels of a depth image into places: the intrinsics of its camera and its step of depth.

use cloudtouch_geom::{
    Point3,
    message::{number, rounded},
};

/// The intrinsics of a pinhole camera and what its depth images count in.
///
/// Pixels are counted from 0 and named by their middles, as OpenCV and ROS do: the pixel in the column `cx`
/// and the row `cy` looks along the axis. Lens distortion is not modelled: images are rectified first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthCamera {
    /// Focal length along the rows, pixels, above 0.
    pub fx: f64,
    /// Focal length along the columns, pixels, above 0.
    pub fy: f64,
    /// Column of the principal point, pixels.
    pub cx: f64,
    /// Row of the principal point, pixels.
    pub cy: f64,
    /// A step of depth, m, above 0 and at most 0.1; 0.001 as a rule.
    pub depth_scale: f64,
    /// Columns and rows of the image that the intrinsics are of, where that is known.
    pub image_size: Option<(usize, usize)>,
}

/// What is wrong with a camera, by itself or for an image.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// A focal length is not finite and above 0.
    #[error("{name} is {}: a focal length is finite and above 0, pixels", number(*value))]
    FocalLength {
        /// `fx` or `fy`.
        name: &'static str,
        /// What was found.
        value: f64,
    },
    /// The principal point is nowhere.
    #[error("{name} is {}: the principal point is finite, pixels", number(*value))]
    PrincipalPoint {
        /// `cx` or `cy`.
        name: &'static str,
        /// What was found.
        value: f64,
    },
    /// A step of depth that no camera has.
    #[error(
        "a step of depth is {} m: give metres above 0 and at most 0.1, such as 0.001 for millimetres or \
         0.0002 for 5000 steps a metre",
        number(*value)
    )]
    DepthScale {
        /// What was found.
        value: f64,
    },
    /// The intrinsics are those of an image of another size.
    #[error(
        "the image has {} x {} pixels, and the intrinsics are of {} x {}: give those of this image; scaled \
         to half the size each of them is half",
        found.0, found.1, stated.0, stated.1
    )]
    ImageSize {
        /// Columns and rows of the image.
        found: (usize, usize),
        /// Columns and rows that the intrinsics are of.
        stated: (usize, usize),
    },
    /// The principal point lies by half of the image or more beside it, or at its last corner, where that of an image
    /// twice as large is.
    #[error(
        "{name} is {}, and the image has {pixels} {along}: a camera looks into its image, so give the \
         intrinsics of this image, not of another size or of a colour camera",
        number(*value)
    )]
    LooksAside {
        /// `cx` or `cy`.
        name: &'static str,
        /// What was found.
        value: f64,
        /// How many there are.
        pixels: usize,
        /// `columns` or `rows`.
        along: &'static str,
    },
    /// The view is wide, and the principal point a quarter of the way through it, as with the intrinsics of an image half
    /// as large.
    #[error(
        "cx is {} and cy {}, a quarter of an image of {} x {} pixels: so they are of one half as large; give \
         those of this image, each of them twice as large. Of a part of a larger image give one that begins elsewhere",
        number(point.0), number(point.1), size.0, size.1
    )]
    OfHalf {
        /// `cx` and `cy`.
        point: (f64, f64),
        /// Columns and rows of the image.
        size: (usize, usize),
    },
    /// The focal length makes a view that no pinhole camera has.
    #[error(
        "{name} is {}, and the image has {pixels} {along}, a view of {} degrees: give it in pixels, \
         neither as a share of the image nor in millimetres",
        number(*value), rounded(view_deg(*value, *pixels))
    )]
    View {
        /// `fx` or `fy`.
        name: &'static str,
        /// What was found.
        value: f64,
        /// How many there are.
        pixels: usize,
        /// `columns` or `rows`.
        along: &'static str,
    },
}

/// Beside the image by so many of its sizes the principal point is that of another.
const MOST_ASIDE: f64 = 0.5;
/// Where it is so many sizes along both sides, the intrinsics are of an image twice as large.
const CORNER: f64 = 0.9;
/// Where it is at so many sizes along both sides, they are of an image half as large, ...
const QUARTER: std::ops::RangeInclusive<f64> = 0.235..=0.265;
/// ... if the focal length is at most so many of the longer, a view of 71 degrees: parts of an image are seen at narrower
/// angles.
const WIDE: f64 = 0.7;
/// Focal lengths in sizes of the image: a view of 161 degrees, where a lens bends what it sees, and one of
/// a twentieth of a degree.
const FOCAL_LENGTHS: std::ops::Range<f64> = 1.0 / 12.0..1000.0;
/// Steps of depth, m: of 65,534 even the largest image is full at kilometres.
const LARGEST_STEP: f64 = 0.1;

/// How wide pixels in a row are seen, degrees.
fn view_deg(focal_length: f64, pixels: usize) -> f64 {
    2.0 * (0.5 * pixels as f64 / focal_length).atan().to_degrees()
}

impl DepthCamera {
    /// A camera by its intrinsics, pixels, whose images are in millimetres and of any size.
    pub fn new(fx: f64, fy: f64, cx: f64, cy: f64) -> Self {
        Self { fx, fy, cx, cy, depth_scale: 0.001, image_size: None }
    }

    /// Whether the numbers are those of a camera, whatever the image.
    ///
    /// # Errors
    /// When a focal length is not finite and positive, the principal point not finite, or the step of depth
    /// not above 0 and at most 0.1 m.
    pub fn validate(&self) -> Result<(), CameraError> {
        let lengths = [("fx", self.fx), ("fy", self.fy)];
        if let Some((name, value)) = lengths.into_iter().find(|(_, f)| !f.is_finite() || *f <= 0.0)
        {
            return Err(CameraError::FocalLength { name, value });
        }
        if let Some((name, value)) =
            [("cx", self.cx), ("cy", self.cy)].into_iter().find(|(_, c)| !c.is_finite())
        {
            return Err(CameraError::PrincipalPoint { name, value });
        }
        let is_step = self.depth_scale > 0.0 && self.depth_scale <= LARGEST_STEP;
        if is_step { Ok(()) } else { Err(CameraError::DepthScale { value: self.depth_scale }) }
    }

    /// Whether an image of so many columns and rows can be this camera's.
    ///
    /// # Errors
    /// As [`Self::validate`]; when the intrinsics are of another size, the principal point lies half an image
    /// or more beside it, at its last corner or, in a wide view, at a quarter of both sides, or the view is wider than
    /// 161 degrees or narrower than a twentieth of one.
    pub fn validate_for(&self, width: usize, height: usize) -> Result<(), CameraError> {
        self.validate()?;
        if let Some(stated) = self.image_size.filter(|stated| *stated != (width, height)) {
            return Err(CameraError::ImageSize { found: (width, height), stated });
        }
        let axes = [
            (["fx", "cx"], [self.fx, self.cx], width, "columns"),
            (["fy", "cy"], [self.fy, self.cy], height, "rows"),
        ];
        let is_at_corner =
            axes.iter().all(|(_, [_, point], pixels, _)| *point >= CORNER * *pixels as f64);
        for ([of_length, of_point], [length, point], pixels, along) in axes {
            let size = pixels as f64;
            if !FOCAL_LENGTHS.contains(&(length / size)) {
                return Err(CameraError::View { name: of_length, value: length, pixels, along });
            }
            let is_aside = point <= -MOST_ASIDE * size || point >= (1.0 + MOST_ASIDE) * size;
            if is_aside || is_at_corner {
                return Err(CameraError::LooksAside {
                    name: of_point,
                    value: point,
                    pixels,
                    along,
                });
            }
        }
        let is_at_quarter = |(_, [_, point], pixels, _): &(_, [f64; 2], usize, _)| {
            QUARTER.contains(&(point / *pixels as f64))
        };
        let is_wide = self.fx <= WIDE * width.max(height) as f64;
        if self.image_size.is_none() && is_wide && axes.iter().all(is_at_quarter) {
            return Err(CameraError::OfHalf { point: (self.cx, self.cy), size: (width, height) });
        }
        Ok(())
    }

    /// Where a pixel with so many steps of depth is, m, in the camera's optical frame: x right, y down, z
    /// forward. Depth is along z, not along the ray. NaN for 0 and 65535, which stand for no return.
    pub fn point(&self, column: usize, row: usize, steps: u16) -> Point3 {
        if steps == 0 || steps == u16::MAX {
            return Point3::new(f64::NAN, f64::NAN, f64::NAN);
        }
        let z = f64::from(steps) * self.depth_scale;
        let [x, y] = [(column, self.cx, self.fx), (row, self.cy, self.fy)]
            .map(|(pixel, middle, length)| (pixel as f64 - middle) / length * z);
        Point3::new(x, y, z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: DepthCamera = DepthCamera {
        fx: 500.0,
        fy: 400.0,
        cx: 320.0,
        cy: 240.0,
        depth_scale: 0.001,
        image_size: None,
    };

    fn message(camera: DepthCamera) -> String {
        camera.validate_for(640, 480).unwrap_err().to_string()
    }

    #[test]
    fn depth_is_along_the_axis_and_not_along_the_ray() {
        assert_eq!(CAMERA.point(320, 240, 1500), Point3::new(0.0, 0.0, 1.5));
        assert_eq!(CAMERA.point(570, 40, 2000), Point3::new(1.0, -1.0, 2.0));
        for none in [0, u16::MAX] {
            assert!(CAMERA.point(1, 1, none).iter().all(|v| v.is_nan()));
        }
        assert!((CAMERA.point(0, 0, 65534).z - 65.534).abs() < 1e-12);
    }

    #[test]
    fn numbers_that_are_no_camera_are_named_with_what_to_do() {
        assert_eq!(CAMERA.validate_for(640, 480), Ok(()));
        for (camera, parts) in [
            (DepthCamera { fx: 0.0, ..CAMERA }, ["fx is 0:", "above 0"]),
            (DepthCamera { fy: f64::NAN, ..CAMERA }, ["fy is NaN", "finite"]),
            (DepthCamera { cx: f64::INFINITY, ..CAMERA }, ["cx is inf", "finite"]),
            (DepthCamera { depth_scale: 5000.0, ..CAMERA }, ["is 5000 m", "5000 steps a metre"]),
            (DepthCamera { depth_scale: f64::NAN, ..CAMERA }, ["is NaN m", "0.001"]),
            (DepthCamera { depth_scale: -0.001, ..CAMERA }, ["is -0.001 m", "above 0"]),
            (DepthCamera { fx: 0.8, ..CAMERA }, ["fx is 0.8", "in pixels"]),
            (DepthCamera { fy: 1e6, ..CAMERA }, ["fy is 1000000", "480 rows"]),
            // Those of a colour image of 1920 x 1080.
            (DepthCamera { cx: 960.0, ..CAMERA }, ["cx is 960", "640 columns"]),
            (DepthCamera { cy: -240.0, ..CAMERA }, ["cy is -240", "480 rows"]),
            (
                DepthCamera { image_size: Some((1280, 960)), ..CAMERA },
                ["640 x 480 pixels", "of 1280 x 960"],
            ),
        ] {
            let message = message(camera);
            assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        }
    }
}
