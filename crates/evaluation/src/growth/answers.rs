//! What each method says of every pose under every noise that is added.

use std::collections::BTreeSet;

use anyhow::{Context, Result};
use cloudtouch::{Cloud, CloudSettings, Mesh, Mode, Query, QuerySettings, noise::SensorModel};
use cloudtouch_geom::{Point3, PointCloud, Pose, TriangleMesh};
use cloudtouch_testkit::exact::ExactMesh;
use rayon::prelude::*;

use super::scan::{Scan, returns};

/// Standard deviation of the noise that the scan itself is said to have, m.
pub(super) const OWN_STD: f64 = 0.005;
/// Standard deviations of the noise that is added, m.
pub(super) const ADDED: [f64; 9] = [0.0, 0.001, 0.002, 0.003, 0.005, 0.0075, 0.01, 0.015, 0.02];
/// Side of the boxes of a collision map, m.
const BOX: f64 = 0.01;

/// The methods, in the order of the answers; the first two say a probability.
pub(super) const METHODS: [&str; 5] =
    ["calibrated", "paper", "1 cm boxes", "points inside the mesh", "mesh of the scan"];

/// The answers of all methods: a probability, or 0 and 1 of a yes-or-no method.
pub(super) struct Answers {
    /// By standard deviation, draw, pose and method.
    said: Vec<Vec<Vec<[f64; METHODS.len()]>>>,
}

impl Answers {
    /// Asks all methods about all poses, `draws` times for each noise.
    pub(super) fn ask(
        scan: &Scan,
        object: &TriangleMesh,
        poses: &[Pose],
        draws: u64,
        seed: u64,
    ) -> Result<Self> {
        let object = (Mesh::prepare(object)?, ExactMesh::new(object));
        let of_draw = |std: f64, draw: u64| {
            answers(scan, &scan.with_noise(std, draw, seed), std, &object, poses)
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
    (mesh, exact): &(Mesh, ExactMesh),
    poses: &[Pose],
) -> Result<Vec<[f64; METHODS.len()]>> {
    // Whoever adds noise tells the sensor model.
    let sensor = SensorModel::Isotropic { std: OWN_STD.hypot(std) };
    let prepare = |mode| -> Result<_> {
        let cloud = Cloud::prepare(noisy, &CloudSettings::new(sensor, mode))?;
        Ok((cloud, Query::new(QuerySettings::new(mode))?))
    };
    let ours = [prepare(Mode::Calibrated)?, prepare(Mode::Paper)?];
    let points = returns(noisy);
    let boxes = ExactMesh::new(&boxes(&points)?);
    let surface = ExactMesh::new(&scan.mesh(noisy)?);
    let all = |pose: &Pose| -> Result<[f64; METHODS.len()]> {
        let probability = |(cloud, query): &(Cloud, Query)| -> Result<f64> {
            Ok(query.run(cloud, mesh, pose)?.collision_probability)
        };
        let [calibrated, paper] = [probability(&ours[0])?, probability(&ours[1])?];
        let verdicts = [
            boxes.intersects(exact, pose),
            any_inside(&points, mesh, exact, pose),
            surface.intersects(exact, pose),
        ];
        let [touched, inside, crossed] = verdicts.map(|verdict| f64::from(u8::from(verdict)));
        Ok([calibrated, paper, touched, inside, crossed])
    };
    poses.iter().map(all).collect()
}

/// The surfaces of the boxes of a grid that have a point in them.
fn boxes(points: &[Point3]) -> Result<TriangleMesh> {
    let cells: BTreeSet<[i64; 3]> =
        points.iter().map(|p| [0, 1, 2].map(|k| (p[k] / BOX).floor() as i64)).collect();
    // A corner's bits say on which side of each axis it is.
    let corner = |cell: &[i64; 3], bits: usize| {
        Point3::from([0, 1, 2].map(|k| BOX * (cell[k] + (bits >> k & 1) as i64) as f64))
    };
    const SIDES: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let vertices = cells.iter().flat_map(|cell| (0..8).map(move |bits| corner(cell, bits)));
    let triangles = (0..cells.len() as u32).flat_map(|number| {
        SIDES.iter().flat_map(move |side| {
            let [a, b, c, d] = side.map(|corner| 8 * number + corner);
            [[a, b, c], [a, c, d]]
        })
    });
    Ok(TriangleMesh::try_new(vertices.collect(), triangles.collect())?)
}

/// Whether a measured point is in the object: its smallest signed distance is negative.
fn any_inside(points: &[Point3], mesh: &Mesh, exact: &ExactMesh, pose: &Pose) -> bool {
    let object_from_scan = pose.inverse();
    let Some((low, high)) = exact.mesh().bounding_box() else { return false };
    points
        .iter()
        .map(|p| object_from_scan.transform_point(p))
        .any(|p| low <= p && p <= high && mesh.signed_distance(&p) < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_are_closed_and_as_many_as_hold_a_point() {
        let points = [Point3::new(0.001, 0.0, 0.0), Point3::new(0.009, 0.0, 0.0)];
        let mesh = boxes(&[points[0], points[1], Point3::new(-0.001, 0.05, 0.0)]).unwrap();
        assert_eq!((mesh.triangles().len(), mesh.open_edges()), (24, 0));
        let (low, high) = mesh.bounding_box().unwrap();
        assert_eq!((low, high), (Point3::new(-0.01, 0.0, 0.0), Point3::new(0.01, 0.06, 0.01)));
    }
}
