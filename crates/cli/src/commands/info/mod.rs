//! `cloudtouch info`: what a file holds, and which sensor suits it.

mod of_camera;
mod of_cloud;
mod of_mesh;
mod triple;

use std::process::ExitCode;

use anyhow::{Result, bail};
use cloudtouch_io::{Geometry, is_depth_image};

use crate::answers::print;
use crate::args::InfoArguments;
use crate::load::{self, Kind, Units};
use crate::unused;
use crate::usage::WrongUsage;

use of_camera::describe_camera;
use of_cloud::{describe_cloud, describe_scan};
use of_mesh::describe_mesh;

pub(crate) fn run(arguments: &InfoArguments) -> Result<ExitCode> {
    let images = &arguments.depth.images();
    let units = Units {
        meshes: arguments.unit.unwrap_or_default(),
        clouds: arguments.cloud_unit.unwrap_or_default(),
        images,
    };
    if let Some(option) = arguments.depth.given().filter(|_| !is_depth_image(&arguments.file)) {
        bail!(unused::of_images(option));
    }
    #[cfg(feature = "mcap")]
    if let Some(name) = cloudtouch_io::recording::ScanName::of(&arguments.file) {
        load::check(&arguments.file)?;
        let text = super::recording::describe(&name?, arguments, describe_cloud)?;
        return answer(arguments, &text);
    }
    let read = load::geometry(&arguments.file, units, &arguments.limits.read_limits())?;
    let text = match (read.geometry, read.kind) {
        (Geometry::Cloud(_), _) if arguments.unit.is_some() => {
            bail!(WrongUsage(
                "--unit is for meshes, and this is a cloud: give --cloud-unit".to_owned()
            ))
        }
        (_, Kind::DepthImage(_)) if arguments.cloud_unit.is_some() => {
            bail!(WrongUsage(unused::CLOUD_UNIT.to_owned()))
        }
        (Geometry::Mesh(_), _) if arguments.cloud_unit.is_some() => {
            bail!(WrongUsage(
                "--cloud-unit is for clouds, and this is a mesh: give --unit".to_owned()
            ))
        }
        (Geometry::Cloud(cloud), Kind::DepthImage(camera)) => {
            // What is too large is so by its steps.
            let cloud_text = describe_scan(&cloud, "--depth-scale?")?;
            format!("{}\n{cloud_text}", describe_camera(&camera, &cloud))
        }
        (Geometry::Cloud(cloud), _) => describe_cloud(&cloud)?,
        (Geometry::Mesh(mesh), _) => describe_mesh(&mesh),
    };
    answer(arguments, &text)
}

fn answer(arguments: &InfoArguments, text: &str) -> Result<ExitCode> {
    print::to_stdout(&format!("{}\n{text}\n", arguments.file.display()))?;
    Ok(ExitCode::SUCCESS)
}
