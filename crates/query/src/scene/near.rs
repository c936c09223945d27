//! Which boxes meet, by sort and sweep: pairs that do not are never looked at.

use cloudtouch_geom::Point3;

/// Lowest and highest corner along the axes of the scene, m.
pub(super) type Corners = [Point3; 2];

/// What meets everything.
pub(super) fn everywhere() -> Corners {
    [Point3::from([f64::NEG_INFINITY; 3]), Point3::from([f64::INFINITY; 3])]
}

/// All pairs of boxes that meet, each and all in the order of the boxes.
pub(super) fn meeting(boxes: &[Corners]) -> Vec<[usize; 2]> {
    let axis = best_axis(boxes);
    let mut from_the_left: Vec<usize> = (0..boxes.len()).collect();
    from_the_left.sort_by(|&p, &q| boxes[p][0][axis].total_cmp(&boxes[q][0][axis]));
    let mut pairs = Vec::new();
    // Those that reach as far as where the sweep is.
    let mut here: Vec<usize> = Vec::new();
    for next in from_the_left {
        here.retain(|&other| boxes[other][1][axis] >= boxes[next][0][axis]);
        let met = here.iter().filter(|&&other| meet(&boxes[other], &boxes[next]));
        pairs.extend(met.map(|&other| [other.min(next), other.max(next)]));
        here.push(next);
    }
    pairs.sort_unstable();
    pairs
}

/// The axis along which the fewest pairs meet, which is what a sweep looks at: of bodies in a plane across x all do
/// along x. Of equals the first.
fn best_axis(boxes: &[Corners]) -> usize {
    (0..3).min_by_key(|&axis| meeting_along(boxes, axis)).unwrap_or(0)
}

/// How many pairs meet along an axis, and as many more as there are pairs: of each two boxes one at least begins
/// before the other ends, and where they meet both do.
fn meeting_along(boxes: &[Corners], axis: usize) -> usize {
    let mut begins: Vec<f64> = boxes.iter().map(|[low, _]| low[axis]).collect();
    begins.sort_by(f64::total_cmp);
    boxes.iter().map(|[_, high]| begins.partition_point(|begin| *begin <= high[axis])).sum()
}

fn meet([low, high]: &Corners, [other_low, other_high]: &Corners) -> bool {
    (0..3).all(|k| low[k] <= other_high[k] && other_low[k] <= high[k])
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Vector3;
    use proptest::prelude::*;

    use super::*;

    fn corners() -> impl Strategy<Value = Corners> {
        // Whole numbers, so that some only touch.
        let numbers = prop::array::uniform3(0..12_i32);
        let of = (numbers, prop::array::uniform3(0..4_i32)).prop_map(|(low, size)| {
            let low = Point3::from(low.map(f64::from));
            [low, low + Vector3::from(size.map(f64::from))]
        });
        prop_oneof![9 => of, 1 => Just(everywhere())]
    }

    /// Of bodies in a plane across x every pair was looked at.
    #[test]
    fn the_sweep_goes_along_the_axis_on_which_the_fewest_meet() {
        let row = |axis: usize| -> Vec<Corners> {
            let at = |k: i32| {
                let mut low = Point3::origin();
                low[axis] = 2.0 * f64::from(k);
                [low, low + Vector3::repeat(1.0)]
            };
            let mut row: Vec<Corners> = (0..100).map(at).collect();
            row.push(everywhere());
            row
        };
        for axis in 0..3 {
            let boxes = row(axis);
            assert_eq!(best_axis(&boxes), axis);
            // All pairs, the boxes themselves, and those that meet what is everywhere.
            assert_eq!(meeting_along(&boxes, axis), 50 * 101 + 101 + 100);
            assert_eq!(meeting(&boxes).len(), 100);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn the_sweep_finds_the_pairs_that_all_pairs_have(
            boxes in prop::collection::vec(corners(), 0..30),
        ) {
            let mut all = Vec::new();
            for (k, first) in boxes.iter().enumerate() {
                for (l, second) in boxes.iter().enumerate().skip(k + 1) {
                    if meet(first, second) {
                        all.push([k, l]);
                    }
                }
            }
            prop_assert_eq!(meeting(&boxes), all);
        }
    }
}
