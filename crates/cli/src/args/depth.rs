//! Options about depth images.

use clap::Args;
use cloudtouch_cli::intrinsics::{DepthImages, Intrinsics, depth_scale};
use cloudtouch_cli::numbers;

/// What is said of depth images.
#[derive(Debug, Args)]
#[command(next_help_heading = "Files")]
pub(crate) struct DepthArguments {
    /// Of a depth image (.png): its camera in pixels, or a file
    #[arg(long, value_name = "FX,FY,CX,CY|FILE")]
    intrinsics: Option<Intrinsics>,
    /// Of a depth image: metres a step [0.001]
    #[arg(long, value_name = "METRES", value_parser = parse_step, allow_negative_numbers = true)]
    depth_scale: Option<f64>,
}

impl DepthArguments {
    /// An option that is given.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let intrinsics = self.intrinsics.as_ref().map(|_| "--intrinsics");
        intrinsics.or(self.depth_scale.map(|_| "--depth-scale"))
    }

    pub(crate) fn images(&self) -> DepthImages {
        DepthImages { intrinsics: self.intrinsics.clone(), depth_scale: self.depth_scale }
    }
}

fn parse_step(text: &str) -> Result<f64, String> {
    depth_scale(numbers::finite(text)?)
}
