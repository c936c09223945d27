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
    let up_to = |most: usize| -> Vec<Vec<f64>> {
        (sample.iter().step_by(every))
            .map(|&index| points.nearest(index, most))
            .map(|near| near.iter().map(|near| near.squared_distance.sqrt()).collect())
            .collect()
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
