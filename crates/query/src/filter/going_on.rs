//! Surfaces seen at a low angle: steep along the rays as veils are, but they go on.

/// A surface passes through the pixel and so many returns before and after it, or through more on one side: at its end it
/// goes on to the other, and its last return has none of it beyond.
const WINDOWS: [[usize; 2]; 5] = [[3, 3], [5, 1], [1, 5], [6, 0], [0, 6]];
/// How many returns are looked for on each side, ...
const MOST: usize = 6;
/// ... and how many pixels away the last of them may be.
const REACH: usize = 8;
/// Of a window's returns.
const COUNT: usize = 7;
/// Returns on a surface are off it by no more than so many standard deviations of their noise, root mean square, ...
const WITHIN_STDS: f64 = 1.5;
/// ... or by this part of what they span, which surfaces bend by. One pixel between two surfaces leaves .17 of it, three
/// that lead evenly from one to the other .08.
const BENT: f64 = 0.05;

/// Whether a surface goes on along a line of pixels: through a pixel and returns about it. `inverse_range` (1/m) is of
/// pixels by their places from there, if they have a return; that of a plane is the same more from pixel to pixel,
/// however steep it is (but for what the angle between a few pixels curves it by). `std` is the standard deviation of
/// the ranges, m.
pub(super) fn goes_on(inverse_range: impl Fn(isize) -> Option<f64>, std: f64) -> bool {
    let Some(own) = inverse_range(0) else { return false };
    let side = |sign: isize| {
        let places = (1..=REACH as isize).map(move |step| sign * step);
        let returns = places.filter_map(|place| Some((place as f64, inverse_range(place)?)));
        let (mut found, mut count) = ([(0.0, 0.0); MOST], 0);
        for (slot, sample) in found.iter_mut().zip(returns) {
            *slot = sample;
            count += 1;
        }
        (found, count)
    };
    let (before, after) = (side(-1), side(1));
    let (before, after) = (&before.0[..before.1], &after.0[..after.1]);
    let std = std * own * own;
    WINDOWS.iter().any(|&[back, on]| {
        if before.len() < back || after.len() < on {
            return false;
        }
        let mut window = [(0.0, own); COUNT];
        window[1..=back].copy_from_slice(&before[..back]);
        window[1 + back..].copy_from_slice(&after[..on]);
        is_straight(&window, std)
    })
}

/// Whether values at places are on one line, up to noise of this standard deviation.
fn is_straight(window: &[(f64, f64); COUNT], std: f64) -> bool {
    let mean = |of: fn(&(f64, f64)) -> f64| window.iter().map(of).sum::<f64>() / COUNT as f64;
    let (middle, level) = (mean(|sample| sample.0), mean(|sample| sample.1));
    let (mut across, mut along) = (0.0, 0.0);
    for (place, value) in window {
        across += (place - middle) * (value - level);
        along += (place - middle).powi(2);
    }
    let slope = across / along;
    let off = |(place, value): &(f64, f64)| value - level - slope * (place - middle);
    let squared = window.iter().map(|sample| off(sample).powi(2)).sum::<f64>() / COUNT as f64;
    let ends = window.iter().map(|sample| sample.0);
    let length = ends.clone().fold(f64::MIN, f64::max) - ends.fold(f64::MAX, f64::min);
    squared <= (WITHIN_STDS * std).powi(2) + (BENT * slope * length).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ranges of pixels side by side, the middle one asked about.
    fn of_ranges(ranges: &[f64], std: f64) -> bool {
        let middle = ranges.len() as isize / 2;
        let inverse = |place: isize| {
            let range = ranges.get(usize::try_from(middle + place).ok()?)?;
            range.is_finite().then(|| 1.0 / range)
        };
        goes_on(inverse, std)
    }

    #[test]
    fn a_plane_goes_on_however_steep_it_is() {
        for step in [0.001, 0.02, 0.1] {
            let ranges: Vec<f64> = (0..17).map(|k| 1.0 / (2.0 - step * k as f64)).collect();
            assert!(of_ranges(&ranges, 0.0), "{step}");
            // The same with noise, where its size is known.
            let mut noisy = ranges.clone();
            noisy.iter_mut().step_by(2).for_each(|range| *range += 0.02);
            assert!(of_ranges(&noisy, 0.02), "{step}");
        }
    }

    #[test]
    fn what_is_between_two_surfaces_does_not_go_on() {
        let near_and_far = |between: &[f64]| {
            let near = std::iter::repeat_n(1.0, 8 - between.len() / 2);
            near.chain(between.iter().copied()).chain(std::iter::repeat_n(1.4, 8)).collect()
        };
        for between in [&[1.2][..], &[1.1, 1.2, 1.3], &[1.05], &[1.35]] {
            let ranges: Vec<f64> = near_and_far(between);
            assert!(!of_ranges(&ranges, 0.004), "{between:?}");
        }
    }

    #[test]
    fn a_surface_goes_on_past_missing_returns_and_ends() {
        let mut ranges: Vec<f64> = (0..17).map(|k| 1.0 / (2.0 - 0.05 * k as f64)).collect();
        (ranges[7], ranges[10]) = (f64::NAN, f64::NAN);
        assert!(of_ranges(&ranges, 0.0));
        // One return after it is of it, then a wall.
        ranges[11..].fill(9.0);
        assert!(of_ranges(&ranges, 0.0));
        // The last return of it is of it too.
        ranges[9..].fill(9.0);
        assert!(of_ranges(&ranges, 0.0));
        ranges[8] = 5.0;
        assert!(!of_ranges(&ranges, 0.0));
    }
}
