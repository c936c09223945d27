//! Which trade-offs of time and error nothing else beats.

/// Whether each point (time, error) is on the front: no other one is at most as slow and at most
/// as wrong, and better in either.
pub(crate) fn on_front(points: &[(f64, f64)]) -> Vec<bool> {
    points.iter().map(|a| !points.iter().any(|b| b.0 <= a.0 && b.1 <= a.1 && b != a)).collect()
}

/// The front as a staircase by rising time.
pub(crate) fn staircase(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let on_front = on_front(points).into_iter().zip(points);
    let mut front: Vec<(f64, f64)> = on_front.filter(|(on, _)| *on).map(|(_, p)| *p).collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut stairs: Vec<(f64, f64)> = Vec::new();
    for (x, y) in front {
        if let Some(&(_, last)) = stairs.last() {
            stairs.push((x, last));
        }
        stairs.push((x, y));
    }
    stairs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_is_what_nothing_beats() {
        let points = [(1.0, 0.5), (2.0, 0.5), (2.0, 0.3), (3.0, 0.4), (4.0, 0.1), (4.0, 0.1)];
        assert_eq!(on_front(&points), [true, false, true, false, true, true]);
        let stairs = [(1.0, 0.5), (2.0, 0.5), (2.0, 0.3), (4.0, 0.3), (4.0, 0.1)];
        assert_eq!(staircase(&points)[..5], stairs);
        assert!(staircase(&[]).is_empty());
    }
}
