//! Points that are copies of others but for rounding: a scan that was put together with itself.

use cloudtouch_noise::Neighborhoods;

/// What is nearer to another point than this part of the spacing is a copy: of a random sample one point in ten thousand.
const COPY: f64 = 0.005;
/// The neighbour that tells the spacing: of a surface this many times the distance of samples away, copied or not.
const RANK: usize = 8;
const RANK_SPACINGS: f64 = 1.6;
/// Fewer copies among some places are chance, or of single points.
const LEAST: usize = 3;

/// The points of a cloud without copies of those before them, in order; `None` where few of these places have any.
pub(in crate::cloud) fn without_copies(
    cloud: &Neighborhoods,
    places: &[usize],
) -> Option<Vec<u32>> {
    let near = places.iter().map(|&at| cloud.nearest(at, RANK));
    let distances = |near: Vec<cloudtouch_noise::Neighbor>| {
        let [first, .., last] = &near[..] else { return None };
        Some([first, last].map(|neighbor| neighbor.squared_distance.sqrt()))
    };
    let mut told: Vec<[f64; 2]> = near.filter_map(distances).collect();
    told.sort_by(|p, q| p[1].total_cmp(&q[1]));
    let [_, wide] = told.get(told.len() / 2)?;
    let most = COPY * wide / RANK_SPACINGS;
    if told.iter().filter(|[first, _]| *first <= most).count() < LEAST {
        return None;
    }
    let points = cloud.points();
    let mut is_kept = vec![true; points.len()];
    for (index, place) in points.iter().enumerate() {
        cloud.visit_within(place, most, |other| {
            is_kept[index] &= other.index >= index || !is_kept[other.index];
        });
    }
    Some((0..).zip(is_kept).filter_map(|(index, kept)| kept.then_some(index)).collect())
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed::{derive, unit};
    use cloudtouch_geom::{Point3, Vector3};

    use super::*;

    const COUNT: usize = 2000;

    fn of(points: Vec<Point3>) -> Option<Vec<u32>> {
        let places: Vec<usize> = (0..points.len()).step_by(points.len() / 24).collect();
        without_copies(&Neighborhoods::new(points).unwrap(), &places)
    }

    /// A sheet of a metre, 2 cm between samples at random.
    fn sheet() -> Vec<Point3> {
        let at = |i: usize| [0, 1].map(|k| unit(derive(3, i as u64, k)));
        (0..COUNT).map(at).map(|[x, y]| Point3::new(x, y, 0.0)).collect()
    }

    #[test]
    fn a_scan_beside_itself_is_one() {
        let once = sheet();
        assert_eq!(of(once.clone()), None);
        for times in [2, 3] {
            let copy = |k: usize| {
                let off = move |i, axis| 1e-6 * unit(derive(k as u64, i as u64, axis));
                once.iter()
                    .enumerate()
                    .map(move |(i, p)| p + Vector3::new(off(i, 5), off(i, 6), off(i, 7)))
            };
            let all: Vec<Point3> = once.iter().copied().chain((1..times).flat_map(copy)).collect();
            let kept = of(all).unwrap();
            // Those of a random sample that are by chance as near as a copy go too.
            assert!(kept.len() <= COUNT && kept.len() > COUNT - 5, "{times}: {}", kept.len());
            assert!(kept.iter().all(|&index| (index as usize) < COUNT));
        }
    }

    /// A static camera's next frame errs by its own.
    #[test]
    fn a_second_scan_of_the_same_is_none() {
        let once = sheet();
        let off = |i: usize| Vector3::z() * 2e-3 * (unit(derive(9, i as u64, 0)) - 0.5);
        let again = once.iter().enumerate().map(|(i, p)| p + off(i) + Vector3::x() * 1e-3);
        assert_eq!(of(once.iter().copied().chain(again).collect()), None);
    }
}
