//! What must not change an answer: moving, scaling, turning, swapping, permuting.

use anyhow::Result;
use cloudtouch::{Cloud, CloudSettings, Mode, Query, QuerySettings, Report, noise::SensorModel};
use cloudtouch_geom::{Covariance, Point3, PointCloud, Pose, Vector3, seed};
use cloudtouch_testkit::{
    noise::{NoiseKind, add_noise},
    scene, surface,
};
use rayon::prelude::*;

use super::sheet::{SEED, Sheet, small};
use crate::{page::Section, table::Table};

/// The tightest relative gap that is promised anything for; pairs that count are solved to a
/// hundredth of it.
const TIGHTEST: f64 = 1e-8;
/// Standard deviations along x, y and z, m: unequal, so that turning points alone would show.
const STDS: [f64; 3] = [0.004, 0.002, 0.002];

/// Two clouds in one frame with the same covariance at every point.
#[derive(Clone)]
struct Pair {
    a: Vec<Point3>,
    b: Vec<Point3>,
    covariance: Covariance,
}

/// A change of a pair that must not change its probability.
type Motion = fn(&Pair) -> Pair;

/// The motions by name.
const MOTIONS: [(&str, Motion); 7] = [
    ("moved by 1e3 m", |pair| pair.placed(&far(1e3), 1.0)),
    ("moved by 1e6 m", |pair| pair.placed(&far(1e6), 1.0)),
    ("scaled by 1e-6", |pair| pair.placed(&Pose::identity(), 1e-6)),
    ("scaled by 1e6", |pair| pair.placed(&Pose::identity(), 1e6)),
    ("turned", |pair| {
        pair.placed(&Pose::from_translation_rpy(Vector3::zeros(), [0.4, -0.7, 1.9]), 1.0)
    }),
    ("swapped", |pair| Pair { a: pair.b.clone(), b: pair.a.clone(), ..pair.clone() }),
    ("permuted", Pair::permuted),
];

/// Asks about every pair and motion at both tolerances and adds the section.
pub(super) fn run(sheet: &mut Sheet) -> Result<()> {
    let default = QuerySettings::default().relative_gap;
    let tolerances = [(default, 1e-3), (TIGHTEST, 1e-6)];
    let pairs = pairs();
    let mut table =
        Table::new(["motion", "default tolerance", "tightest tolerance", "verdicts changed"]);
    let mut worst = [0.0_f64; 2];
    let mut where_worst = [String::new(), String::new()];
    let still: Vec<[Report; 2]> =
        pairs.par_iter().map(|(_, pair)| ask_all(pair, tolerances)).collect::<Result<_>>()?;
    for (motion, act) in MOTIONS {
        let moved: Vec<[Report; 2]> = pairs
            .par_iter()
            .map(|(_, pair)| ask_all(&act(pair), tolerances))
            .collect::<Result<_>>()?;
        let mut most = [0.0_f64; 2];
        let mut changed = 0;
        for (((name, _), before), after) in pairs.iter().zip(&still).zip(&moved) {
            for k in 0..2 {
                let change =
                    (before[k].collision_probability - after[k].collision_probability).abs();
                most[k] = most[k].max(change);
                if change > worst[k] {
                    worst[k] = change;
                    where_worst[k] = format!("{name}, {motion}");
                }
                changed += usize::from(before[k].verdict != after[k].verdict);
            }
        }
        table.row([motion.into(), small(most[0]), small(most[1]), changed.to_string()]);
    }
    let between = still.iter().filter(|r| (0.01..0.99).contains(&r[0].collision_probability));
    let text = format!(
        "Largest change of the collision probability over {} pairs of clouds ({} of them with a \
         probability between 1 % and 99 %): a ball, a wedge and a slanted sheet over a floor, from \
         overlap to clear, with lopsided noise. The tolerances are relative gaps of {default:.0e} \
         and {TIGHTEST:.0e}.",
        pairs.len(),
        between.count(),
    );
    let section = Section::new("Motions that must change nothing").text(text).text(table);
    sheet.sections.push(section);
    for (k, (tolerance, allowed)) in tolerances.into_iter().enumerate() {
        sheet.goal(
            format!(
                "motions: at {tolerance:.0e} the probability changes by less than {allowed:.0e}"
            ),
            if worst[k] > 0.0 {
                format!("{} ({})", small(worst[k]), where_worst[k])
            } else {
                "0".into()
            },
            worst[k] < allowed,
        );
    }
    Ok(())
}

