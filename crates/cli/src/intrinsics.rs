//! What is said of depth images: the intrinsics of their camera, and what a step of depth is.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{Context as _, Result, bail};
use cloudtouch_io::DepthCamera;

use crate::files::intrinsics::{self, CameraFile};
use crate::numbers;

/// Intrinsics as an option or a scene file states them.
#[derive(Debug, Clone, PartialEq)]
pub enum Intrinsics {
    /// fx, fy, cx and cy, pixels.
    Numbers([f64; 4]),
    /// A file that has them.
    File(PathBuf),
}

/// What is said of depth images; of what is not said there is a default or, of intrinsics, an error.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DepthImages {
    /// Of their camera.
    pub intrinsics: Option<Intrinsics>,
    /// A step of depth, m.
    pub depth_scale: Option<f64>,
}

impl DepthImages {
    /// The file of the intrinsics, if they are in one.
    pub fn file(&self) -> Option<&Path> {
        match &self.intrinsics {
            Some(Intrinsics::File(file)) => Some(file),
            _ => None,
        }
    }
}

impl Intrinsics {
    /// `FX,FY,CX,CY`, or else the name of a file.
    ///
    /// # Errors
    /// When it begins with a number and is not four finite ones of a camera.
    pub fn parse(text: &str) -> Result<Self, String> {
        let first = text.split([',', ' ']).next().unwrap_or_default();
        if first.parse::<f64>().is_err() {
            return match text.trim() {
                "" => Err("give fx,fy,cx,cy in pixels, or a file of them".to_owned()),
                file => Ok(Self::File(file.into())),
            };
        }
        Self::of_numbers(numbers::intrinsics(text)?)
    }

    /// fx, fy, cx and cy, pixels.
    ///
    /// # Errors
    /// When they are not those of a camera.
    pub fn of_numbers([fx, fy, cx, cy]: [f64; 4]) -> Result<Self, String> {
        let camera = DepthCamera::new(fx, fy, cx, cy);
        camera.validate().map_err(|error| error.to_string())?;
        Ok(Self::Numbers([fx, fy, cx, cy]))
    }
}

impl FromStr for Intrinsics {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::parse(text)
    }
}

/// A step of depth, m.
///
/// # Errors
/// When no camera has such steps.
pub fn depth_scale(metres: f64) -> Result<f64, String> {
    let camera = DepthCamera { depth_scale: metres, ..DepthCamera::new(1.0, 1.0, 0.0, 0.0) };
    camera.validate().map(|()| metres).map_err(|error| error.to_string())
}

impl DepthImages {
    /// Whether nothing is said.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// What is said here, and for what is not what is said of others.
    #[must_use]
    pub fn or(&self, others: &Self) -> Self {
        Self {
            intrinsics: self.intrinsics.clone().or_else(|| others.intrinsics.clone()),
            depth_scale: self.depth_scale.or(others.depth_scale),
        }
    }

    /// The camera of an image.
    ///
    /// # Errors
    /// When no intrinsics are given, their file cannot be read (of at most `max_bytes`) or is not clear, or
    /// there is no such camera.
    pub fn camera(&self, image: &Path, max_bytes: u64) -> Result<DepthCamera> {
        let named = || image.display().to_string();
        let mut camera = match &self.intrinsics {
            None => bail!(
                "{}: a depth image is read with the intrinsics of its camera: give fx, fy, cx and cy in \
                 pixels, or a file of them (--intrinsics FX,FY,CX,CY or FILE)",
                named()
            ),
            Some(Intrinsics::Numbers([fx, fy, cx, cy])) => DepthCamera::new(*fx, *fy, *cx, *cy),
            Some(Intrinsics::File(file)) => {
                let CameraFile { camera, unclear_scale } =
                    intrinsics::read(file, image, max_bytes)?;
                if let Some(scale) = unclear_scale.filter(|_| self.depth_scale.is_none()) {
                    bail!(
                        "{}: {scale}, which is metres a step, steps a metre or, of BOP, \
                         millimetres a step: say metres a step (--depth-scale, such as 0.001)",
                        file.display()
                    );
                }
                camera
            }
        };
        camera.depth_scale = self.depth_scale.unwrap_or(camera.depth_scale);
        camera.validate().with_context(named)?;
        Ok(camera)
    }
}
