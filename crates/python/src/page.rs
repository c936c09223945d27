//! What was answered, to look at: one HTML page.

use std::sync::Arc;

use cloudtouch::geom::Pose;
use cloudtouch::{Body as Prepared, Query, Report, StageReport};
use cloudtouch_page::{Body as Drawn, MOST_VIEWS, Page, Shape, View, notebook_frame};
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
    Ok(py.detach(|| height.map_or_else(|| page.html(), |height| notebook_frame(&page, height))))
}

/// In the words of the tool's pages.
fn drawn(name: &str, body: &Prepared, sensor: Option<String>) -> Drawn {
    let (about, shape) = match body {
        Prepared::Cloud(cloud) => {
            let removed =
                |stage: &StageReport| format!("{} removed {}", stage.stage, stage.removed);
            let stages: Vec<String> = cloud.filter_stages().iter().map(removed).collect();
            let (count, sensor) = (cloud.len(), sensor.unwrap_or_default());
            (
                format!("cloud of {count} points in m, sensor {sensor} ({})", stages.join(", ")),
                Shape::cloud(count, |index| cloud.point(index)),
            )
        }
        Prepared::Mesh(mesh) => {
            let kind = if mesh.is_watertight() { "watertight" } else { "open" };
            let (count, size) = (mesh.triangle_count(), mesh.size());
            (format!("{kind} mesh of {count} triangles in m, {size:.3} m across"), mesh.into())
        }
    };
    Drawn { name: name.to_owned(), about, shape }
}
