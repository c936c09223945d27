//! What `--penetration` adds to an answer.

use cloudtouch::Penetration;

/// A line about the least translation that was found to end a collision.
pub(crate) fn text(way_out: Option<&Penetration>, probability: f64) -> String {
    let said = match way_out {
        None => "none found in any direction".to_owned(),
        Some(out) if out.distance_m == 0.0 => "no move needed".to_owned(),
        Some(Penetration { direction, distance_m, depth_m, std_m, .. }) => {
            let [far, deep, std] = [distance_m, depth_m, std_m].map(|m| 1e3 * m);
            let [x, y, z] = [direction.x, direction.y, direction.z];
            format!("{far:.1} mm along [{x:.3}, {y:.3}, {z:.3}]; in by {deep:.1} ± {std:.1} mm")
        }
    };
    format!("{:<22} {said}", format!("way out to P < {probability}"))
}
