//! One position or a path of them, asked about.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::Result;
use cloudtouch::geom::Point3;
use cloudtouch::{PairAnswer, Query, Verdict};
use cloudtouch_cli::files::joints::Joints;
use cloudtouch_page::Fact;
use cloudtouch_robot::{RobotChecker, SURROUNDINGS};

use crate::answers::robot::Asked;
use crate::answers::scene::Bodies;
use crate::commands::scene::bodies::Prepared;
use crate::{answers, pages};

/// How finely a path is looked at, as a share of it.
const TOLERANCE: f64 = 0.001;

/// Who is asked, and how it is told.
pub(super) struct Ask<'a> {
    pub checker: &'a RobotChecker,
    pub query: &'a Query,
    /// The bodies that are no links.
    pub prepared: BTreeMap<&'a str, &'a Prepared>,
    pub asked: Asked<'a>,
    pub in_json: bool,
    /// Where a page goes, if one is wanted.
    pub page: Option<Page<'a>>,
}

/// A page that shows the answer.
pub(super) struct Page<'a> {
    pub output: &'a Path,
    pub title: String,
}

pub(super) struct Answer {
    pub text: String,
    pub verdict: Verdict,
    /// Whether a pair has no answer.
    pub has_failed: bool,
}

impl Ask<'_> {
    /// Asks about one position, or about a path where there are several.
    pub(super) fn about(&self, path: &[Joints]) -> Result<Answer> {
        let boxes = path.iter().map(|joints| self.checker.boxes(joints));
        let boxes = boxes.collect::<Result<Vec<_>, _>>()?;
        match path {
            [joints] => self.position(joints, self.bodies(&boxes[0])),
            _ => self.path(path, boxes.iter().map(|boxes| self.bodies(boxes)).collect()),
        }
    }

    fn bodies<'a>(&'a self, boxes: &'a BTreeMap<String, [Point3; 2]>) -> Bodies<'a> {
        Bodies {
            inputs: self.prepared.iter().map(|(name, of)| (*name, &of.input)).collect(),
            boxes: boxes.iter().map(|(name, corners)| (name.as_str(), *corners)).collect(),
        }
    }

    fn position(&self, joints: &Joints, bodies: Bodies<'_>) -> Result<Answer> {
        let checked = self.checker.check(self.query, joints)?;
        answers::scene::warn_of_nothing_asked(&checked);
        let threshold = self.query.settings().reject;
        if let Some(page) = &self.page {
            let scene = self.checker.scene_at(joints)?;
            let (found, words) = ((&scene, &checked), self.words(page));
            let taken_for = |name: &str| self.taken_for(name);
            pages::scene::write(page.output, found, Some(SURROUNDINGS), words, taken_for)?;
        }
        let text = if self.in_json {
            answers::robot::json_line(&checked, threshold, bodies, self.asked)?
        } else {
            [
                answers::robot::place(&bodies),
                answers::robot::worst(&checked),
                answers::scene::text(&checked, threshold),
            ]
            .concat()
        };
        let has_failed = checked.pairs.iter().any(is_without_answer);
        Ok(Answer { text, verdict: checked.verdict(), has_failed })
    }

    /// What a body was taken for; of links that is the URDF's to say.
    fn taken_for(&self, name: &str) -> String {
        self.prepared.get(name).map_or(String::new(), |of| of.words.clone())
    }

    /// The title of a page, and what is to be said of the question.
    fn words(&self, page: &Page<'_>) -> (String, Vec<Fact>) {
        (page.title.clone(), self.asked.facts())
    }

    fn path(&self, path: &[Joints], bodies: Vec<Bodies<'_>>) -> Result<Answer> {
        let checked = self.checker.check_path(self.query, path, TOLERANCE)?;
        // Which pairs are asked about is the same at all of them.
        checked.given.iter().take(1).for_each(answers::scene::warn_of_nothing_asked);
        if let Some(page) = &self.page {
            let found = (self.checker, path, &checked);
            let taken_for = |name: &str| self.taken_for(name);
            pages::robot::write(page.output, found, self.words(page), taken_for)?;
        }
        let text = if self.in_json {
            let threshold = self.query.settings().reject;
            answers::robot::path_line(&checked, threshold, bodies, self.asked)?
        } else {
            let place = bodies.first().map_or(String::new(), answers::robot::place);
            place + &answers::robot::path_text(&checked)
        };
        let pairs = checked.given.iter().flat_map(|at| &at.pairs);
        let mut pairs = pairs.chain(checked.stopped.as_ref().and_then(|at| at.pair.as_ref()));
        Ok(Answer { text, verdict: checked.verdict(), has_failed: pairs.any(is_without_answer) })
    }
}

fn is_without_answer(pair: &PairAnswer) -> bool {
    pair.answer.is_err()
}
