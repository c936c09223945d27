//! Which points are drawn where there are too many.

/// Indices of at most `limit` of `count` points, in order: up to half of them the likeliest of
/// `likely` (index and probability), so that no place that matters is lost, the others evenly spread
/// over the rows of the file.
pub(crate) fn drawn(count: usize, limit: usize, likely: &[(usize, f64)]) -> Vec<usize> {
    if count <= limit {
        return (0..count).collect();
    }
    let mut ranked: Vec<&(usize, f64)> =
        likely.iter().filter(|(index, _)| *index < count).collect();
    ranked.sort_by(|(i, p), (j, q)| q.total_cmp(p).then(i.cmp(j)));
    let mut is_likely = vec![false; count];
    let mut taken = 0;
    for &&(index, _) in &ranked {
        if 2 * taken >= limit {
            break;
        }
        taken += usize::from(!is_likely[index]);
        is_likely[index] = true;
    }
    let (others, wanted) = (count - taken, limit - taken);
    // Of the first n others so many are drawn.
    let share = |n: usize| (n as u128 * wanted as u128 / others as u128) as usize;
    let mut passed = 0;
    (0..count)
        .filter(|&index| {
            if is_likely[index] {
                return true;
            }
            passed += 1;
            share(passed) > share(passed - 1)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn the_limit_is_used_up_and_the_likeliest_are_there(
            count in 1_usize..3000,
            limit in 1_usize..2000,
            likely in prop::collection::vec((0_usize..4000, 0.0..1.0_f64), 0..40),
        ) {
            let drawn = drawn(count, limit, &likely);
            prop_assert_eq!(drawn.len(), count.min(limit));
            prop_assert!(drawn.is_sorted_by(|a, b| a < b));
            prop_assert!(drawn.iter().all(|&index| index < count));
            let known = likely.iter().filter(|(index, _)| *index < count);
            let likeliest = known.max_by(|a, b| a.1.total_cmp(&b.1));
            if let Some((index, _)) = likeliest {
                prop_assert!(limit < 2 || drawn.contains(index));
            }
        }
    }

    #[test]
    fn the_others_are_spread_over_all_rows() {
        let drawn = drawn(1000, 100, &[]);
        assert!(drawn.windows(2).all(|pair| pair[1] - pair[0] == 10), "{drawn:?}");
    }
}
