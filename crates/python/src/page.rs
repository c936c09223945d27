//! What was answered, to look at: one HTML page.

use std::sync::Arc;

use cloudtouch::geom::Pose;
use cloudtouch::{Body as Prepared, Query, Report, Scene, SceneError, StageReport};
use cloudtouch_page::{Body as Drawn, Cast, Fact, MOST_VIEWS, Page, View, notebook_frame, words};
use pyo3::prelude::*;

use crate::error::{refused, refused_for};
use crate::pool::on_all_threads;

/// The page on one pair in some poses: a whole file, or a frame of it for a notebook.
pub(crate) fn answer(
    py: Python<'_>,
    query: &Query,
    [(a, sensor_a), (b, sensor_b)]: [(Arc<Prepared>, Option<String>); 2],
    poses: &[Pose],
    title: String,
    height: Option<u32>,
) -> PyResult<String> {
    if poses.is_empty() || poses.len() > MOST_VIEWS {
        let (most, given) = (MOST_VIEWS, poses.len());
        return Err(refused(format!("poses are {given}: a page shows 1 to {most}")));
    }
    let reports = on_all_threads(py, || query.run_batch(&*a, &*b, poses))?;
    let failed = |(index, report): (usize, Result<Report, _>)| {
        report.map_err(|e| refused_for(format!("poses[{index}]"), e))
    };
    let reports: PyResult<Vec<Report>> = reports.into_iter().enumerate().map(failed).collect();
    let reports = reports?;
    let bodies = vec![drawn("a", &a, sensor_a), drawn("b", &b, sensor_b)];
    let views = poses.iter().zip(&reports).enumerate().map(|(index, (pose, report))| {
        View::of_pair(format!("pose {}", index + 1), [0, 1], *pose, report)
    });
    let views = views.collect();
    let page = Page { title, bodies, views, ..Page::default() };
    Ok(written(py, &page, height))
}

/// The page on a scene, in the same two forms; `first` keeps its place in the picture, else the largest does.
pub(crate) fn of_scene(
    py: Python<'_>,
    query: &Query,
    scene: &Scene,
    first: Option<&str>,
    (title, height): (String, Option<u32>),
) -> PyResult<String> {
    let checked = on_all_threads(py, || scene.check(query))?;
    let page = || -> Result<Page<'_>, SceneError> {
        let taken_for =
            |name: &str| scene.body(name).map_or(String::new(), |body| about(body, None));
        let cast = Cast::of(scene, first, taken_for)?;
        let mut page = Page { title, ..Page::of_scene(cast, scene, &checked)? };
        let warnings = checked.warnings.iter().map(ToString::to_string);
        let outside = checked.outside.iter().map(ToString::to_string);
        page.summary.extend(warnings.chain(outside).map(|words| Fact::new("Warning", words)));
        Ok(page)
    };
    let page = page().map_err(refused)?;
    Ok(written(py, &page, height))
}

fn written(py: Python<'_>, page: &Page<'_>, height: Option<u32>) -> String {
    py.detach(|| height.map_or_else(|| page.html(), |height| notebook_frame(page, height)))
}

fn drawn(name: &str, body: &Prepared, sensor: Option<String>) -> Drawn {
    Drawn { name: name.to_owned(), about: about(body, sensor), shape: body.into() }
}

/// In the words of the tool's pages.
fn about(body: &Prepared, sensor: Option<String>) -> String {
    match body {
        Prepared::Cloud(cloud) => {
            let removed =
                |stage: &StageReport| format!("{} removed {}", stage.stage, stage.removed);
            let stages: Vec<String> = cloud.filter_stages().iter().map(removed).collect();
            let sensor = sensor.map_or(String::new(), |sensor| format!(", sensor {sensor}"));
            format!("cloud of {} points in m{sensor} ({})", cloud.len(), stages.join(", "))
        }
        Prepared::Mesh(mesh) => {
            let kind = mesh.kind();
            let (count, size) = (mesh.triangle_count(), mesh.size());
            format!("{kind} mesh of {count} triangles in m, {}", words::across(size))
        }
    }
}
