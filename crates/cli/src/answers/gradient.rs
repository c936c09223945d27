//! What `--gradient` adds to an answer.

use cloudtouch::PoseGradient;

/// Lines about what a small motion along and about the axes of the object changes.
pub(crate) fn text(gradient: &PoseGradient) -> String {
    let mut lines = vec![format!("gradient of P          {}", spelled(&gradient.probability, ""))];
    lines.push(format!("   of its log odds     {}", spelled(&gradient.log_odds, "")));
    if let Some(clearance) = &gradient.clearance {
        lines.push(format!("   of the clearance    {}", spelled(clearance, "m ")));
    }
    lines.join("\n")
}

fn spelled(gradient: &[f64; 6], unit: &str) -> String {
    let [x, y, z, roll, pitch, yaw] = gradient;
    format!("[{x:.3}, {y:.3}, {z:.3}] {unit}per m, [{roll:.3}, {pitch:.3}, {yaw:.3}] {unit}per rad")
}
