//! What is known of a view, a line each.

use cloudtouch::geom::Pose;
use cloudtouch::{Placement, Report};

use crate::fact::Fact;
use crate::view::View;
use crate::words;

/// All that is told of a view beside its verdict, contacts and warnings.
pub(crate) fn of_view(view: &View<'_>) -> Vec<Fact> {
    let asked = view.asked.as_ref();
    let mut facts = asked.map_or_else(Vec::new, |asked| of_report(&asked.report));
    facts.extend(view.more.iter().cloned());
    facts.extend(asked.and_then(|asked| asked.placement).map(place));
    facts.extend(asked.map(|asked| Fact::new("Pose", pose(&asked.object.pose))));
    facts
}

fn of_report(report: &Report) -> Vec<Fact> {
    let [low, high] = report.bounds.map(words::probability);
    let likely = words::probability(report.collision_probability);
    let mut facts = vec![
        Fact::new("Probability of a collision", format!("{likely} (within {low} .. {high})")),
        Fact::new("Clearance", words::clearance(report.clearance_m, report.clearance_at_least_m)),
    ];
    facts.extend(report.unseen.as_ref().map(|unseen| Fact::new("Unseen", words::unseen(unseen))));
    facts
}

fn place(placement: &Placement) -> Fact {
    let side = |[low, high]: [[f64; 3]; 2]| {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|k| high[k] - low[k]);
        let digits = words::decimals(x.max(y).max(z));
        format!("{x:.digits$} × {y:.digits$} × {z:.digits$} m")
    };
    let mut text =
        format!("object {}, scene {}", side(placement.object_box), side(placement.scene_box));
    if placement.box_gap_m > 0.0 {
        let gap = words::length(placement.box_gap_m);
        text += &format!("; the object is {gap} outside of the scene");
    }
    if let Some(nearest) = placement.nearest_m {
        text += &format!("; nearest point about {} away", words::length(nearest));
    }
    Fact::new("Sizes", text)
}

/// A pose in words.
fn pose(pose: &Pose) -> String {
    let t = pose.translation();
    let at = format!("origin of the object at ({:.3}, {:.3}, {:.3}) m", t.x, t.y, t.z);
    match pose.rotation().axis_angle() {
        Some((axis, angle)) if angle > 1e-6 => format!(
            "{at}, turned by {:.1}° about ({:.2}, {:.2}, {:.2})",
            angle.to_degrees(),
            axis.x,
            axis.y,
            axis.z
        ),
        _ => format!("{at}, not turned"),
    }
}