fn far(distance: f64) -> Pose {
    Pose::from_translation(Vector3::new(0.8, -0.6, 0.1) * distance)
}

fn ask_all(pair: &Pair, tolerances: [(f64, f64); 2]) -> Result<[Report; 2]> {
    let prepare = |points: &[Point3]| {
        let covariances = Some(vec![pair.covariance; points.len()]);
        let cloud = PointCloud { covariances, ..PointCloud::from_points(points.to_vec()) };
        Cloud::prepare(&cloud, &CloudSettings::new(SensorModel::PerPoint, Mode::Calibrated))
    };
    let (a, b) = (prepare(&pair.a)?, prepare(&pair.b)?);
    let ask = |relative_gap| -> Result<Report> {
        let settings = QuerySettings { relative_gap, ..QuerySettings::default() };
        Ok(Query::new(settings)?.run(&a, &b, &Pose::identity())?)
    };
    Ok([ask(tolerances[0].0)?, ask(tolerances[1].0)?])
}

/// Named pairs from overlap to clear.
fn pairs() -> Vec<(String, Pair)> {
    let lopsided = Covariance::diagonal(STDS.map(|std| std * std));
    let measured = |mesh: &cloudtouch_geom::TriangleMesh, spacing: f64, stream: u64| {
        let fine = scene::subdivide_to_max_edge(mesh, spacing);
        let count = (surface::area(mesh) / (spacing * spacing)).round() as usize;
        let exact = surface::positions(&surface::sample_surface(
            &fine,
            count,
            seed::derive(SEED, stream, 0),
        ));
        let noisy = add_noise(&exact, NoiseKind::Gaussian, 1.0, seed::derive(SEED, stream, 1));
        let stds = Vector3::from(STDS);
        let points = exact.iter().zip(noisy).map(|(e, n)| e + (n - e).component_mul(&stds));
        points.collect::<Vec<Point3>>()
    };
    let floor = measured(&scene::plane_patch(0.3), 0.015, 1);
    let ball = measured(&scene::sphere(0.08, 3), 0.012, 2);
    let wedge = measured(&scene::wedge(0.15, 0.1, 0.15), 0.012, 3);
    let sheet = measured(&scene::plane_patch(0.2), 0.013, 4);
    // The lowest point of each comes to the height that is asked for.
    let tilt = Pose::from_translation_rpy(Vector3::new(0.02, 0.01, 0.0), [0.1, 0.5, 0.2]);
    let moved = |points: &[Point3], pose: &Pose, height: f64| {
        let turned: Vec<Point3> = points.iter().map(|p| pose.transform_point(p)).collect();
        let lowest = turned.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
        turned.iter().map(|p| p + Vector3::z() * (height - lowest)).collect::<Vec<_>>()
    };
    let mut pairs = Vec::new();
    for (name, points) in [("ball", ball), ("wedge", wedge), ("sheet", sheet)] {
        for height in [-0.03, -0.012, -0.006, -0.003, 0.0, 0.003, 0.006, 0.012, 0.03] {
            let pair =
                Pair { a: floor.clone(), b: moved(&points, &tilt, height), covariance: lopsided };
            pairs.push((format!("{name} at {:.0} mm", 1e3 * height), pair));
        }
    }
    pairs
}

impl Pair {
    /// Scaled, then moved and turned, covariances along.
    fn placed(&self, pose: &Pose, scale: f64) -> Self {
        let place = |points: &[Point3]| {
            points.iter().map(|p| pose.transform_point(&(p * scale))).collect::<Vec<_>>()
        };
        let covariance = self.covariance.scaled(scale).rotated(pose.rotation());
        Self { a: place(&self.a), b: place(&self.b), covariance }
    }

    fn permuted(&self) -> Self {
        let shuffled = |points: &[Point3], stream: u64| {
            let mut order: Vec<usize> = (0..points.len()).collect();
            order.sort_by_key(|&i| seed::derive(SEED, stream, i as u64));
            order.iter().map(|&i| points[i]).collect()
        };
        Self { a: shuffled(&self.a, 5), b: shuffled(&self.b, 6), ..self.clone() }
    }
}
