//! The files that a query leaves: a table of points, a picture, a page.

use std::path::Path;

use anyhow::Result;
use cloudtouch::Report;
use cloudtouch_io::read_colors_within;
use cloudtouch_page::{Page, View};

use super::ask::Found;
use super::question::Question;
use super::tell;
use crate::answers::{per_point, text};
use crate::body::PreparedCloud;
use crate::inside::with_points_inside;
use crate::{pages, picture};

/// Writes those that were asked for.
pub(super) fn files<C: PreparedCloud>(question: &Question<'_, C>, found: &Found) -> Result<()> {
    let Question { arguments, scene, object, pose, .. } = question;
    let shown = with_points_inside(found.report.clone(), (&scene.body, &object.body), pose);
    if let Some(path) = &arguments.csv {
        per_point::write_csv(path, &scene.body, &object.body, pose, &shown)?;
    }
    if let Some(path) = &arguments.ply {
        write_picture(path, question, &shown)?;
    }
    if let Some(path) = &arguments.html {
        write_page(path, question, found, &shown)?;
    }
    Ok(())
}

/// Both bodies in the colours of their files, where these have some.
fn write_picture<C: PreparedCloud>(
    path: &Path,
    Question { arguments, scene, object, pose, .. }: &Question<'_, C>,
    shown: &Report,
) -> Result<()> {
    let limits = arguments.asked.common.limits.read_limits();
    let files = [&arguments.scene, &arguments.object];
    let [of_scene, of_object] = files.map(|file| read_colors_within(file, &limits));
    let (of_scene, of_object) = (of_scene?, of_object?);
    let scene = (&scene.body, of_scene.as_deref());
    let object = (&object.body, of_object.as_deref());
    picture::write(path, scene, object, pose, shown)
}

/// Both bodies and the answer, to look at.
fn write_page<C: PreparedCloud>(
    path: &Path,
    Question { arguments, scene, object, pose, .. }: &Question<'_, C>,
    found: &Found,
    shown: &Report,
) -> Result<()> {
    let limits = arguments.asked.common.limits.read_limits();
    // Rows of several scans are not those of the first file.
    let scan = Some(arguments.scene.as_path()).filter(|_| arguments.also.is_empty());
    let bodies = [
        pages::body(scene, scan, &limits)?,
        pages::body(object, Some(&arguments.object), &limits)?,
    ];
    let not_seen = text::not_seen(shown, !scene.is_mesh());
    let view = View::of_pair("The pose asked about", [0, 1], *pose, shown)
        .with_placement(&found.placement)
        .with_more(not_seen.into_iter().chain(tell::facts(found)).collect());
    let title = format!("{} in {}", bodies[1].name, bodies[0].name);
    let page = Page { title, bodies: bodies.into(), views: vec![view], ..Page::default() };
    pages::write(path, page)
}
