//! Points in clumps, as scans of the same rays make them that were put together.

use cloudtouch_noise::Neighborhoods;

/// Ranks of neighbours whose distances are compared, each with the next.
const RANKS: [usize; 4] = [6, 24, 96, 384];
/// Four times as many neighbours of a sample of a surface are twice as far, of one on a line four times; where
/// they are more often farther than this, the nearer ones are of one clump.
const MOST_STEP: f64 = 6.0;
/// In a clump sixteen times as many neighbours are two and a half times as far, on a surface four times: only
/// where they are no farther than this, more are asked for than the first three ranks.
const MAYBE_CLUMP: f64 = 3.7;
/// Points whose neighbours are asked for, at most.
const ASKED: usize = 12;
/// On a surface four times as many neighbours are hardly ever farther than this many times.
const USUAL_STEP: f64 = 2.5;

/// The distances of clumps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Clumps {
    /// How far the neighbours in a clump are, m.
    pub across: f64,
    /// How far those in others are, m.
    pub apart: f64,
}

/// Those that most points of a sample are in. What is told of a surface from the nearest neighbours ends at
/// the border of a clump, and nothing is known to be between two.
pub(super) fn clumps(points: &Neighborhoods, sample: &[usize]) -> Option<Clumps> {
    let every = sample.len().div_ceil(ASKED).max(1);
    let asked: Vec<usize> = sample.iter().copied().step_by(every).collect();
    // PERF: most clouds have none, which a quarter of the neighbours tell, in a fifth of the time.
    if are_surely_none(points, &asked) { None } else { by_ranks(points, &asked) }
}

/// The distances to so many neighbours, in order.
fn distances(points: &Neighborhoods, index: usize, most: usize) -> Vec<f64> {
    let near = points.nearest(index, most);
    near.iter().map(|near| near.squared_distance.sqrt()).collect()
}

/// Whether [`by_ranks`] finds none, as far as the first two ranks, and counts of who is within distances, say.
fn are_surely_none(points: &Neighborhoods, asked: &[usize]) -> bool {
    let [first, second, third, _] = RANKS;
    let few: Vec<Vec<f64>> = asked.iter().map(|&index| distances(points, index, second)).collect();
    if few.iter().any(|near| near.len() < second) || long_step(&few, [first, second]).is_some() {
        return false;
    }
    let (mut with_usual_step, mut maybe_in_clump) = (0, 0);
    for (near, &index) in few.iter().zip(asked) {
        let within = [USUAL_STEP * near[second - 1], MAYBE_CLUMP * near[first - 1]];
        let mut counts = [0; 2];
        points.visit_within(&points.points()[index], within[0].max(within[1]), |other| {
            let distance = other.squared_distance.sqrt();
            let is_other = distance > 0.0;
            for (count, within) in counts.iter_mut().zip(within) {
                *count += usize::from(is_other && distance <= within);
            }
        });
        with_usual_step += usize::from(counts[0] >= third);
        maybe_in_clump += usize::from(counts[1] >= third);
    }
    // By more than half of those asked: what is in the middle is no farther, and no nearer.
    2 * with_usual_step > asked.len() && 2 * maybe_in_clump < asked.len()
}

/// The same by all ranks that may tell.
fn by_ranks(points: &Neighborhoods, asked: &[usize]) -> Option<Clumps> {
    let up_to = |most: usize| -> Vec<Vec<f64>> {
        asked.iter().map(|&index| distances(points, index, most)).collect()
    };
    let [first, second, third, most] = RANKS;
    let few = up_to(third);
    let steps = [[first, second], [second, third]];
    let found = steps.into_iter().find_map(|ranks| long_step(&few, ranks));
    let may_be_one =
        || median(&few, [first, third]).is_some_and(|(near, far)| far < MAYBE_CLUMP * near);
    // PERF: hundreds of neighbours take ten times as long to find.
    found.or_else(|| if may_be_one() { long_step(&up_to(most), [third, most]) } else { None })
}

