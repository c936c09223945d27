//! What `query` is given.

use std::path::PathBuf;

use clap::Args;

use super::answer::written;
use super::asked::AskedArguments;
use super::parse::parse_fraction;
use super::pose::PoseArguments;

/// One object in one scene at one pose.
#[derive(Debug, Args)]
#[command(after_help = super::SENSORS, group = written(&["csv", "ply", "html"]))]
pub(crate) struct QueryArguments {
    /// Cloud or mesh of the surroundings (.pcd .ply .xyz .txt .csv .png .stl .obj)
    pub scene: PathBuf,
    /// Cloud or mesh of the object
    pub object: PathBuf,
    #[command(flatten)]
    pub pose: PoseArguments,
    /// Print the report as one JSON object
    #[arg(long, help_heading = "Output")]
    pub json: bool,
    /// With --json: the probability of each point too, and both ways of pooling them
    #[arg(long, requires = "json", help_heading = "Output")]
    pub points: bool,
    /// Paper, with --json: each classifier trained too, with f, xi, alpha, v and b
    #[arg(long, requires = "json", help_heading = "Output")]
    pub explain: bool,
    /// Write the points of both clouds with their probabilities as a table
    #[arg(long, value_name = "OUT.csv", help_heading = "Output")]
    pub csv: Option<PathBuf>,
    /// Another scan of the same scene, in the same frame; repeatable
    #[arg(long, value_name = "FILE", help_heading = "Files")]
    pub also: Vec<PathBuf>,
    /// Paper, without --also: text file with one kappa for each row of the scene
    #[arg(long, value_name = "FILE", conflicts_with = "also", help_heading = "Files")]
    pub kappas: Option<PathBuf>,
    /// Calibrated: also how P and clearance change along the object's axes
    #[arg(long, help_heading = "Estimate")]
    pub gradient: bool,
    /// Calibrated: also the least translation to a probability below P [0.1]
    #[arg(long, value_name = "P", num_args = 0..=1, require_equals = true,
          default_missing_value = "0.1", value_parser = parse_fraction, help_heading = "Estimate")]
    pub penetration: Option<f64>,
    /// Exit with 0 free, 10 uncertain, 20 in collision, 30 undecided
    #[arg(long, help_heading = "Output")]
    pub exit_code: bool,
    /// Write both bodies, redder with probability, contacts green; a mesh as a mesh
    #[arg(long, value_name = "OUT.ply", help_heading = "Output")]
    pub ply: Option<PathBuf>,
    /// Write a page that shows all of it in any browser
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub html: Option<PathBuf>,
    /// Replace an output file that is there already
    #[arg(long, requires = "written", help_heading = "Output")]
    pub force: bool,
    #[command(flatten)]
    pub asked: AskedArguments,
}

impl QueryArguments {
    /// Refuses options that contradict one another; the message names them.
    pub(super) fn check(&self) -> Result<(), String> {
        let of_the_paper = [("--explain", self.explain), ("--kappas", self.kappas.is_some())];
        let of_the_default = [
            ("--pose-std", self.pose.pose_std.is_some()),
            ("--gradient", self.gradient),
            ("--penetration", self.penetration.is_some()),
        ];
        self.asked.check(&of_the_paper, &of_the_default)
    }
}
