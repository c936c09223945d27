//! Figure 4: probability against signed distance, at two noise levels, in all modes.

use anyhow::Result;
use cloudtouch::{
    Cloud, CloudSettings, PaperCloud, PaperQuery, Query, QuerySettings, Report, noise::SensorModel,
};
use cloudtouch_geom::{Pose, seed::derive};
use cloudtouch_testkit::{exact::ExactMesh, poses::poses_near_contact, scene};

use super::clouds::{PATHS, SEED, by_paper, sampled};
use crate::{
    figure::{Axis, Figure, Panel, Series},
    page::Section,
    table::Table,
};

/// Standard deviations of the noise, m.
const STDS: [f64; 2] = [0.002, 0.01];
/// Distances beyond this are drawn at the edge, mm.
const WIDEST: f64 = 60.0;

pub(super) fn section(points: usize, poses: usize) -> Result<Section> {
    let meshes = [scene::room(), scene::piano()];
    let exact = meshes.each_ref().map(ExactMesh::new);
    let poses = poses_near_contact(&exact[0], &exact[1], poses, derive(SEED, 4, 0));
    let places: Vec<Pose> = poses.iter().map(|pose| pose.scene_from_object).collect();
    let mut panels = Vec::new();
    let mut table = Table::new([
        "noise (mm)",
        "method",
        "false alarms",
        "misses",
        "Brier score",
        "mean P, free",
        "mean P, collision",
    ]);
    for (number, std) in STDS.into_iter().enumerate() {
        let clouds: Vec<_> = (0..2)
            .map(|body| sampled(&meshes[body], points, std, 20 + 2 * number as u64 + body as u64))
            .collect();
        let mut answers = vec![("default", by_default(&clouds, std, &places)?)];
        for (name, query, model) in PATHS {
            let by = by_paper(std, model());
            let [a, b] = [0, 1].map(|body| PaperCloud::prepare(&clouds[body], &by));
            let reports = PaperQuery::new(query())?.run_batch(&a?, &b?, &places);
            answers.push((name, probabilities(reports)?));
        }
        for (name, said) in answers {
            let of = |collides| {
                let both =
                    poses.iter().zip(&said).filter(move |(pose, _)| pose.in_collision == collides);
                both.map(|(_, p)| *p).collect::<Vec<f64>>()
            };
            let (free, hit) = (of(false), of(true));
            let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len() as f64;
            let squares = free.iter().map(|p| p * p).chain(hit.iter().map(|p| (1.0 - p).powi(2)));
            table.row([
                format!("{:.0}", 1e3 * std),
                name.to_owned(),
                free.iter().filter(|p| **p >= 0.5).count().to_string(),
                hit.iter().filter(|p| **p < 0.5).count().to_string(),
                format!("{:.3}", squares.sum::<f64>() / said.len() as f64),
                format!("{:.3}", mean(&free)),
                format!("{:.3}", mean(&hit)),
            ]);
            let place = |collides| {
                let both =
                    poses.iter().zip(&said).filter(move |(pose, _)| pose.in_collision == collides);
                both.map(|(pose, p)| ((1e3 * pose.signed_distance).clamp(-WIDEST, WIDEST), *p))
                    .collect::<Vec<_>>()
            };
            panels.push(Panel {
                title: format!("{name}, {:.0} mm", 1e3 * std),
                x: Axis::linear("signed distance (mm)"),
                y: Axis::unit("probability"),
                series: vec![
                    Series::points("free", place(false)),
                    Series::points("in collision", place(true)),
                ],
            });
        }
    }
    let mut figure = Figure::new("Probability against signed distance", panels);
    figure.columns = 3;
    figure.panel_size = (360, 280);
    let text = format!(
        "The piano in the room, {points} points each, {} poses. A false alarm is a free pose at ½ or \
         above, a miss a collision below it. Distances are of the exact meshes, in overlap minus the \
         penetration depth.",
        poses.len()
    );
    let shows = "Probability against signed distance at two noise levels in three modes";
    Ok(Section::new("Figure 4: the piano").text(text).text(table).figure(
        "paper-distances",
        shows,
        figure,
    ))
}

fn by_default(
    clouds: &[cloudtouch_geom::PointCloud],
    std: f64,
    places: &[Pose],
) -> Result<Vec<f64>> {
    let by = CloudSettings::new(SensorModel::Isotropic { std });
    let [a, b] = [0, 1].map(|body| Cloud::prepare(&clouds[body], &by));
    probabilities(Query::new(QuerySettings::default())?.run_batch(&a?, &b?, places))
}

fn probabilities(
    reports: impl IntoIterator<Item = Result<Report, cloudtouch::QueryError>>,
) -> Result<Vec<f64>> {
    reports.into_iter().map(|report| Ok(report?.collision_probability)).collect()
}
