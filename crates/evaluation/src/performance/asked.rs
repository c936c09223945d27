//! Methods that take turns at every pose: what they say, how long that takes, how often it is wrong.

use anyhow::{Context, Result};

use super::{
    methods::{Method, Said},
    scene::{Class, Posed},
    timing::timed,
};
use crate::{
    measures::{Sample, auc},
    table::Table,
};

/// How often each query is timed; the least counts.
const REPEATS: usize = 7;

/// What one method said of all poses and how long it took.
pub(super) struct Asked {
    pub(super) name: &'static str,
    /// Time to prepare both bodies, s.
    pub(super) prepare: f64,
    answers: Vec<Answer>,
}

struct Answer {
    posed: Posed,
    said: Said,
    /// The least of the repeats, s.
    seconds: f64,
}

/// Asks every method about each pose once, which is not timed, and then in turn.
pub(super) fn ask_in_turn(methods: &[Method], poses: &[Posed]) -> Result<Vec<Asked>> {
    let start = |m: &Method| Asked { name: m.name, prepare: m.prepare, answers: Vec::new() };
    let mut asked: Vec<Asked> = methods.iter().map(start).collect();
    for posed in poses {
        for (method, asked) in methods.iter().zip(&mut asked) {
            let said = (method.ask)(&posed.pose).context(method.name)?;
            asked.answers.push(Answer { posed: *posed, said, seconds: f64::INFINITY });
        }
        for _ in 0..REPEATS {
            for (method, asked) in methods.iter().zip(&mut asked) {
                let (said, seconds) = timed(|| (method.ask)(&posed.pose));
                said?;
                if let Some(answer) = asked.answers.last_mut() {
                    answer.seconds = answer.seconds.min(seconds);
                }
            }
        }
    }
    Ok(asked)
}

/// The times of a method, of one class or of all poses, s; nothing of a method not asked.
pub(super) fn seconds(asked: &[Asked], name: &str, class: Option<Class>) -> Vec<f64> {
    let found = asked.iter().find(|a| a.name == name);
    found.map(|a| a.of(class).map(|answer| answer.seconds).collect()).unwrap_or_default()
}

impl Asked {
    fn of(&self, class: Option<Class>) -> impl Iterator<Item = &Answer> {
        self.answers.iter().filter(move |a| class.is_none_or(|class| a.posed.class == class))
    }

    /// Chance that a collision has the higher score.
    pub(super) fn auc(&self, class: Option<Class>) -> f64 {
        let scored = self.of(class).map(|a| (a.said.score, a.posed.collides));
        let sample = Sample::of_probabilities(scored);
        auc(&sample, &sample.ones())
    }
}

/// How wrong each method is on these very poses.
pub(super) fn errors(asked: &[Asked]) -> Table {
    let mut table = Table::new(["method", "AUC", "AUC, near", "false stops", "misses"]);
    let three = |value: f64| if value.is_nan() { "-".into() } else { format!("{value:.3}") };
    for a in asked {
        let wrong = |collides: bool| {
            let of = a.answers.iter().filter(|answer| answer.posed.collides == collides);
            let verdicts: Option<Vec<bool>> = of.map(|answer| answer.said.verdict).collect();
            verdicts.map_or("-".into(), |v| {
                format!("{} of {}", v.iter().filter(|v| **v != collides).count(), v.len())
            })
        };
        let [all, near] = [None, Some(Class::Near)].map(|class| three(a.auc(class)));
        table.row([a.name.into(), all, near, wrong(false), wrong(true)]);
    }
    table
}

#[cfg(test)]
pub(super) mod tests {
    use std::{cell::RefCell, rc::Rc};

    use cloudtouch_geom::Pose;

    use super::*;

    /// Says a free far, a free near and a deep pose to be what is given, with these times.
    pub(in super::super) fn asked(
        name: &'static str,
        verdicts: [bool; 3],
        seconds: [f64; 3],
    ) -> Asked {
        let answer = |i: usize| {
            let (class, collides) = (Class::ALL[i], i == 2);
            let posed = Posed { class, collides, pose: Pose::identity() };
            Answer { posed, said: verdicts[i].into(), seconds: seconds[i] }
        };
        Asked { name, prepare: 0.01, answers: (0..3).map(answer).collect() }
    }

    #[test]
    fn false_stops_and_misses_are_counted_apart() {
        let wrong = [asked("wrong", [false, true, false], [1.0, 2.0, 3.0])];
        let table = errors(&wrong).to_string();
        assert!(table.contains("| 0.250 | -         | 1 of 2      | 1 of 1"), "{table}");
        assert_eq!(seconds(&wrong, "wrong", Some(Class::Near)), [2.0]);
        assert_eq!(seconds(&wrong, "wrong", None), [1.0, 2.0, 3.0]);
    }

    #[test]
    fn methods_take_turns_and_the_first_answer_is_not_timed() {
        let calls = Rc::new(RefCell::new(String::new()));
        let method = |name: &'static str| {
            let calls = Rc::clone(&calls);
            let ask = move |_: &Pose| {
                calls.borrow_mut().push_str(name);
                Ok(Said { score: 0.0, verdict: None })
            };
            Method { name, prepare: 0.0, ask: Box::new(ask) }
        };
        let posed = Posed { class: Class::Far, collides: false, pose: Pose::identity() };
        let asked = ask_in_turn(&[method("a"), method("b")], &[posed]).unwrap();
        assert_eq!(*calls.borrow(), "ab".repeat(1 + REPEATS));
        assert!(asked.iter().all(|a| a.answers.len() == 1 && a.answers[0].seconds < 1.0));
    }
}
