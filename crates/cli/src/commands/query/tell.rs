//! What was found, in JSON and for people.

use anyhow::Result;
use cloudtouch_page::Fact;

use super::ask::Found;
use super::question::Question;
use crate::answers::per_point::Details;
use crate::answers::print;
use crate::answers::query::Answer;
use crate::answers::{self, gradient, penetration};
use crate::body::PreparedCloud;

/// What is told of distances and of poses that are uncertain, here and on the page.
pub(super) fn facts(found: &Found) -> Vec<Fact> {
    let nearness = found.nearness.as_ref().map(answers::text::nearness);
    let over_poses = found.pose_uncertainty.as_ref().map(answers::text::over_poses);
    nearness.into_iter().chain(over_poses).collect()
}

pub(super) fn json<C>(question: &Question<'_, C>, found: &Found) -> Result<String> {
    let Question { arguments, scene, object, pose, doubt } = question;
    let details = Details {
        points: arguments.points.then(|| (&found.report).into()),
        pose_uncertainty: found.pose_uncertainty,
        gradient: found.gradient,
        penetration: found.penetration,
        classifiers: arguments.explain.then_some(&found.classifiers[..]),
    };
    let answer = Answer {
        report: &found.report,
        placement: &found.placement,
        pose,
        details,
        nearness: found.nearness,
        doubt: doubt.as_ref(),
    };
    answer.json_line("query", [&scene.input, &object.input])
}

pub(super) fn text<C: PreparedCloud>(
    question: &Question<'_, C>,
    found: &Found,
    shows_work: bool,
) -> String {
    let Question { arguments, scene, object, .. } = question;
    let of_scene = answers::text::Scene {
        is_cloud: !scene.is_mesh(),
        is_placed: arguments.asked.bodies().sensor_pose.is_some(),
    };
    let mut parts = vec![
        print::body("scene", scene),
        print::body("object", object),
        answers::text::text(&found.report, &found.placement, of_scene, shows_work),
    ];
    parts.extend(facts(found).iter().map(answers::text::line));
    parts.extend(found.gradient.as_ref().map(gradient::text));
    if let Some(probability) = arguments.penetration {
        parts.push(penetration::text(found.penetration.flatten().as_ref(), probability));
    }
    if !arguments.pose.is_given() {
        parts.push("pose                   not given: the identity".to_owned());
    }
    parts.join("\n")
}
