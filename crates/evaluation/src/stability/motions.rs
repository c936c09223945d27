//! What must not change an answer: moving, scaling, turning, swapping, permuting.

use anyhow::Result;
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings, Report};
use cloudtouch_geom::{PointCloud, Pose, UncertainPoint, Vector3, seed};
use rayon::prelude::*;

use crate::leaf::{Leaf, SHAPES};
use crate::report::table::small;
use crate::report::{Findings, Section, Table, Target};

/// All randomness of the run comes from this.
pub(super) const SEED: u64 = 2011;
/// The tightest relative gap that is promised anything for; pairs that count are solved to a
/// hundredth of it.
const TIGHTEST: f64 = 1e-8;
/// Points of a cloud.
const POINTS: usize = 400;
/// Side of the plane, and standard deviations along the axes, m.
const SIDE: f64 = 0.3;
const STD: Vector3 = Vector3::new(0.0008, 0.002, 0.004);
/// From overlap to clear, mm.
const GAPS: [f64; 9] = [-30.0, -12.0, -6.0, -3.0, 0.0, 3.0, 6.0, 12.0, 30.0];

/// Two clouds in one frame.
type Clouds = [Vec<UncertainPoint>; 2];
/// A change that must not change a probability.
type Motion = fn(&Clouds) -> Clouds;

/// The motions by name.
const MOTIONS: [(&str, Motion); 7] = [
    ("moved by 1e3 m", |clouds| placed(clouds, &far(1e3), 1.0)),
    ("moved by 1e6 m", |clouds| placed(clouds, &far(1e6), 1.0)),
    ("scaled by 1e-6", |clouds| placed(clouds, &Pose::identity(), 1e-6)),
    ("scaled by 1e6", |clouds| placed(clouds, &Pose::identity(), 1e6)),
    ("turned", |clouds| {
        placed(clouds, &Pose::from_translation_rpy(Vector3::zeros(), [0.4, -0.7, 1.9]), 1.0)
    }),
    ("swapped", |[a, b]| [b.clone(), a.clone()]),
    ("permuted", |clouds| clouds.each_ref().map(|cloud| shuffled(cloud))),
];

/// Asks about every pair and motion at both tolerances.
pub(super) fn measure() -> Findings {
    let default = QuerySettings::default().relative_gap;
    let mut pairs = Vec::new();
    for shape in 0..SHAPES.len() {
        for gap in GAPS {
            let leaf = Leaf { shape, gap: 1e-3 * gap / SIDE, std: STD / SIDE };
            let clouds = leaf.clouds(POINTS, seed::derive(SEED, shape as u64, 0));
            pairs.push(placed(&clouds, &Pose::identity(), SIDE));
        }
    }
    let ask_all = |motion: Motion| -> Result<Vec<[Report; 2]>> {
        pairs.par_iter().map(|pair| ask(&motion(pair), [default, TIGHTEST])).collect()
    };
    let still = ask_all(Clouds::clone)?;
    let mut table = Table::new(["motion", "default tolerance", "tightest tolerance"]);
    let mut worst = [0.0_f64; 2];
    for (name, motion) in MOTIONS {
        let mut most = [0.0_f64; 2];
        for (before, after) in still.iter().zip(ask_all(motion)?) {
            for k in 0..2 {
                let change = before[k].collision_probability - after[k].collision_probability;
                // What is no number has changed beyond all bounds.
                let change = if change.is_nan() { f64::INFINITY } else { change.abs() };
                most[k] = most[k].max(change);
            }
        }
        worst = [0, 1].map(|k| worst[k].max(most[k]));
        table.row([name.to_owned(), small(most[0]), small(most[1])]);
    }
    let between = still.iter().filter(|r| (0.01..0.99).contains(&r[0].collision_probability));
    let section = Section::new("Motions that must change nothing").text(format_args!(
        "Largest change of the collision probability over {} pairs of clouds ({} of them with a \
         probability between 1 % and 99 %): a {} over a plane, from overlap to clear, with \
         lopsided noise. The tolerances are relative gaps of {default:.0e} and {TIGHTEST:.0e}.",
        pairs.len(),
        between.count(),
        SHAPES.join(", "),
    ));
    let target = |(tolerance, allowed): (f64, f64), change: f64| {
        let what = format!("motions: at {tolerance:.0e} P changes by at most {allowed:.0e}");
        Target::new(what, small(change), change <= allowed)
    };
    let targets = [(default, 1e-3), (TIGHTEST, 1e-6)].into_iter().zip(worst);
    Ok((section.text(table), targets.map(|(limit, change)| target(limit, change)).collect()))
}

/// Scaled, then moved and turned, covariances along.
fn placed(clouds: &Clouds, pose: &Pose, scale: f64) -> Clouds {
    let place = |p: &UncertainPoint| UncertainPoint {
        mean: pose.transform_point(&(p.mean * scale)),
        covariance: p.covariance.scaled(scale).rotated(pose.rotation()),
    };
    clouds.each_ref().map(|cloud| cloud.iter().map(place).collect())
}

fn far(distance: f64) -> Pose {
    Pose::from_translation(Vector3::new(0.8, -0.6, 0.1) * distance)
}

fn shuffled(cloud: &[UncertainPoint]) -> Vec<UncertainPoint> {
    let mut order: Vec<usize> = (0..cloud.len()).collect();
    order.sort_by_key(|&i| seed::derive(SEED, 5, i as u64));
    order.iter().map(|&i| cloud[i]).collect()
}

fn ask(pair: &Clouds, tolerances: [f64; 2]) -> Result<[Report; 2]> {
    let prepare = |points: &Vec<UncertainPoint>| {
        let covariances = Some(points.iter().map(|p| p.covariance).collect());
        let points = PointCloud::from_points(points.iter().map(|p| p.mean).collect());
        let settings = CloudSettings::new(SensorModel::PerPoint);
        Cloud::prepare(&PointCloud { covariances, ..points }, &settings)
    };
    let [a, b] = pair.each_ref().map(prepare);
    let (a, b) = (a?, b?);
    let ask = |relative_gap| -> Result<Report> {
        let settings = QuerySettings { relative_gap, ..QuerySettings::default() };
        Ok(Query::new(settings)?.run(&a, &b, &Pose::identity())?)
    };
    Ok([ask(tolerances[0])?, ask(tolerances[1])?])
}
