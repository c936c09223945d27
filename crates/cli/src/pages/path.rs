//! The report page of a path.

use std::path::Path;

use anyhow::Result;
use cloudtouch::geom::Pose;
use cloudtouch::{AlongPath, QueryError, Report, Swept};
use cloudtouch_page::{Body, Fact, MOST_VIEWS, Page, View};

use crate::{answers, pages};

/// A pose of the path that is shown.
struct Shown {
    share: f64,
    name: String,
    pose: Pose,
    report: Report,
}

/// Puts a place that the sweep found among the poses, which are in order.
fn insert(shown: &mut Vec<Shown>, at: &AlongPath, what: &str) {
    let index = shown.partition_point(|pose| pose.share < at.share);
    match shown.get_mut(index) {
        Some(same) if same.share == at.share => same.name = format!("{}: {what}", same.name),
        _ => {
            let name = format!("At {} of the path: {what}", answers::path::percent(at.share));
            let (share, pose, report) = (at.share, at.pose, at.report.clone());
            shown.insert(index, Shown { share, name, pose, report });
        }
    }
}

/// Writes a page of the given poses of a path, which `ask` answers, and of the two places between
/// them that the sweep found, with what holds of the whole path; `colored` tells which points of a report are to be seen.
pub(crate) fn write(
    output: &Path,
    [scene, object]: [Body; 2],
    (swept, summary): (&Swept, Vec<Fact>),
    path: &cloudtouch::Path,
    ask: impl Fn(&Pose) -> Result<Report, QueryError>,
    colored: impl Fn(Report, &Pose) -> Report,
) -> Result<()> {
    let given = path.segments() + 1;
    // Evenly many are left out where there are too many.
    let step = given.div_ceil(MOST_VIEWS - 2);
    let mut shown = Vec::new();
    for number in (0..given).step_by(step) {
        let share = number as f64 / path.segments() as f64;
        let pose = path.pose(share);
        let name = format!(
            "Pose {} of {given}, at {} of the path",
            number + 1,
            answers::path::percent(share)
        );
        shown.push(Shown { share, name, pose, report: ask(&pose)? });
    }
    let likeliest = &swept.most_probable;
    insert(&mut shown, likeliest, "the largest probability found");
    let first = swept.first.as_ref().map(|first| &first.at);
    if let Some(first) = first {
        insert(&mut shown, first, "in collision from here");
    }
    for pose in &mut shown {
        pose.report = colored(pose.report.clone(), &pose.pose);
    }
    let opening = first.unwrap_or(likeliest).share;
    let start = shown.partition_point(|pose| pose.share < opening);
    let notes = (step > 1).then(|| format!("Of the {given} poses given every {step}th is shown."));
    let views = shown.iter().map(|Shown { name, pose, report, .. }| {
        View::of_pair(name.as_str(), [0, 1], *pose, report)
    });
    let page = Page {
        title: format!("{} along a path in {}", object.name, scene.name),
        summary,
        notes: notes.into_iter().collect(),
        views: views.collect(),
        bodies: vec![scene, object],
        start,
        ..Page::default()
    };
    pages::write(output, page)
}
