//! Which points of a view have a colour.

use serde::Serialize;

use crate::encode;
use crate::view::View;

/// Points that are less likely have no colour.
const LEAST_LIKELY: f64 = 0.01;

/// Points with a probability: u32 among the points that are drawn, and u8 in parts of 255.
#[derive(Default, Serialize)]
pub(crate) struct Likely {
    points: String,
    probabilities: String,
}

/// Points of scene and object that have a colour in a view, the likeliest where there are too many.
pub(crate) fn listed(
    view: &View<'_>,
    most: usize,
    notes: &mut Vec<String>,
) -> [Vec<(usize, f64)>; 2] {
    let Some(asked) = &view.asked else { return Default::default() };
    let all = &asked.report.point_probabilities;
    [&all.a, &all.b].map(|points| {
        let mut points: Vec<(usize, f64)> =
            points.iter().copied().filter(|(_, p)| *p >= LEAST_LIKELY).collect();
        if points.len() > most / 2 {
            points.sort_by(|(i, p), (j, q)| q.total_cmp(p).then(i.cmp(j)));
            points.truncate(most / 2);
            points.sort_by_key(|(index, _)| *index);
            notes.push(format!(
                "In a pose no more than the {} likeliest points of a cloud are coloured.",
                most / 2
            ));
        }
        points
    })
}

/// Those of the listed points that are drawn.
pub(crate) fn likely(listed: &[(usize, f64)], chosen: &[usize]) -> Likely {
    let among = |&(index, p): &(usize, f64)| Some((chosen.binary_search(&index).ok()? as u32, p));
    let points: Vec<(u32, f64)> = listed.iter().filter_map(among).collect();
    Likely {
        points: encode::indices(points.iter().map(|(index, _)| *index)),
        probabilities: encode::bytes(points.iter().map(|(_, p)| (255.0 * p).round() as u8)),
    }
}
