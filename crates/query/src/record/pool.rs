//! From point probabilities to the probability of a pair of clouds (section 4.4 of the paper).

use crate::cells::Cells;

use super::closeness::Closeness;
use super::point::PointProbability;

/// The largest probability; 0 without points.
pub(crate) fn max(points: &[PointProbability]) -> f64 {
    points.iter().map(|p| p.probability).fold(0.0, f64::max)
}

/// 1 − Π(1 − P) over points with P near the largest, thinned so that no two are close: neighbours on one surface are not independent witnesses, and over all
/// points the product goes to 0 however small each P is.
pub(crate) fn noisy_or(points: &[PointProbability], closeness: &Closeness) -> f64 {
    let floor = closeness.share_of_max * max(points);
    if floor == 0.0 {
        return 0.0;
    }
    let mut likely: Vec<&PointProbability> =
        points.iter().filter(|p| p.probability >= floor).collect();
    likely.sort_by(|p, q| {
        let by_place = |p: &PointProbability| (p.side, p.index);
        q.probability.total_cmp(&p.probability).then(by_place(p).cmp(&by_place(q)))
    });
    // No two are told to be close that are farther apart.
    let reach = closeness.spacings * likely.iter().map(|p| p.spacing).fold(0.0, f64::max);
    let mut witnesses: Vec<&PointProbability> = Vec::new();
    let mut places = Cells::default();
    let mut all_free = 1.0;
    for point in likely {
        let mut is_new = true;
        // PERF: of all, faces that meet all over would take the square of how many points they have.
        if reach > 0.0 {
            places.visit_near(&point.position, reach, |number| {
                let witness = witnesses[number];
                let apart = closeness.spacings * witness.spacing.max(point.spacing);
                is_new = is_new && (witness.position - point.position).norm() >= apart;
            });
        }
        if is_new {
            places.push(&point.position, reach);
            witnesses.push(point);
            all_free *= 1.0 - point.probability;
        }
    }
    1.0 - all_free
}

/// Upper bound on [`noisy_or`] when `total` points at most were left out, none of them more
/// probable than `rest`.
pub(crate) fn noisy_or_bound(
    points: &[PointProbability],
    closeness: &Closeness,
    rest: f64,
    total: usize,
) -> f64 {
    let floor = closeness.share_of_max * max(points);
    if rest < floor {
        return noisy_or(points, closeness);
    }
    // One of them may be a witness in the place of a point that others are close to, which are witnesses then.
    let likely = points.iter().filter(|p| p.probability >= floor);
    let all_free: f64 = likely.map(|p| 1.0 - p.probability).product();
    1.0 - all_free * (1.0 - rest).powf(total as f64)
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Point3, seed};

    use super::*;
    use crate::record::Side;

    const USUAL: Closeness = Closeness { share_of_max: 0.8, spacings: 3.0 };

    fn point(x: f64, probability: f64) -> PointProbability {
        PointProbability {
            side: Side::A,
            index: None,
            position: Point3::new(x, 0.0, 0.0),
            probability,
            spacing: 0.1 / 3.0,
        }
    }

    #[test]
    fn neighbours_count_once_and_distant_points_add_up() {
        assert_eq!(noisy_or(&[], &USUAL), 0.0);
        let together = noisy_or(&[point(0.0, 0.5), point(0.01, 0.5), point(0.02, 0.45)], &USUAL);
        assert_eq!(together, 0.5);
        let apart = noisy_or(&[point(0.0, 0.5), point(1.0, 0.5)], &USUAL);
        assert_eq!(apart, 0.75);
        assert_eq!(max(&[point(0.0, 0.2), point(1.0, 0.5)]), 0.5);
    }

    #[test]
    fn what_was_left_out_widens_only_when_it_could_count() {
        let found = [point(0.0, 0.5)];
        assert_eq!(noisy_or_bound(&found, &USUAL, 0.3, 100), 0.5);
        assert!(noisy_or_bound(&found, &USUAL, 0.45, 100) > 0.99);
        let nothing = noisy_or_bound(&[], &USUAL, 1e-6, 1000);
        assert!((nothing / 1e-3 - 1.0).abs() < 1e-3, "{nothing}");
    }

    /// One that was left out may take the place of a point between two others, and free both.
    #[test]
    fn what_was_left_out_brought_more_than_the_bound() {
        let at = |x: f64, y: f64, probability| PointProbability {
            position: Point3::new(x, y, 0.0),
            ..point(0.0, probability)
        };
        let found = [at(0.0, 0.0, 0.5), at(0.0, 0.08, 0.49), at(0.0, -0.08, 0.49)];
        let left_out = at(-0.09, 0.0, 0.51);
        let with_it = noisy_or(&[&found[..], &[left_out]].concat(), &USUAL);
        assert!(with_it > 0.85, "{with_it}");
        assert!(with_it <= noisy_or_bound(&found, &USUAL, 0.51, 1));
    }

    /// By asking all witnesses.
    #[test]
    fn witnesses_are_those_that_none_of_all_before_is_close_to() {
        let draw = |i: u64, k| seed::unit(seed::derive(3, i, k));
        for largest in [0.0, 0.001, 0.02, 0.4] {
            let point = |i: u64| PointProbability {
                position: Point3::new(draw(i, 0), 0.3 * draw(i, 1), 0.01 * draw(i, 2)),
                probability: 0.01 + 1e-4 * draw(i, 3),
                spacing: largest * draw(i, 4).powi(3),
                ..point(0.0, 0.0)
            };
            let mut all: Vec<_> = (0..600).map(point).collect();
            let found = noisy_or(&all, &USUAL);
            all.sort_by(|p, q| q.probability.total_cmp(&p.probability));
            let mut witnesses: Vec<PointProbability> = Vec::new();
            for p in all {
                let is_far = |w: &PointProbability| {
                    (w.position - p.position).norm() >= 3.0 * w.spacing.max(p.spacing)
                };
                if witnesses.iter().all(is_far) {
                    witnesses.push(p);
                }
            }
            let free = witnesses.iter().fold(1.0, |free, w| free * (1.0 - w.probability));
            assert_eq!(found, 1.0 - free, "{largest}");
        }
    }

    #[test]
    fn unlikely_points_do_not_pile_up_to_certainty() {
        // The product over all points would be 1 − 0.99¹⁰⁰⁰ ≈ 1.
        let mut points: Vec<_> = (0..1000).map(|i| point(f64::from(i), 0.01)).collect();
        points.push(point(-5.0, 0.3));
        // One subtraction each way rounds once.
        assert!((noisy_or(&points, &USUAL) - 0.3).abs() < 1e-15);
    }
}
