//! What each method says of every pose under every noise that is added.

use anyhow::{Context, Result};
use cloudtouch_geom::{PointCloud, Pose, TriangleMesh};
use cloudtouch_testkit::{exact::ExactMesh, family::Observation};
use rayon::prelude::*;

use super::scan::Scan;
use crate::{
    answers::Pair,
    methods::{Boxes, Distance, Draw, Method, Ours, Paper, Prepared},
};

/// Standard deviation of the noise that the scan itself is said to have, m.
pub(super) const OWN_STD: f64 = 0.005;
/// Standard deviations of the noise that is added, mm.
pub(super) const ADDED: [f64; 9] = [0.0, 1.0, 2.0, 3.0, 5.0, 7.5, 10.0, 15.0, 20.0];

/// The methods, in the order of the answers; the first two say a probability.
pub(super) const METHODS: [&str; 5] =
    ["calibrated", "paper", "1 cm boxes", "points inside the mesh", "mesh of the scan"];

/// The answers of all methods: a probability, or 0 and 1 of a yes-or-no method.
pub(super) struct Answers {
    /// By noise, draw, pose and method.
    said: Vec<Vec<Vec<Vec<f64>>>>,
}

impl Answers {
    /// Asks all methods about all poses, `draws` times for each noise.
    pub(super) fn ask(
        scan: &Scan,
        object: &TriangleMesh,
        poses: &[Pose],
        draws: u64,
    ) -> Result<Self> {
        let of_noise = |added: f64| -> Result<Vec<_>> {
            let of_draw = |draw: u64| {
                answers(scan, added * 1e-3, draw, object, poses)
                    .with_context(|| format!("{added} mm of noise, draw {draw}"))
            };
            let said = (0..draws).into_par_iter().map(of_draw).collect();
            eprintln!("growth: {added} mm done");
            said
        };
        Ok(Self { said: ADDED.into_iter().map(of_noise).collect::<Result<_>>()? })
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
    added: f64,
    draw: u64,
    object: &TriangleMesh,
    poses: &[Pose],
) -> Result<Vec<Vec<f64>>> {
    let noisy = scan.with_noise(added, draw);
    let surface = ExactMesh::new(&scan.mesh(&noisy)?);
    let exact = ExactMesh::new(object);
    let observed = |cloud, std| Observation { cloud, truth: Vec::new(), std };
    // Whoever adds noise tells the sensor model.
    let a = observed(noisy, OWN_STD.hypot(added));
    // Asked as a mesh; a cloud of it has to be there nevertheless.
    let b = observed(PointCloud::from_points(object.vertices().to_vec()), 0.0);
    let draw = Draw { family: "real scan", a: &a, b: &b, mesh: object };
    let calibrated = Ours::new(METHODS[0])?;
    let paper = Paper::new(METHODS[1]);
    let (boxes, inside) = (Boxes { side: 0.01 }, Distance { smoothed: false });
    let methods: [&dyn Method; 4] = [&calibrated, &paper, &boxes, &inside];
    let prepared: Vec<Box<dyn Prepared>> =
        methods.into_iter().map(|method| method.prepare(&draw)).collect::<Result<_>>()?;
    let all = |pose: &Pose| -> Result<Vec<f64>> {
        let said = |method: &dyn Prepared| -> Result<f64> {
            let said = method.ask(Pair::CloudMesh, pose)?.context("no answer about a mesh")?;
            // A score above 0: a box that touches, a point inside.
            Ok(said.probability.unwrap_or(f64::from(u8::from(said.score > 0.0))))
        };
        let mut said =
            prepared.iter().map(|method| said(method.as_ref())).collect::<Result<Vec<f64>>>()?;
        said.push(f64::from(u8::from(surface.intersects(&exact, pose))));
        Ok(said)
    };
    poses.iter().map(all).collect()
}
