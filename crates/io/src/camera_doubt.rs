//! Intrinsics that may be of another image, or in another order.

use std::fmt;

use crate::depth_camera::DepthCamera;

/// Pixels of cameras are about as wide as they are high.
const UNLIKE: f64 = 1.5;
/// Where in its image a camera looks, along each side: of a part of a larger image elsewhere.
const MIDDLE: std::ops::RangeInclusive<f64> = 0.25..=0.75;

/// Why intrinsics may be those of another image, or in another order; of a part of a larger image they may be right.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum CameraDoubt {
    /// The principal point is far from the middle.
    Aside {
        /// `cx` and `cy`, pixels.
        point: (f64, f64),
        /// Columns and rows of the image.
        size: (usize, usize),
    },
    /// `fx` and `fy`, pixels, are far from alike.
    Unlike {
        /// `fx`.
        fx: f64,
        /// `fy`.
        fy: f64,
    },
}

impl DepthCamera {
    /// What is odd about the intrinsics for an image of so many columns and rows, though a camera may have them.
    pub fn doubt_for(&self, width: usize, height: usize) -> Option<CameraDoubt> {
        let Self { fx, fy, cx, cy, .. } = *self;
        let is_aside = |point: f64, pixels: usize| !MIDDLE.contains(&(point / pixels as f64));
        if is_aside(cx, width) || is_aside(cy, height) {
            Some(CameraDoubt::Aside { point: (cx, cy), size: (width, height) })
        } else if fx / fy > UNLIKE || fy / fx > UNLIKE {
            Some(CameraDoubt::Unlike { fx, fy })
        } else {
            None
        }
    }
}

impl fmt::Display for CameraDoubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Aside { point: (cx, cy), size: (width, height) } => write!(
                f,
                "the principal point ({cx}, {cy}) is far from the middle of {width} x {height} pixels"
            ),
            Self::Unlike { fx, fy } => write!(f, "the focal lengths are {fx} and {fy} pixels"),
        }?;
        write!(
            f,
            ": give fx, fy, cx and cy in this order, of this image and not of another size; of a crop they may be \
             right"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_a_matrix_is_told_from_that_of_its_numbers() {
        let of = |fx, fy, cx, cy| DepthCamera::new(fx, fy, cx, cy).doubt_for(320, 240);
        assert_eq!(of(285.0, 285.0, 159.5, 119.5), None);
        let words = of(285.0, 159.5, 285.0, 119.5).unwrap().to_string();
        assert!(words.contains("(285, 119.5)") && words.contains("320 x 240"), "{words}");
        let words = of(525.0, 285.0, 159.5, 119.5).unwrap().to_string();
        assert!(words.contains("525 and 285"), "{words}");
    }
}
