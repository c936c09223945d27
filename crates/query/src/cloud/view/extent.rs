//! Over which part of all directions a view goes.

use super::lens::Lens;

/// So many returns of a scanner beyond all others are no line of it, ...
const STRAYS: usize = 5;
/// ... nor is this part of all.
const STRAY_SHARE: f64 = 1e-3;
/// How far beyond the outermost line returns may still be of it, rad.
const OF_LINE: f64 = 0.01;

/// The least and the largest of places of a view along both of its axes.
///
/// Of a scanner what is lower or higher than all its lines, such as the origin of the file where a row has none, is left
/// out: up to there nothing was looked at.
pub(super) fn extent(lens: &Lens, places: impl Iterator<Item = [f64; 2]> + Clone) -> [[f64; 2]; 2] {
    let [low, high] = match lens {
        Lens::Camera(_) => [f64::NEG_INFINITY, f64::INFINITY],
        Lens::Panorama(_) => lines_of(places.clone().map(|[_, elevation]| elevation).collect()),
    };
    let is_of = |at: &[f64; 2]| at[1] >= low - OF_LINE && at[1] <= high + OF_LINE;
    let widen = |[low, high]: [[f64; 2]; 2], at: [f64; 2]| {
        [[0, 1].map(|k| low[k].min(at[k])), [0, 1].map(|k| high[k].max(at[k]))]
    };
    places.filter(is_of).fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], widen)
}

/// The elevations of the lowest and the highest line.
fn lines_of(mut elevations: Vec<f64>) -> [f64; 2] {
    let count = elevations.len();
    let strays = STRAYS.max((STRAY_SHARE * count as f64) as usize).min(count.saturating_sub(1) / 2);
    let Some(last) = count.checked_sub(strays + 1) else {
        return [f64::NEG_INFINITY, f64::INFINITY];
    };
    [strays, last].map(|place| *elevations.select_nth_unstable_by(place, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;

    use super::*;

    #[test]
    fn a_stray_return_of_a_scanner_widens_no_view_and_a_line_does() {
        let lens = Lens::Panorama(UnitQuaternion::identity());
        let line = |elevation: f64| (0..40).map(move |k| [0.1 * f64::from(k), elevation]);
        let lines = || line(-0.2).chain(line(0.0)).chain(line(0.1));
        let stray = || (0..STRAYS).map(|k| [1.0, -1.5 + 0.1 * k as f64]);
        let all = [[0.0, -0.2], [3.9, 0.1]];
        let near = |found: [[f64; 2]; 2], wanted: [[f64; 2]; 2]| {
            found.into_iter().zip(wanted).all(|(p, q)| (0..2).all(|k| (p[k] - q[k]).abs() < 1e-12))
        };
        assert!(near(extent(&lens, lines()), all));
        assert!(near(extent(&lens, lines().chain(stray())), all));
        assert!(near(extent(&lens, lines().chain(line(-0.9))), [[0.0, -0.9], [3.9, 0.1]]));
    }
}
