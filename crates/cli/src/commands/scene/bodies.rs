//! The bodies that a scene file names: each file is read once for all that take it for the same.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use anyhow::{Context as _, Result, anyhow, ensure};
use cloudtouch::Cloud;
use cloudtouch_cli::files::scene::BodyEntry;
use cloudtouch_cli::numbers::Rigid;
use cloudtouch_io::{LengthUnit, is_depth_image};
use rayon::prelude::*;

use super::of_their_own;
use crate::answers::print;
use crate::args::{BodyOptions, CommonArguments};
use crate::body::Body;
use crate::load::{self, Input, Kind, Loaded, Role};
use crate::sensor::SensorChoice;
use crate::unused;
use crate::usage;

/// A file, the unit it is said to be in, the sensor that saw it, by its spec, and where that stood and what is said
/// of it as a depth image, spelt out.
type BodyKey = (PathBuf, Option<LengthUnit>, String, String);

/// What several bodies of a scene may share.
pub(in crate::commands) struct Prepared {
    pub body: Arc<cloudtouch::Body>,
    pub input: Input,
    /// What it is, for people.
    pub words: String,
    /// What its file was.
    files: Vec<(Role, Kind)>,
}

impl Prepared {
    pub(in crate::commands) fn words_of(&self, entry: &BodyEntry) -> String {
        let attached = entry.attached_to.as_deref().map(print::one_line);
        let attached = attached.map_or(String::new(), |to| format!(", attached to {to}"));
        format!("{}: {}{attached}", print::one_line(&entry.name), self.words)
    }

    pub(in crate::commands) fn is_mesh(&self) -> bool {
        matches!(*self.body, cloudtouch::Body::Mesh(_))
    }
}

/// Bodies of a file, read and prepared.
pub(in crate::commands) struct FileBodies<'a> {
    entries: &'a [BodyEntry],
    keys: Vec<BodyKey>,
    prepared: BTreeMap<BodyKey, Prepared>,
}

impl<'a> FileBodies<'a> {
    /// Reads and prepares all of them, after a look whether they are there.
    pub(in crate::commands) fn read(
        common: &CommonArguments,
        entries: &'a [BodyEntry],
    ) -> Result<Self> {
        let keys: Vec<BodyKey> =
            (entries.iter().enumerate()).map(|body| key(common, body)).collect::<Result<_>>()?;
        let mut wanted: BTreeMap<&BodyKey, Vec<usize>> = BTreeMap::new();
        for (index, key) in keys.iter().enumerate() {
            wanted.entry(key).or_default().push(index);
        }
        let wanted: Vec<(&BodyKey, Vec<usize>)> = wanted.into_iter().collect();
        let prepared = wanted.into_par_iter().map(|(key, of)| {
            // Of several bodies of one file the first.
            let first = of[0];
            let loaded = load(common, key, &entries[first]);
            let loaded = loaded.with_context(|| place(first, &entries[first]))?;
            let loaded = loaded.refined_for(of.len(), common.effort.refine())?;
            Ok((key.clone(), loaded.into()))
        });
        let prepared = prepared.collect::<Result<_>>()?;
        let read = Self { entries, keys, prepared };
        read.check_sensors()?;
        Ok(read)
    }

    /// Each with what it is, in the order of the file.
    pub(in crate::commands) fn all(&self) -> impl Iterator<Item = (&'a BodyEntry, &Prepared)> {
        let of = |(entry, key)| (entry, &self.prepared[key]);
        self.entries.iter().zip(&self.keys).map(of)
    }

    /// Refuses a sensor of a mesh.
    fn check_sensors(&self) -> Result<()> {
        for (index, (entry, prepared)) in self.all().enumerate() {
            ensure!(
                !prepared.is_mesh() || entry.sensor.is_none(),
                "{}: {}",
                place(index, entry),
                usage::of_a_mesh("sensor", &prepared.input.file)
            );
        }
        Ok(())
    }

    /// Refuses options that no body has a use for, such as a sensor of all clouds where each has its own. `others`
    /// are of no file of bodies.
    pub(in crate::commands) fn check_options(
        &self,
        common: &CommonArguments,
        others: &[&Prepared],
    ) -> Result<()> {
        let of_entries = self.all().map(|(entry, prepared)| (Some(entry), prepared));
        let all = of_entries.chain(others.iter().map(|other| (None, *other)));
        let files: Vec<_> = all
            .flat_map(|(entry, of)| of.files.iter().map(move |(role, kind)| (entry, *role, *kind)))
            .collect();
        unused::check(&common.bodies(), files.iter().map(|(_, role, kind)| (*role, *kind)))?;
        of_their_own::check(common, files.iter().map(|(entry, _, kind)| (*entry, *kind)))
    }
}

impl From<Loaded<Cloud>> for Prepared {
    fn from(loaded: Loaded<Cloud>) -> Self {
        let (words, files) = (print::about(&loaded), loaded.files(Role::Scene).collect());
        let body = Arc::new(match loaded.body {
            Body::Cloud(cloud) => cloud.into(),
            Body::Mesh(mesh) => mesh.into(),
        });
        Self { body, input: loaded.input, words, files }
    }
}

fn place(index: usize, entry: &BodyEntry) -> String {
    format!("body {} `{}`", index + 1, entry.name)
}

fn key(common: &CommonArguments, (index, entry): (usize, &BodyEntry)) -> Result<BodyKey> {
    let place = || place(index, entry);
    let BodyEntry { file, sensor, sensor_pose, unit, depth, .. } = entry;
    load::check(file).with_context(place)?;
    check_image(entry).with_context(place)?;
    let sensor = match sensor {
        Some(spec) => spec.parse::<SensorChoice>().map_err(|error| anyhow!("{error}")),
        None => Ok(common.scene_sensor()),
    };
    let seen = format!("{sensor_pose:?} {depth:?}");
    Ok((file.clone(), *unit, sensor.with_context(place)?.to_string(), seen))
}

fn load(
    common: &CommonArguments,
    (path, unit, sensor, _): &BodyKey,
    entry: &BodyEntry,
) -> Result<Loaded<Cloud>> {
    let sensor = sensor.parse::<SensorChoice>().map_err(|error| anyhow!("{error}"))?;
    let usual = common.bodies();
    let (sensor_pose, depth) = (entry.sensor_pose.map(Rigid), entry.depth.or(&usual.depth));
    let options = BodyOptions { sensor_pose, is_of_file: true, depth, ..usual };
    load::body_in::<Cloud>(path, *unit, sensor, &options)
}

/// Refuses what is said of a depth image where the file is none, and a unit where it is one.
fn check_image(entry: &BodyEntry) -> Result<()> {
    let file = entry.file.display();
    let is_image = is_depth_image(&entry.file);
    ensure!(
        is_image || entry.depth.is_empty(),
        "`intrinsics` and `depth_scale` are of a depth image (.png), and {file} is none: leave them out"
    );
    ensure!(
        !is_image || entry.unit.is_none(),
        "`unit` is not for a depth image, and {file} is one: give `depth_scale`, metres a step"
    );
    Ok(())
}
