//! Whole queries at their default settings, and what must hold of any answer.

use cloudtouch::{Contact, Report, Verdict};

use super::sheet::Sheet;

/// How an answer compares with the truth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Judged {
    Right,
    Open,
    Wrong,
    Unknown,
}

/// Judges a report; what is wrong or not sound is a fault.
pub(super) fn examine(
    sheet: &mut Sheet,
    name: &str,
    report: &Report,
    collides: Option<bool>,
) -> Judged {
    let judged = Judged::of(report.verdict, collides);
    if judged == Judged::Wrong {
        sheet.fault(format!("{name}: {:?}", report.verdict));
    }
    if let Some(unsound) = unsound(report) {
        sheet.fault(format!("{name}: {unsound}"));
    }
    judged
}

impl Judged {
    fn of(verdict: Verdict, collides: Option<bool>) -> Self {
        match (verdict, collides) {
            (_, None) => Self::Unknown,
            (Verdict::Free, Some(false)) | (Verdict::InCollision, Some(true)) => Self::Right,
            (Verdict::Free | Verdict::InCollision, Some(_)) => Self::Wrong,
            _ => Self::Open,
        }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Open => "open",
            Self::Wrong => "WRONG",
            Self::Unknown => "-",
        }
    }
}

/// What in a report is no probability, not finite, or no unit vector.
fn unsound(report: &Report) -> Option<&'static str> {
    let is_probability = |p: f64| (0.0..=1.0).contains(&p);
    let (p, [low, high]) = (report.collision_probability, report.bounds);
    if !(is_probability(p) && is_probability(low) && is_probability(high) && low <= p && p <= high)
    {
        return Some("probabilities are not ones, or out of their bounds");
    }
    let points = &report.point_probabilities;
    if !points.a.iter().chain(&points.b).all(|&(_, p)| is_probability(p)) {
        return Some("a point's probability is not one");
    }
    if report.clearance_m.is_some_and(|c| !(c.mean.is_finite() && c.std >= 0.0)) {
        return Some("the clearance is not a number");
    }
    // Normalising rounds in the last places only.
    let is_unit = |c: &Contact| (c.normal_a_to_b.norm() - 1.0).abs() < 1e-9;
    let is_finite = |c: &Contact| {
        c.point.iter().all(|v| v.is_finite()) && c.clearance_m.is_finite() && is_unit(c)
    };
    (!report.contacts.iter().all(is_finite)).then_some("a contact is not finite")
}

#[cfg(test)]
mod tests {
    use cloudtouch::{Mesh, Mode, noise::SensorModel};
    use cloudtouch_geom::{Point3, PointCloud, Pose};
    use cloudtouch_testkit::scene;

    use super::*;
    use crate::either::{EitherCloud, EitherQuery};

    #[test]
    fn free_and_collision_can_be_wrong_and_the_rest_is_open() {
        let of = |verdict| [Some(false), Some(true), None].map(|truth| Judged::of(verdict, truth));
        use Judged::{Open, Right, Unknown, Wrong};
        assert_eq!(of(Verdict::Free), [Right, Wrong, Unknown]);
        assert_eq!(of(Verdict::InCollision), [Wrong, Right, Unknown]);
        assert_eq!(of(Verdict::Undecided), [Open, Open, Unknown]);
    }

    #[test]
    fn a_probability_out_of_its_bounds_is_not_sound() {
        let mesh = Mesh::prepare(&scene::sphere(0.1, 1)).unwrap();
        let points = PointCloud::from_points(vec![Point3::new(0.1, 0.0, 0.0)]);
        let sensor = SensorModel::Isotropic { std: 0.01 };
        let cloud = EitherCloud::prepare(&points, sensor, Mode::Calibrated).unwrap();
        let here = Pose::identity();
        let asked = EitherQuery::new(Mode::Calibrated).run(&cloud, &mesh, &here);
        let mut report = asked.unwrap();
        assert_eq!(unsound(&report), None);
        report.bounds[1] = 0.5 * report.collision_probability;
        assert!(unsound(&report).is_some());
        report.collision_probability = f64::NAN;
        assert!(unsound(&report).is_some());
    }
}
