//! From the command line to two bodies and a pose.

use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use cloudtouch::geom::{Pose, Vector3};
use cloudtouch_cli::numbers::{Triple, Turn};
use nalgebra::UnitQuaternion;

use crate::args::{PoseArguments, QueryArguments};
use crate::body::{Body, PreparedCloud};
use crate::doubt::Doubt;
use crate::load::{self, Loaded, Role};
use crate::output::{self, Output};
use crate::unused;
use crate::usage::WrongUsage;

/// What is asked about.
pub(super) struct Question<'a, C> {
    pub arguments: &'a QueryArguments,
    pub scene: Loaded<C>,
    pub object: Loaded<C>,
    /// Object to scene.
    pub pose: Pose,
    /// About the pose as it was given.
    pub doubt: Option<Doubt>,
}

/// The files of both bodies.
pub(super) fn bodies(arguments: &QueryArguments) -> impl Iterator<Item = &Path> {
    let both = [&arguments.scene, &arguments.object];
    both.into_iter().chain(&arguments.also).map(PathBuf::as_path)
}

/// Whether all files that are read are there, and none that is written.
pub(super) fn check_files(arguments: &QueryArguments) -> Result<()> {
    let options = &arguments.asked.bodies();
    let inputs = [&arguments.scene, &arguments.object]
        .into_iter()
        .chain(&arguments.also)
        .chain(&arguments.kappas)
        .chain(options.robot);
    inputs.clone().try_for_each(|path| load::check(path))?;
    let outputs = [
        Output::of("ply", &arguments.ply),
        Output::table(&arguments.csv),
        Output::of("html", &arguments.html),
    ];
    let settings = options.settings.map(|file| &file.path);
    let inputs = inputs.chain(&arguments.pose.pose).chain(settings).map(PathBuf::as_path);
    let inputs = inputs.chain(options.depth.file());
    output::check(&outputs, inputs, arguments.force)
}

/// Reads the pose and both bodies, and prepares these.
pub(super) fn load<C: PreparedCloud>(arguments: &QueryArguments) -> Result<Question<'_, C>> {
    let (common, options) = (&arguments.asked.common, &arguments.asked.bodies());
    let max_bytes = common.limits.read_limits().bytes;
    let pose = pose(&arguments.pose, max_bytes)?;
    let doubt = arguments.pose.quaternion.and_then(|Turn(turn)| Doubt::of_option(&turn));
    if let Some(doubt) = &doubt {
        tracing::warn!("{}", doubt.words);
    }
    let scans: Vec<&Path> =
        std::iter::once(&arguments.scene).chain(&arguments.also).map(PathBuf::as_path).collect();
    let scene = load::bodies(&scans, Role::Scene, common.scene_sensor(), options)?;
    let scene = with_kappas(scene, arguments, max_bytes)?;
    let object = load::body(&arguments.object, Role::Object, options.object_sensor(), options)?;
    unused::check(options, scene.files(Role::Scene).chain(object.files(Role::Object)))?;
    let scene = scene.refined_for(1, common.effort.refine())?;
    let object = object.refined_for(1, common.effort.refine())?;
    Ok(Question { arguments, scene, object, pose, doubt })
}

fn pose(arguments: &PoseArguments, max_bytes: u64) -> Result<Pose> {
    if let Some(path) = &arguments.pose {
        return load::pose::read(path, max_bytes);
    }
    let offset = arguments.translate.map_or(Vector3::zeros(), |Triple(offset)| offset.into());
    let turn = arguments.turn().map_or(UnitQuaternion::identity(), |turn| turn.0);
    Ok(Pose::from_translation_rotation(offset, turn))
}

/// Gives each row of the scene its own κ, where a file says so.
fn with_kappas<C: PreparedCloud>(
    scene: Loaded<C>,
    arguments: &QueryArguments,
    max_bytes: u64,
) -> Result<Loaded<C>> {
    let Some(path) = &arguments.kappas else { return Ok(scene) };
    let named = || path.display().to_string();
    let Body::Cloud(cloud) = scene.body else {
        let exact = "--kappas is for a scene that is a cloud, and this is a mesh: leave it out";
        bail!(WrongUsage(format!("{}: {exact}", scene.input.file)));
    };
    let text = load::text::read(path, "kappas", max_bytes)?;
    let kappas: Result<Vec<f64>, _> = text.split_whitespace().map(str::parse).collect();
    let rule = arguments.asked.mode.paper_settings(&arguments.asked.common).radius_rule;
    let cloud = cloud.with_kappas(&kappas.with_context(named)?, rule).with_context(named)?;
    Ok(Loaded { body: Body::Cloud(cloud), ..scene })
}
