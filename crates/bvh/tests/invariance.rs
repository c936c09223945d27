//! What must not change what a certified search finds: swapping, permuting, scaling, duplicates, far
//! points; and that more noise brings it towards one half.

use crate::common::{bumpy_sheet, flat_answer, held, moved, small_leaves};
use cloudtouch_bvh::{Flow, Outcome, Primitive, TraversalSettings, Tree, traverse};
use cloudtouch_geom::{Pose, UncertainPoint, Vector3, normal, seed};
use proptest::prelude::*;

/// The largest pair probability in the leaf pairs visited, and the outcome.
fn search(a: &Tree, b: &Tree, pose: &Pose) -> (f64, Outcome) {
    let mut found = 0.0_f64;
    let outcome = traverse(a, b, pose, &TraversalSettings::default(), 0, |pair| {
        let in_b: Vec<Primitive> =
            held(b, pair.b).iter().map(|p| changed(p, |point| point.transformed(pose))).collect();
        found = found.max(flat_answer(&held(a, pair.a), &in_b));
        Flow::Continue
    })
    .expect("usable settings");
    (found, outcome)
}

fn changed(primitive: &Primitive, change: impl Fn(&UncertainPoint) -> UncertainPoint) -> Primitive {
    match primitive {
        Primitive::Point { point, weight } => {
            Primitive::Point { point: change(point), weight: *weight }
        }
        triangle => *triangle,
    }
}

/// Two sheets, the second `gap` above the first, turned a little.
fn sheets(stream: u64, gap: f64) -> (Vec<Primitive>, Vec<Primitive>, Pose) {
    let a = bumpy_sheet(stream, 150, Vector3::zeros());
    let b = bumpy_sheet(stream + 1000, 130, Vector3::zeros());
    (a, b, Pose::from_translation_rpy(Vector3::new(0.02, -0.01, gap), [0.02, -0.03, 0.4]))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 30, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn swapping_the_trees(stream in 0..1000_u64, gap in -0.05..0.15_f64) {
        let (a, b, pose) = sheets(stream, gap);
        let (a, b) = (small_leaves(a), small_leaves(b));
        let (forth, there) = search(&a, &b, &pose);
        let (back, again) = search(&b, &a, &pose.inverse());
        // Both hold the answer of all pairs; what is below the culling bound may differ.
        let limit = normal::upper_tail(TraversalSettings::default().cull_deviations);
        prop_assert!((forth - back).abs() <= limit + 1e-9 * forth, "{} {}", forth, back);
        prop_assert!(there.culled_bound <= limit && again.culled_bound <= limit);
    }

    #[test]
    fn permuting_the_primitives(stream in 0..1000_u64, gap in -0.05..0.15_f64) {
        let (a, b, pose) = sheets(stream, gap);
        let mut shuffled: Vec<(u64, Primitive)> = a
            .iter()
            .enumerate()
            .map(|(i, p)| (seed::derive(stream, i as u64, 7), *p))
            .collect();
        shuffled.sort_by_key(|(key, _)| *key);
        let shuffled = small_leaves(shuffled.into_iter().map(|(_, p)| p).collect());
        let b = small_leaves(b);
        let (found, outcome) = search(&small_leaves(a), &b, &pose);
        let (other, mixed) = search(&shuffled, &b, &pose);
        prop_assert_eq!(found, other);
        prop_assert_eq!(outcome.leaf_pairs, mixed.leaf_pairs);
        // Sums in another order.
        prop_assert!((outcome.culled_bound - mixed.culled_bound).abs() <= 1e-9 * outcome.culled_bound);
    }

    /// An absolute tolerance anywhere would show. Powers of two: what nodes keep is rounded up to single precision.
    #[test]
    fn scaling_everything(stream in 0..1000_u64, gap in -0.05..0.15_f64, exponent in -6..7_i32) {
        let (a, b, pose) = sheets(stream, gap);
        let factor = 8_f64.powi(exponent);
        let scaled = |cloud: &[Primitive]| -> Vec<Primitive> {
            let larger = |p: &UncertainPoint| UncertainPoint {
                mean: p.mean * factor,
                covariance: p.covariance.scaled(factor),
            };
            cloud.iter().map(|p| changed(p, larger)).collect()
        };
        let mut scaled_pose = *pose.isometry();
        scaled_pose.translation.vector *= factor;
        let scaled_pose = Pose::from_isometry(scaled_pose);
        let (small_a, small_b) = (small_leaves(scaled(&a)), small_leaves(scaled(&b)));
        let (found, outcome) = search(&small_leaves(a), &small_leaves(b), &pose);
        let (other, of_scaled) = search(&small_a, &small_b, &scaled_pose);
        prop_assert!((found - other).abs() <= 1e-9, "{} {}", found, other);
        prop_assert_eq!(outcome.leaf_pairs, of_scaled.leaf_pairs);
        prop_assert!((outcome.culled_bound - of_scaled.culled_bound).abs() <= 1e-12);
    }

    #[test]
    fn adding_duplicates_and_far_points(stream in 0..1000_u64, gap in -0.05..0.15_f64) {
        let (a, b, pose) = sheets(stream, gap);
        let b = small_leaves(b);
        let (found, _) = search(&small_leaves(a.clone()), &b, &pose);
        let limit = normal::upper_tail(TraversalSettings::default().cull_deviations);
        let doubled = small_leaves([a.clone(), a.clone()].concat());
        let far = moved(&a, &Vector3::new(1e4, -2e4, 3e3));
        let with_far = small_leaves([a, far].concat());
        for tree in [doubled, with_far] {
            let (other, outcome) = search(&tree, &b, &pose);
            // Other boxes may cull what is below the bound.
            prop_assert!((found - other).abs() <= limit, "{} {}", found, other);
            prop_assert!(outcome.culled_bound <= limit);
        }
    }

    #[test]
    fn more_noise_brings_the_answer_towards_one_half(
        stream in 0..1000_u64,
        gap in 0.0..0.3_f64,
        factor in 1.0..20.0_f64,
    ) {
        let (a, b, pose) = sheets(stream, gap);
        let noisier = |cloud: &[Primitive]| -> Vec<Primitive> {
            let wider = |p: &UncertainPoint| UncertainPoint {
                covariance: p.covariance.scaled(factor),
                ..*p
            };
            cloud.iter().map(|p| changed(p, wider)).collect()
        };
        let (wide_a, wide_b) = (small_leaves(noisier(&a)), small_leaves(noisier(&b)));
        let (found, outcome) = search(&small_leaves(a), &small_leaves(b), &pose);
        let (noisy, of_noisy) = search(&wide_a, &wide_b, &pose);
        // The search is certified either way: what it left out is below its bound.
        prop_assert!(noisy.max(of_noisy.culled_bound) >= found, "{} {}", found, noisy);
        prop_assert!(noisy <= 0.5 && outcome.culled_bound <= 0.5);
        prop_assert!(of_noisy.leaf_pairs >= outcome.leaf_pairs);
    }
}
