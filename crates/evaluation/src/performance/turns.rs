//! Methods that take turns over all poses: what they say, how long that takes, how often it is wrong.

use anyhow::{Context, Result};
use cloudtouch_testkit::poses::LabelledPose;
use cloudtouch_testkit::poses_by_class::Class;

use super::timing::{ratio, time, timed, times};
use crate::answers::Pair;
use crate::measures::{Sample, auc, wrong_from};
use crate::methods::{Draw, Method};
use crate::report::Table;
use crate::statistics::median;

/// How often each query is timed; the least counts.
const REPEATS: usize = 7;

/// What one method said of all poses and how long it took.
pub(super) struct Timed {
    pub(super) name: String,
    /// Time to prepare both bodies, s.
    pub(super) prepare: f64,
    answers: Vec<Answer>,
}

struct Answer {
    pose: LabelledPose,
    score: f64,
    /// The least of the repeats, s.
    seconds: f64,
}

/// Prepares every method, asks each about all poses once, which is not timed, and then in turn. As a planner asks, the
/// poses follow one another: what other methods hold is not fetched between two of them.
pub(super) fn take_turns(
    methods: &[&dyn Method],
    draw: &Draw<'_>,
    pair: Pair,
    poses: &[LabelledPose],
) -> Result<Vec<Timed>> {
    let mut prepared = Vec::new();
    let mut all = Vec::new();
    for method in methods {
        let (ready, prepare) = timed(|| method.prepare(draw)).context(method.name())?;
        prepared.push(ready);
        let unanswered =
            |pose: &LabelledPose| Answer { pose: *pose, score: f64::NAN, seconds: f64::INFINITY };
        let answers = poses.iter().map(unanswered).collect();
        all.push(Timed { name: method.name(), prepare, answers });
    }
    for repeat in 0..=REPEATS {
        for (ready, timed_before) in prepared.iter().zip(&mut all) {
            for answer in &mut timed_before.answers {
                let (said, seconds) = timed(|| ready(pair, &answer.pose.scene_from_object))?;
                answer.score = said.context("an answer to such a pair")?.score;
                if repeat > 0 {
                    answer.seconds = answer.seconds.min(seconds);
                }
            }
        }
    }
    Ok(all)
}

impl Timed {
    fn of(&self, class: Option<Class>) -> impl Iterator<Item = &Answer> {
        let is_of = move |a: &&Answer| class.is_none() || Class::of(&a.pose) == class;
        self.answers.iter().filter(is_of)
    }

    /// Its times at the poses of one class or of all, s.
    pub(super) fn seconds(&self, class: Option<Class>) -> Vec<f64> {
        self.of(class).map(|answer| answer.seconds).collect()
    }

    /// What it says beside what is true.
    fn sample(&self, class: Option<Class>) -> Sample {
        Sample::of_probabilities(self.of(class).map(|a| (a.score, a.pose.in_collision)))
    }

    /// Chance that a collision has the higher score.
    fn auc(&self, class: Option<Class>) -> f64 {
        let sample = self.sample(class);
        auc(&sample, &sample.ones())
    }

    /// Free poses it calls collisions, and collisions it calls free.
    fn wrong(&self) -> [f64; 2] {
        let sample = self.sample(None);
        wrong_from(&sample, &sample.ones(), 0.5).map(|[count, _]| count)
    }
}

/// Times by class of pose, and errors on the same poses; the first method is compared with all.
/// A score below zero is a distance, which has no threshold, so no verdict.
pub(super) fn table(all: &[Timed]) -> Table {
    const HEADER: &str = "method, prepare, far median, near median, near p95, deep median, \
                          all median, first to it, AUC, AUC near, false stops, misses";
    let mut table = Table::new(HEADER.split(", "));
    let first = all.first().map_or(f64::NAN, |first| median(&first.seconds(None)));
    for timed in all {
        let middle = |class| time(median(&timed.seconds(class)));
        let near = Some(Class::Near);
        let is_verdict = timed.answers.iter().all(|a| a.score >= 0.0);
        let mut row = vec![timed.name.clone(), time(timed.prepare), middle(Some(Class::Far))];
        row.extend(times(&timed.seconds(near)));
        row.extend([middle(Some(Class::Deep)), middle(None)]);
        row.push(ratio(first / median(&timed.seconds(None))));
        row.extend([None, near].map(|class| format!("{:.3}", timed.auc(class))));
        row.extend(timed.wrong().map(|n| if is_verdict { n.to_string() } else { "-".into() }));
        table.row(row);
    }
    table
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Pose;

    use super::*;

    #[test]
    fn false_stops_and_misses_are_counted_apart() {
        let answer = |(score, in_collision)| {
            let scene_from_object = Pose::identity();
            let pose = LabelledPose { scene_from_object, in_collision, signed_distance: 0.0 };
            Answer { pose, score, seconds: 1.0 }
        };
        let answers = [(0.9, false), (0.2, false), (0.6, false), (0.4, true)].map(answer);
        let timed = Timed { name: "t".into(), prepare: 0.0, answers: answers.into() };
        assert_eq!(timed.wrong(), [2.0, 1.0]);
        assert!((timed.auc(None) - 1.0 / 3.0).abs() < 1e-12);
        assert!(timed.auc(Some(Class::Far)).is_nan());
    }
}
