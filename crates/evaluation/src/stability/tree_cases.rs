//! The catalogue through the hierarchy, beside all pairs of points.

use anyhow::{Context, Result};
use cloudtouch::bvh::{Flow, Outcome, Primitive, TraversalSettings, Tree, TreeSettings, traverse};
use cloudtouch_geom::{Matrix3, Pose, UncertainPoint, Vector3, normal};
use cloudtouch_testkit::hard_cases::{HardCase, hard_cases};

use super::{
    shapes::uncertain,
    sheet::{Sheet, small},
};
use crate::page::Section;

/// All pairs of points are tried up to so many.
const MOST_PAIRS: usize = 4_000_000;

/// What the section says before its numbers.
const INTRODUCTION: &str = "Trees over the whole clouds, certified traversal in the same frame \
without early stop. Culling bounds the probability of any point in pairs of boxes that were left \
out; a default query allows 1e-6. Where it can be computed, the probability that a plane half way \
between two points leaves to the less certain one, at most over all pairs of points, must not exceed \
the largest one in the leaf pairs visited and the bound. Where noise depends on the direction that \
plane bounds nothing, and where there are more than four million pairs it is not computed.";

struct Row {
    outcome: Outcome,
    /// Largest probability by brute force, and within the leaf pairs visited.
    flat: Option<[f64; 2]>,
}

/// Traverses everything and adds the section.
pub(super) fn run(sheet: &mut Sheet) -> Result<()> {
    let (mut cases, mut compared, mut lost) = (0, 0, 0);
    let (mut culled, mut visited) = (0.0_f64, (0, ""));
    let allowed = normal::upper_tail(TraversalSettings::default().cull_deviations);
    for case in hard_cases().iter().filter(|case| case.valid) {
        let name = format!("hierarchy, {}", case.name);
        let Some(row) = sheet.guard(&name, || search(case)) else { continue };
        let row = row.with_context(|| name.clone())?;
        let bound = row.outcome.culled_bound;
        cases += 1;
        if let Some([all, seen]) = row.flat {
            compared += 1;
            // The allowance for rounding is that of the tree's own tests.
            if all > seen.max(bound) * (1.0 + 1e-6) {
                lost += 1;
                sheet.fault(format!("{name}: {all} was culled at {bound}"));
            }
        }
        if bound.is_nan() || bound > allowed {
            sheet.fault(format!("{name}: culled at {bound}"));
        }
        culled = culled.max(bound);
        visited = visited.max((row.outcome.nodes_visited, case.name));
    }
    let found = format!(
        "{cases} cases, {compared} of them compared with all pairs; culled at {} at most; most box \
         pairs visited: {} (`{}`).",
        small(culled),
        visited.0,
        visited.1
    );
    sheet.sections.push(Section::new("Hard cases: hierarchy").text(INTRODUCTION).text(found));
    sheet.goal(
        "hard cases: bounds of the hierarchy hold the answer of all pairs",
        format!("{} of {compared}", compared - lost),
        lost == 0,
    );
    Ok(())
}

fn search(case: &HardCase) -> Result<Row> {
    let points_a = uncertain(&case.cloud_a, &case.covariance_a);
    let points_b = uncertain(&case.cloud_b, &case.covariance_b);
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
    Ok(Row { outcome, flat })
}

/// The largest probability that a plane half way between two points leaves to either; ½ for points
/// at the same place.
fn largest(a: &[UncertainPoint], b: &[UncertainPoint]) -> f64 {
    let variance = |p: &UncertainPoint| p.covariance.variance_along(&Vector3::x());
    let pair = |p: &UncertainPoint, q: &UncertainPoint| match (q.mean - p.mean).norm() {
        0.0 => 0.5,
        distance => normal::below_zero(0.5 * distance, variance(p).max(variance(q)).sqrt()),
    };
    a.iter().flat_map(|p| b.iter().map(move |q| pair(p, q))).fold(0.0, f64::max)
}
