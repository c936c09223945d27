//! What must hold for every report and every message.

use cloudtouch::{QueryError, Report, Verdict};

/// What a query was asked to keep to.
pub(super) struct Limits {
    pub accept: f64,
    pub reject: f64,
    pub max_contacts: usize,
}

/// Checks a report or the message of an error.
pub(super) fn answer(answer: &Result<Report, QueryError>, limits: &Limits, points: [usize; 2]) {
    match answer {
        Ok(found) => report(found, limits, points),
        Err(error) => message(&error.to_string()),
    }
}

/// Checks a report against itself and the settings that it was asked under; `points` are those of
/// A and of B, none for a mesh.
fn report(report: &Report, settings: &Limits, points: [usize; 2]) {
    let probability = report.collision_probability;
    let [low, high] = report.bounds;
    for value in [probability, low, high, report.max_probability, report.noisy_or_probability] {
        assert_probability(value, report);
    }
    assert!(low <= probability && probability <= high, "outside of its bounds: {report:?}");
    match report.verdict {
        Verdict::Free => assert!(high < settings.reject, "free: {report:?}"),
        Verdict::InCollision => assert!(probability > settings.accept, "collision: {report:?}"),
        Verdict::Uncertain => assert!(probability >= settings.reject, "contact: {report:?}"),
        Verdict::Undecided => {}
    }
    if let Some(clearance) = report.clearance_m {
        assert!(clearance.mean.is_finite(), "clearance: {report:?}");
        assert!(clearance.std.is_finite() && clearance.std >= 0.0, "clearance: {report:?}");
    }
    assert!(report.contacts.len() <= settings.max_contacts, "too many contacts: {report:?}");
    for contact in &report.contacts {
        assert_probability(contact.probability, report);
        assert!(contact.point.iter().all(|v| v.is_finite()), "contact point: {report:?}");
        assert!((contact.normal_a_to_b.norm() - 1.0).abs() < 1e-6, "contact normal: {report:?}");
        assert!(contact.clearance_m.is_finite(), "contact clearance: {report:?}");
    }
    for (listed, points) in
        [&report.point_probabilities.a, &report.point_probabilities.b].into_iter().zip(points)
    {
        for &(index, probability) in listed {
            assert!(index < points, "point {index} of {points}: {report:?}");
            assert_probability(probability, report);
        }
    }
    assert!(report.stats.max_relative_gap >= 0.0, "gap: {report:?}");
}

/// Checks the message of an error.
pub(super) fn message(message: &str) {
    assert!(!message.trim().is_empty(), "an error without a message");
    // A few numbers of up to 309 digits each.
    assert!(message.len() < 2000, "{} bytes of message", message.len());
}

fn assert_probability(value: f64, report: &Report) {
    assert!((0.0..=1.0).contains(&value), "{value} is no probability: {report:?}");
}