fn long_step(neighbors: &[Vec<f64>], ranks: [usize; 2]) -> Option<Clumps> {
    let (across, apart) = median(neighbors, ranks)?;
    (apart > MOST_STEP * across).then_some(Clumps { across, apart })
}

/// The distances of neighbours of two ranks where their ratio is the median.
fn median(neighbors: &[Vec<f64>], ranks: [usize; 2]) -> Option<(f64, f64)> {
    let of = |near: &Vec<f64>| Some((*near.get(ranks[0] - 1)?, *near.get(ranks[1] - 1)?));
    let mut all: Vec<(f64, f64)> = neighbors.iter().filter_map(of).collect();
    all.sort_by(|(a, b), (c, d)| (b / a).total_cmp(&(d / c)));
    all.get(all.len() / 2).copied()
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Point3;
    use cloudtouch_geom::seed::{derive, unit};
    use proptest::prelude::*;

    use super::*;

    fn of(points: Vec<Point3>) -> Option<Clumps> {
        let sample: Vec<usize> = (0..points.len()).step_by(points.len().div_ceil(200)).collect();
        clumps(&Neighborhoods::new(points).unwrap(), &sample)
    }

    /// A lattice of 1 cm, each place seen so often, each time off by up to so much along every axis.
    fn lattice(times: u64, off: f64) -> Vec<Point3> {
        let place = |i: u64| {
            let draw = |k| off * (2.0 * unit(derive(7, i, k)) - 1.0);
            let cell = i / times;
            let [x, y] = [cell % 40, cell / 40].map(|k| 0.01 * k as f64);
            Point3::new(x + draw(0), y + draw(1), draw(2))
        };
        (0..1600 * times).map(place).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// What a quarter of the neighbours tell surely, all of them say too.
        #[test]
        fn none_is_told_by_few_neighbours_where_all_tell_of_some(
            times in 1..120_u64,
            off in prop_oneof![Just(0.0), 1e-4..0.02_f64],
            every in prop::option::of(3..400_usize),
        ) {
            let mut points = lattice(times, off);
            points.truncate(6000);
            // A wire through the lattice.
            points.extend((0..every.unwrap_or(0)).map(|i| Point3::new(0.0, 0.0, 0.001 * i as f64)));
            let points = Neighborhoods::new(points).unwrap();
            let step = points.points().len().div_ceil(ASKED);
            let asked: Vec<usize> = (0..points.points().len()).step_by(step).collect();
            let all = by_ranks(&points, &asked);
            prop_assert!(all.is_none() || !are_surely_none(&points, &asked), "{all:?}");
        }
    }

    #[test]
    fn most_surfaces_need_few_neighbours() {
        for (off, few_tell) in [(0.0, true), (0.001, true), (0.02, false)] {
            let points = Neighborhoods::new(lattice(1, off)).unwrap();
            let asked: Vec<usize> = (0..1600).step_by(140).collect();
            assert_eq!(are_surely_none(&points, &asked), few_tell, "{off}");
        }
    }

    #[test]
    fn scans_of_the_same_rays_are_clumps() {
        for times in [7, 20, 80, 200] {
            let clumps = of(lattice(times, 0.0002)).expect("clumps");
            assert!(clumps.across < 0.001 && clumps.apart > 0.008, "{clumps:?}");
        }
    }

    #[test]
    fn surfaces_lines_and_noise_are_none() {
        for (times, off) in [(1, 0.0), (1, 0.003), (4, 0.0002), (7, 0.005), (80, 0.01)] {
            assert_eq!(of(lattice(times, off)), None, "{times} times, {off} m");
        }
        // Scan lines, 10 cm apart.
        let lines = |i: u64| Point3::new(0.001 * (i % 1000) as f64, 0.1 * (i / 1000) as f64, 0.0);
        assert_eq!(of((0..10_000).map(lines).collect()), None);
        let wire = (0..3000).map(|i| Point3::new(0.001 * f64::from(i), 0.0, 0.0)).collect();
        assert_eq!(of(wire), None);
        assert_eq!(of(lattice(1, 0.0)[..20].to_vec()), None);
    }
}
