//! The order of the points in the file does not matter.

use crate::common::{ask, at, measured, mesh, prepare, uniform};
use cloudtouch::Mode;
use cloudtouch::geom::{Point3, Pose, Vector3};
use cloudtouch_testkit::scene;

/// Indices in an order that depends on the seed.
fn shuffled(count: usize, seed: u64) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&i, &j| uniform(seed, i as u64).total_cmp(&uniform(seed, j as u64)));
    order
}

/// Whether a few points stand for all was told from every so-manieth point of the file: where the noise is
/// about as large as the spacing, that changed with their order.
#[test]
fn the_order_does_not_decide_which_points_stand_for_all() {
    let std = 0.005;
    let cube = mesh(&scene::cuboid([0.1; 3]));
    for spacing in [0.003, 0.0033, 0.0036] {
        let points = measured(&scene::cuboid([0.1, 0.2, 0.1]), spacing, std, 5);
        let probability = |seed| {
            let shuffled = shuffled(points.len(), seed).iter().map(|&i| points[i]).collect();
            let cloud = prepare(shuffled, std, Mode::Calibrated);
            let turned = Pose::from_translation_rpy(Vector3::new(0.1, 0.02, 0.01), [0.4, 0.3, 0.2]);
            ask(Mode::Calibrated, &cloud, &cube, &turned).collision_probability
        };
        let first = probability(1);
        for seed in 2..12 {
            let other = probability(seed);
            assert!((other - first).abs() < 1e-3, "{spacing}, {seed}: {other} and {first}");
        }
    }
}

#[test]
fn a_shuffled_cloud_gives_the_same_answer() {
    let std = 0.003;
    let floor = measured(&scene::plane_patch(0.4), 0.015, std, 1);
    let ball = measured(&scene::sphere(0.1, 3), 0.012, std, 2);
    let (order_a, order_b) = (shuffled(floor.len(), 3), shuffled(ball.len(), 4));
    let pick = |points: &[Point3], order: &[usize]| order.iter().map(|&i| points[i]).collect();
    let a = prepare(floor.clone(), std, Mode::Calibrated);
    let b = prepare(ball.clone(), std, Mode::Calibrated);
    let shuffled_a = prepare(pick(&floor, &order_a), std, Mode::Calibrated);
    let shuffled_b = prepare(pick(&ball, &order_b), std, Mode::Calibrated);
    for gap in [-0.01, 0.0, 0.005, 0.01, 0.03] {
        let pose = at(0.02, 0.01, 0.1 + gap);
        let in_order = ask(Mode::Calibrated, &a, &b, &pose);
        let mixed = ask(Mode::Calibrated, &shuffled_a, &shuffled_b, &pose);
        let (p, q) = (in_order.collision_probability, mixed.collision_probability);
        // The promised tolerance: sums run in another order.
        assert!((p - q).abs() < 1e-3, "gap {gap}: {p} and {q}");
        assert_eq!(in_order.verdict, mixed.verdict, "gap {gap}");
        if p > 0.99 {
            // An early stop may have ended at another, equally certain point.
            continue;
        }
        // Point by point, by where they came from. Only the most probable points are compared: the
        // others may have been skipped once they could not change the answer.
        let by_origin = |points: &[(usize, f64)], order: &[usize]| -> Vec<(usize, f64)> {
            points.iter().map(|&(i, p)| (order[i], p)).collect()
        };
        let mixed_a = by_origin(&mixed.point_probabilities.a, &order_a);
        let mixed_b = by_origin(&mixed.point_probabilities.b, &order_b);
        let sides = [
            (&in_order.point_probabilities.a, mixed_a),
            (&in_order.point_probabilities.b, mixed_b),
        ];
        for (ours, theirs) in sides {
            for &(index, probability) in ours.iter().filter(|&&(_, one)| one > 0.95 * p) {
                let found = theirs.iter().find(|(i, _)| *i == index);
                let found = found.unwrap_or_else(|| panic!("point {index} is missing")).1;
                assert!((found - probability).abs() < 0.01, "{index}: {probability}, {found}");
            }
        }
    }
}
