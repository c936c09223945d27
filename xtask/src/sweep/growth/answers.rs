//! What each method says of every pose under every noise that is added.

use anyhow::{Context, Result};
use cloudtouch::{Cloud, CloudSettings, Mesh, Mode, Query, QuerySettings, noise::SensorModel};
use cloudtouch_geom::{Point3, PointCloud, Pose, TriangleMesh};
use cloudtouch_testkit::exact::ExactMesh;
use rayon::prelude::*;

use super::scan::{Scan, returns};
use crate::sweep::rivals::{BoxMap, ObjectMesh, Observed};

/// Standard deviation of the noise that the scan itself is said to have, m.
pub(super) const OWN_STD: f64 = 0.005;
/// Standard deviations of the noise that is added, m.
pub(super) const ADDED: [f64; 9] = [0.0, 0.001, 0.002, 0.003, 0.005, 0.0075, 0.01, 0.015, 0.02];
/// Side of the boxes of a collision map, m.
const BOX: f64 = 0.01;

/// The methods, in the order of the answers.
pub(super) const METHODS: [&str; 5] =
    ["calibrated", "paper", "1 cm boxes", "points inside the mesh", "mesh of the scan"];

/// The answers of all methods: a probability, or 0 and 1 of a yes-or-no method.
pub(super) struct Table {
    /// By standard deviation, draw, pose and method.
    said: Vec<Vec<Vec<[f64; METHODS.len()]>>>,
}

/// The object in every form that a method wants.
struct Object {
    mesh: Mesh,
    boxes: ObjectMesh,
    exact: ExactMesh,
}

impl Table {
    /// Asks all methods about all poses, `draws` times for each noise.
    pub(super) fn ask(
        scan: &Scan,
        object: &TriangleMesh,
        poses: &[Pose],
        draws: u64,
    ) -> Result<Self> {
        let object = Object {
            mesh: Mesh::prepare(object)?,
            boxes: ObjectMesh::try_new(object)?,
            exact: ExactMesh::new(object),
        };
        let of_draw = |std: f64, draw: u64| {
            answers(scan, &scan.with_noise(std, draw), std, &object, poses)
                .with_context(|| format!("{} mm of noise, draw {draw}", 1e3 * std))
        };
        let of_std = |std: f64| -> Result<Vec<_>> {
            let said = (0..draws).into_par_iter().map(|draw| of_draw(std, draw)).collect();
            eprintln!("growth: {} mm done", 1e3 * std);
            said
        };
        Ok(Self { said: ADDED.into_iter().map(of_std).collect::<Result<_>>()? })
    }

    /// The answers of a method to a pose under one noise, by draw.
    pub(super) fn of(&self, method: usize, pose: usize, level: usize) -> Vec<f64> {
        self.said[level].iter().map(|poses| poses[pose][method]).collect()
    }

    /// The same as verdicts.
    pub(super) fn verdicts(&self, method: usize, pose: usize, level: usize) -> Vec<bool> {
        self.of(method, pose, level).iter().map(|p| *p >= 0.5).collect()
    }
}

fn answers(
    scan: &Scan,
    noisy: &PointCloud,
    std: f64,
    object: &Object,
    poses: &[Pose],
) -> Result<Vec<[f64; METHODS.len()]>> {
    // Whoever adds noise tells the sensor model.
    let total = OWN_STD.hypot(std);
    let sensor = SensorModel::Isotropic { std: total };
    let asked = |mode| -> Result<_> {
        let cloud = Cloud::prepare(noisy, &CloudSettings::new(sensor, mode))?;
        Ok((cloud, Query::new(QuerySettings::new(mode))?))
    };
    let ours = [asked(Mode::Calibrated)?, asked(Mode::Paper)?];
    let points = returns(noisy);
    let (boxes, surface) = (BoxMap::try_new(BOX)?, ExactMesh::new(&scan.mesh(noisy)?));
    let all = |pose: &Pose| -> Result<[f64; METHODS.len()]> {
        let probability = |(cloud, query): &(Cloud, Query)| -> Result<f64> {
            Ok(query.run(cloud, &object.mesh, pose)?.collision_probability)
        };
        // The points of the object are not used against its mesh.
        let anything = [Point3::origin()];
        let observed = Observed::try_new(&points, &anything, pose, total)?;
        let in_box = boxes.against_mesh(&observed, &object.boxes).probability;
        Ok([
            probability(&ours[0])?,
            probability(&ours[1])?,
            in_box.context("boxes say yes or no")?,
            yes(any_inside(&points, object, pose)),
            yes(surface.intersects(&object.exact, pose)),
        ])
    };
    poses.iter().map(all).collect()
}

fn yes(verdict: bool) -> f64 {
    f64::from(u8::from(verdict))
}

/// Whether a measured point is in the object: its smallest signed distance is negative.
fn any_inside(points: &[Point3], object: &Object, pose: &Pose) -> bool {
    let object_from_scan = pose.inverse();
    let Some((low, high)) = object.exact.mesh().bounding_box() else { return false };
    points.iter().map(|p| object_from_scan.transform_point(p)).any(|p| {
        (0..3).all(|k| low[k] <= p[k] && p[k] <= high[k]) && object.mesh.signed_distance(&p) < 0.0
    })
}
