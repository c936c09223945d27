//! The times of section 6.2: a query in each mode, an exact checker, and a surface reconstructed.

use std::time::Instant;

use anyhow::{Context, Result};
use cloudtouch::{
    Cloud, CloudSettings, PaperCloud, PaperQuery, Query, QuerySettings, noise::SensorModel,
};
use cloudtouch_geom::{PointCloud, Pose, seed::derive};
use cloudtouch_testkit::{exact::ExactMesh, poses::poses_near_contact, scene};

use super::clouds::{PATHS, SEED, by_paper, sampled};
use crate::{
    answers::Pair,
    methods::{Draw, ExactMeshes, Method as _, observed},
    page::Section,
    statistics::quantile,
    table::Table,
};

const STD: f64 = 0.002;
/// Edges that leave about ten thousand triangles of the room and of the piano, m.
const EDGES: [f64; 2] = [0.42, 0.13];
const TEXT: &str = "The piano in the room, one query at a time, each pose asked once, the first included: what a \
cloud computes lazily is in it. Preparation is done once. The exact checker (parry3d) is given the \
meshes that the clouds were drawn from, which no sensor knows. Reconstruction is screened Poisson \
(`poisson_reconstruction`, octree of depth 5, cells of 1/32 of the room; built with `--features reconstruction`) of the room's cloud, given the true normals, on all cores; it comes \
before any exact query of what was scanned. The last row is what the paper says of its machine of 2011.";

pub(super) fn section(points: usize, poses: usize) -> Result<Section> {
    let meshes = [scene::room(), scene::piano()];
    let exact = meshes.each_ref().map(ExactMesh::new);
    let poses: Vec<Pose> = poses_near_contact(&exact[0], &exact[1], poses, derive(SEED, 5, 0))
        .iter()
        .map(|pose| pose.scene_from_object)
        .collect();
    let clouds: Vec<PointCloud> =
        (0..2).map(|body| sampled(&meshes[body], points, STD, 30 + body as u64)).collect();
    let mut table =
        Table::new(["method", "prepare (ms)", "median (ms)", "p95 (ms)", "longest (ms)"]);

    let by = CloudSettings::new(SensorModel::Isotropic { std: STD });
    let start = Instant::now();
    let [a, b] = [0, 1].map(|body| Cloud::prepare(&clouds[body], &by));
    let (a, b, prepare) = (a?, b?, start.elapsed().as_secs_f64());
    let query = Query::new(QuerySettings::default())?;
    row(&mut table, "default", prepare, &poses, |pose| {
        query.run(&a, &b, pose)?;
        Ok(())
    })?;

    for (name, settings, model) in PATHS {
        let by = by_paper(STD, model());
        let start = Instant::now();
        let [a, b] = [0, 1].map(|body| PaperCloud::prepare(&clouds[body], &by));
        let (a, b, prepare) = (a?, b?, start.elapsed().as_secs_f64());
        let query = PaperQuery::new(settings())?;
        row(&mut table, name, prepare, &poses, |pose| {
            query.run(&a, &b, pose)?;
            Ok(())
        })?;
    }

    let fine = [0, 1].map(|body| scene::subdivide_to_max_edge(&meshes[body], EDGES[body]));
    let [room, piano] = [0, 1].map(|body| observed(clouds[body].clone(), STD));
    let draw = Draw { family: "", a: &room, b: &piano, mesh: &meshes[1] };
    let start = Instant::now();
    let ask = ExactMeshes(fine).prepare(&draw)?;
    let prepare = start.elapsed().as_secs_f64();
    row(&mut table, "parry3d, exact meshes", prepare, &poses, |pose| {
        ask(Pair::CloudCloud, pose)?.context("an answer")?;
        Ok(())
    })?;

    let seconds = reconstruction(points).map_or("not built".into(), |s| format!("{:.0}", 1e3 * s));
    table.row(["reconstruction", &seconds, "–", "–", "–"]);
    table.row(["the paper's; PQP; reconstruction", "> 10 000", "500–1000; 50–100", "–", "–"]);
    Ok(Section::new("Section 6.2: times").text(TEXT).text(table))
}

/// Times every pose and adds a row.
fn row(
    table: &mut Table,
    name: &str,
    prepare: f64,
    poses: &[Pose],
    mut ask: impl FnMut(&Pose) -> Result<()>,
) -> Result<()> {
    let mut milliseconds = Vec::new();
    for pose in poses {
        let start = Instant::now();
        ask(pose)?;
        milliseconds.push(1e3 * start.elapsed().as_secs_f64());
    }
    let of = |share| format!("{:.2}", quantile(&milliseconds, share));
    let prepare = format!("{:.0}", 1e3 * prepare);
    table.row([name.to_owned(), prepare, of(0.5), of(0.95), of(1.0)]);
    Ok(())
}

/// Seconds that the surface of the room takes from its points; `None` without the library.
#[cfg(feature = "reconstruction")]
fn reconstruction(points: usize) -> Option<f64> {
    /// Of the octree: cells of 1/32 of the scene, coarser than the samples. At depth 7 it takes many
    /// minutes.
    const DEPTH: usize = 5;
    use cloudtouch_testkit::surface::sample_surface;
    use poisson_reconstruction::PoissonReconstruction;

    let samples = sample_surface(&scene::room(), points, derive(SEED, 1, 30));
    let cloud = sampled(&scene::room(), points, STD, 30);
    // Its nalgebra is another version: only arrays go across.
    let places: Vec<_> = cloud.points.iter().map(|p| [p.x, p.y, p.z].into()).collect();
    let normals: Vec<_> =
        samples.iter().map(|s| [s.normal.x, s.normal.y, s.normal.z].into()).collect();
    let start = Instant::now();
    let surface =
        PoissonReconstruction::from_points_and_normals(&places, &normals, 0.0, DEPTH, DEPTH, 10);
    std::hint::black_box(surface.reconstruct_mesh_buffers());
    Some(start.elapsed().as_secs_f64())
}

#[cfg(not(feature = "reconstruction"))]
fn reconstruction(_points: usize) -> Option<f64> {
    None
}
