//! What each method says of every pose under every noise that is added.

use anyhow::{Context, Result};
use cloudtouch_geom::{PointCloud, Pose, TriangleMesh, seed};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use rayon::prelude::*;

use crate::{
    answers::Pair,
    methods::{Boxes, Distance, Draw, Method, Ours, Paper, Prepared, observed},
};

/// All randomness of the noise comes from this.
pub(super) const SEED: u64 = 2011;
/// Standard deviation of the noise that the scan itself is said to have, m.
pub(super) const OWN_STD: f64 = 0.005;
/// Standard deviations of the noise that is added, mm.
pub(super) const ADDED: [f64; 4] = [0.0, 5.0, 10.0, 20.0];

/// The methods, in the order of the answers; the first two say a probability.
pub(super) const METHODS: [&str; 4] =
    ["calibrated", "paper", "1 cm boxes", "points inside the mesh"];

/// The answers of all methods to all poses: a probability, or 0 and 1 of a yes-or-no method.
type OfDraw = Vec<[f64; METHODS.len()]>;

/// By noise and draw.
pub(super) struct Answers(Vec<Vec<OfDraw>>);

impl Answers {
    /// Asks all methods about all poses, `draws` times for each noise.
    pub(super) fn ask(
        scan: &PointCloud,
        object: &TriangleMesh,
        poses: &[Pose],
        draws: u64,
    ) -> Result<Self> {
        let of_noise = |added: f64| -> Result<Vec<OfDraw>> {
            let of_draw = |draw| of_draw(scan, 1e-3 * added, draw, object, poses);
            let said = (0..draws).into_par_iter().map(of_draw).collect();
            eprintln!("growth: {added} mm done");
            said
        };
        Ok(Self(ADDED.into_iter().map(of_noise).collect::<Result<_>>()?))
    }

    /// The answers of a method to a pose under one noise, by draw.
    pub(super) fn of(&self, method: usize, pose: usize, level: usize) -> Vec<f64> {
        self.0[level].iter().map(|poses| poses[pose][method]).collect()
    }
}

fn of_draw(
    scan: &PointCloud,
    added: f64,
    draw: u64,
    object: &TriangleMesh,
    poses: &[Pose],
) -> Result<OfDraw> {
    // Those of one draw differ in nothing but their size.
    let points = add_noise(&scan.points, NoiseKind::Gaussian, added, seed::derive(SEED, 5, draw));
    // Whoever adds noise tells the sensor model.
    let a = observed(PointCloud { points, ..scan.clone() }, OWN_STD.hypot(added));
    // Asked as a mesh; a cloud of it has to be there nevertheless.
    let b = observed(PointCloud::from_points(object.vertices().to_vec()), 0.0);
    let draw = Draw { family: "real scan", a: &a, b: &b, mesh: object };
    let methods: [&dyn Method; METHODS.len()] = [
        &Ours::new(METHODS[0])?,
        &Paper::new(METHODS[1]),
        &Boxes { side: 0.01 },
        &Distance { smoothed: false },
    ];
    let prepared: Vec<Prepared> =
        methods.into_iter().map(|method| method.prepare(&draw)).collect::<Result<_>>()?;
    let all = |pose: &Pose| {
        let mut all = [0.0; METHODS.len()];
        for (said, method) in all.iter_mut().zip(&prepared) {
            let answer = method(Pair::CloudMesh, pose)?.context("no answer about a mesh")?;
            // A score above 0: a box that touches, a point inside.
            *said = answer.probability.unwrap_or(f64::from(u8::from(answer.score > 0.0)));
        }
        Ok(all)
    };
    poses.iter().map(all).collect()
}
