//! What was answered, to look at: one HTML page.

use std::sync::Arc;

use cloudtouch::geom::Pose;
use cloudtouch::{Body as Prepared, Query, Report};
use cloudtouch_page::{Body as Drawn, MOST_VIEWS, Page, Shape, View, notebook_frame};
use pyo3::prelude::*;

use crate::error::{refused, refused_for};
use crate::pool::on_all_threads;

/// The page on one pair in some poses: a whole file, or a frame of it for a notebook.
pub(crate) fn answer(
    py: Python<'_>,
    query: &Query,
    [a, b]: [Arc<Prepared>; 2],
    poses: &[Pose],
    title: &str,
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
    let bodies = vec![drawn("a", &a), drawn("b", &b)];
    let views = poses.iter().zip(&reports).enumerate().map(|(index, (pose, report))| View {
        name: format!("pose {index}"),
        scene: 0,
        object: 1,
        scene_from_object: *pose,
        report,
        placement: None,
        more: Vec::new(),
    });
    let views = views.collect();
    let page = Page { title: title.to_owned(), bodies, views, ..Page::default() };
    Ok(py.detach(|| height.map_or_else(|| page.html(), |height| notebook_frame(&page, height))))
}

fn drawn(name: &str, body: &Prepared) -> Drawn {
    let (about, shape) = match body {
        Prepared::Cloud(cloud) => (
            format!("cloud of {} points", cloud.len()),
            Shape::cloud(cloud.len(), |index| cloud.point(index)),
        ),
        Prepared::Mesh(mesh) => {
            (format!("mesh of {} triangles", mesh.triangle_count()), mesh.into())
        }
    };
    Drawn { name: name.to_owned(), about, shape }
}
