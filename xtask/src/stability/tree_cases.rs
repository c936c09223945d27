//! The catalogue through the hierarchy, beside all pairs of points.

use std::time::Instant;

use anyhow::{Context, Result};
use cloudtouch::bvh::{Flow, Outcome, Primitive, TraversalSettings, Tree, TreeSettings, traverse};
use cloudtouch_geom::{Covariance, Matrix3, Point3, Pose, UncertainPoint, normal};
use cloudtouch_testkit::hard_cases::{HardCase, hard_cases};

use super::sheet::{Sheet, milliseconds, small};
use crate::common::table::Table;

/// All pairs of points are tried up to so many.
const MOST_PAIRS: usize = 4_000_000;

/// What the section says before its table.
const INTRODUCTION: &str = "Trees over the whole clouds, certified traversal in the same frame \
without early stop. *Culled* is the bound on the probability of any point in pairs of boxes that \
were left out; a default query allows 1e-6. *All pairs*: the probability that a plane half way \
between two points leaves to the less certain one, at most over all pairs of points; it must not \
exceed the largest one in the leaf pairs visited and the bound. Where noise depends on the direction \
that plane bounds nothing, and where there are more than four million pairs it is not computed.";

struct Row {
    leaves: [usize; 2],
    outcome: Outcome,
    /// Largest probability by brute force, and within the leaf pairs visited.
    flat: Option<[f64; 2]>,
    seconds: f64,
}

/// Traverses everything and adds the section.
pub(super) fn run(sheet: &mut Sheet) -> Result<()> {
    let header = ["case", "leaves", "box pairs", "leaf pairs", "culled", "all pairs", "ms"];
    let mut table = Table::new(&header);
    let (mut compared, mut lost) = (0, 0);
    for case in hard_cases().iter().filter(|case| case.valid) {
        let name = format!("hierarchy, {}", case.name);
        let Some(row) = sheet.guard(&name, || search(case)) else { continue };
        let row = row.with_context(|| name.clone())?;
        if let Some([all, visited]) = row.flat {
            compared += 1;
            // The allowance for rounding is that of the tree's own tests.
            if all > visited.max(row.outcome.culled_bound) * (1.0 + 1e-6) {
                lost += 1;
                sheet.fault(format!("{name}: {all} was culled at {}", row.outcome.culled_bound));
            }
        }
        let allowed = normal::upper_tail(TraversalSettings::default().cull_deviations);
        if row.outcome.culled_bound.is_nan() || row.outcome.culled_bound > allowed {
            sheet.fault(format!("{name}: culled at {}", row.outcome.culled_bound));
        }
        table.row([
            case.name.into(),
            format!("{} and {}", row.leaves[0], row.leaves[1]),
            row.outcome.nodes_visited.to_string(),
            row.outcome.leaf_pairs.to_string(),
            small(row.outcome.culled_bound),
            row.flat.map_or("none".into(), |[all, _]| small(all)),
            milliseconds(row.seconds),
        ]);
    }
    sheet.section("Hard cases: hierarchy", format!("{INTRODUCTION}\n\n{table}"));
    sheet.goal(
        "hard cases: bounds of the hierarchy hold the answer of all pairs",
        format!("{} of {compared}", compared - lost),
        lost == 0,
    );
    Ok(())
}

fn search(case: &HardCase) -> Result<Row> {
    let points_a = points(&case.cloud_a, &case.covariance_a);
    let points_b = points(&case.cloud_b, &case.covariance_b);
    let start = Instant::now();
    let [a, b] = [&points_a, &points_b].map(|points| {
        let primitives = points.iter().map(|&point| Primitive::point(point)).collect();
        Tree::build(primitives, &TreeSettings::default())
    });
    let (a, b) = (a?, b?);
    let mut pairs = Vec::new();
    let settings = TraversalSettings::default();
    let outcome = traverse(&a, &b, &Pose::identity(), &settings, 0, |pair| {
        pairs.push((pair.a, pair.b));
        Flow::Continue
    })?;
    let seconds = start.elapsed().as_secs_f64();
    let feasible = points_a.len() * points_b.len() <= MOST_PAIRS;
    let is_isotropic = |p: &UncertainPoint| {
        p.covariance.matrix() == { Matrix3::from_diagonal_element(p.covariance.matrix()[(0, 0)]) }
    };
    let comparable = feasible && points_a.iter().chain(&points_b).all(is_isotropic);
    let flat = comparable.then(|| {
        let held = |tree: &Tree, points: &[UncertainPoint], leaf| -> Vec<UncertainPoint> {
            let indices = tree.leaf(leaf).map_or(&[][..], |leaf| leaf.primitive_indices());
            indices.iter().map(|&i| points[i as usize]).collect()
        };
        let visited = pairs.iter().map(|&(leaf_a, leaf_b)| {
            largest(&held(&a, &points_a, leaf_a), &held(&b, &points_b, leaf_b))
        });
        [largest(&points_a, &points_b), visited.fold(0.0, f64::max)]
    });
    Ok(Row { leaves: [a.leaves().count(), b.leaves().count()], outcome, flat, seconds })
}

fn points(cloud: &[Point3], covariances: &[Matrix3]) -> Vec<UncertainPoint> {
    let all = cloud.iter().zip(covariances);
    all.map(|(&mean, m)| UncertainPoint { mean, covariance: Covariance::from_symmetric(m) })
        .collect()
}

/// The largest probability that a plane half way between two points leaves to either; ½ for points
/// at the same place.
fn largest(a: &[UncertainPoint], b: &[UncertainPoint]) -> f64 {
    let pair = |p: &UncertainPoint, q: &UncertainPoint| {
        let distance = (q.mean - p.mean).norm();
        if distance == 0.0 {
            return 0.5;
        }
        let std = p.covariance.variance_along(&cloudtouch_geom::Vector3::x());
        let other = q.covariance.variance_along(&cloudtouch_geom::Vector3::x());
        normal::below_zero(0.5 * distance, std.max(other).sqrt())
    };
    a.iter().flat_map(|p| b.iter().map(move |q| pair(p, q))).fold(0.0, f64::max)
}
