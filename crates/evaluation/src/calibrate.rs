//! `cargo xtask calibrate`: the surfaces that turn evidence into a probability.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

use anyhow::{Context, Result};
use clap::Args;
use cloudtouch::{
    CROSSING_KNOTS, ContactEvidence, DEVIATION_KNOTS, DOUBT_KNOTS, EXTENT_KNOTS, EXTENT_NOISES,
    Judge, MISCLASSIFIED_KNOTS, NOISE_KNOTS, ODDS_KNOTS, sharp_extent,
};
use cloudtouch_testkit::family::Kind;

use crate::answers::Answers;
use crate::measures::{Axis, SurfaceSample, border, fit_surface};
use crate::methods::{Fitted, Ours};
use crate::sweep::{Asked, ORACLE, OURS, Plan, ask};

/// What a pose of a scene that was chosen to be hard counts for, beside one of ordinary scenes: users live
/// in these, and should be told what is true there (docs/decisions/0020-whom-the-judge-serves.md).
const ADVERSARIAL: f64 = 0.25;

/// Values of a surface over geometry.
const GEOMETRY_VALUES: usize = DEVIATION_KNOTS.len() * CROSSING_KNOTS.len();
/// Knots of the noise up to which ordinary scenes are observed. Those beyond are fitted to denser ones, with
/// the last of these as it is, ...
const ORDINARY: usize = 3;
/// ... and up to this one as that.
const HELD: usize = 4;

/// What `cargo xtask calibrate` is given.
#[derive(Args)]
pub struct Arguments {
    /// Draws of each family
    #[arg(long, default_value_t = 16)]
    draws: u32,
    /// Poses of each draw
    #[arg(long, default_value_t = 20)]
    poses: usize,
    /// Fit what is beyond the noise of ordinary scenes, to far denser ones, and keep the rest as it is
    #[arg(long)]
    dense: bool,
    /// Keep the fit, in the lab and as the library's default
    #[arg(long)]
    update: bool,
}

/// Fits, prints, and keeps when asked to.
pub fn run(root: &Path, arguments: &Arguments) -> Result<()> {
    let Arguments { draws, poses, dense, update } = *arguments;
    let gathering = |ours: Ours| Asked::always(ours.gathering_everything());
    let command = format!("cargo xtask calibrate --draws {draws} --poses {poses}");
    let fitted = if dense {
        let answers = ask(&Plan::dense(draws, poses), &[gathering(Ours::new(OURS)?)])?;
        beyond(Fitted::read(root)?, &answers, &command)?
    } else {
        let methods = [gathering(Ours::new(OURS)?), gathering(Ours::oracle(ORACLE)?)];
        ordinary(&ask(&Plan::evidence(draws, poses), &methods)?, command)?
    };
    println!("{}", fitted.as_source());
    if update { fitted.write(root) } else { Ok(()) }
}

fn ordinary(answers: &Answers, command: String) -> Result<Fitted> {
    let fit = |method: &str, without| fit_judge(&records(answers, method, without)?);
    let without_each = |method: &str| -> Result<BTreeMap<String, Judge>> {
        let families = answers.families().into_iter();
        families.map(|family| Ok((family.to_owned(), fit(method, Some(family))?))).collect()
    };
    Ok(Fitted {
        command,
        all: fit(OURS, None)?,
        without: without_each(OURS)?,
        oracle_without: without_each(ORACLE)?,
    })
}

/// The same with what is beyond the noise of ordinary scenes fitted to answers about denser ones.
fn beyond(mut fitted: Fitted, answers: &Answers, command: &str) -> Result<Fitted> {
    fitted.command = format!("{} and {command} --dense", fitted.command);
    fitted.all = fit_beyond(fitted.all, &records(answers, OURS, None)?)?;
    for (family, judge) in &mut fitted.without {
        *judge = fit_beyond(*judge, &records(answers, OURS, Some(family))?)?;
    }
    Ok(fitted)
}

/// One answer that is fitted to.
struct Record {
    evidence: ContactEvidence,
    collides: bool,
    weight: f64,
}

impl Record {
    fn at<const D: usize>(&self, at: [f64; D]) -> SurfaceSample<D> {
        SurfaceSample { at, came: self.collides, weight: self.weight }
    }
}

/// Answers about all families but one, of clouds and of meshes alike.
fn records(answers: &Answers, method: &str, without: Option<&str>) -> Result<Vec<Record>> {
    let method = answers.index(method).with_context(|| format!("{method} did not answer"))?;
    let mut records: Vec<Record> = Vec::new();
    for (question, said) in &answers.rows {
        if without != Some(question.family) {
            let evidence =
                said[method].and_then(|s| s.evidence).context("an answer without evidence")?;
            let weight = if question.kind == Kind::Adversarial { ADVERSARIAL } else { 1.0 };
            records.push(Record { evidence, collides: question.collides, weight });
        }
    }
    Ok(records)
}

/// The surface over geometry first; then what the extent makes of it, and where that leaves doubt, how the
/// classifier revises it.
fn fit_judge(records: &[Record]) -> Result<Judge> {
    let mut judge = Judge::default().without_extent();
    fit_knots(&mut judge, records, 0..ORDINARY);
    fit_extent(&mut judge, records);
    for knot in ORDINARY..NOISE_KNOTS.len() {
        judge.by_geometry[knot] = judge.by_geometry[ORDINARY - 1];
    }
    let doubtful = |record: &Record| -> Option<SurfaceSample<2>> {
        let e = &record.evidence;
        let by_geometry = judge.log_odds_by_geometry(e);
        // Where the noise is as large as the patches the classifier says nothing.
        let at = [by_geometry, e.ln_misclassified()?];
        is_within(&DOUBT_KNOTS, by_geometry).then_some(record.at(at))
    };
    let in_doubt: Vec<_> = records.iter().filter_map(doubtful).collect();
    let doubt = Axis { knots: &DOUBT_KNOTS, usual: Some(1.0) };
    let misclassified = Axis { knots: &MISCLASSIFIED_KNOTS, usual: Some(0.2) };
    let pins = border(&DOUBT_KNOTS, MISCLASSIFIED_KNOTS.len());
    let revised = fit_surface(&in_doubt, [doubt, misclassified], &pins);
    judge.revised.as_flattened_mut().copy_from_slice(&revised);
    judge.validate()?;
    Ok(judge)
}

/// The same beyond the noise of ordinary scenes, where no classifier is asked.
fn fit_beyond(mut judge: Judge, records: &[Record]) -> Result<Judge> {
    fit_knots(&mut judge, records, HELD - 1..NOISE_KNOTS.len());
    judge.validate()?;
    Ok(judge)
}

/// The surfaces at these knots of the noise; the first of them stays as it is, unless it is the first of all.
fn fit_knots(judge: &mut Judge, records: &[Record], knots: Range<usize>) {
    let from = NOISE_KNOTS[knots.start];
    let records: Vec<&Record> =
        records.iter().filter(|record| record.evidence.scatter_over_spacing >= from).collect();
    let is_given = knots.start > 0;
    let noise = Axis { knots: &NOISE_KNOTS[knots.clone()], usual: None };
    // Fewer deviations make a collision more probable: the axis is turned round, and back again.
    let mut nearness = DEVIATION_KNOTS.map(|z| -z);
    nearness.reverse();
    let by_all = |record: &&Record| {
        let e = &record.evidence;
        record.at([e.scatter_over_spacing, -e.deviations, e.crossing])
    };
    let mut geometry: Vec<SurfaceSample<3>> = records.iter().map(by_all).collect();
    geometry.extend(within(noise.knots));
    let nearness = Axis { knots: &nearness, usual: Some(3.0) };
    let crossing = Axis { knots: &CROSSING_KNOTS, usual: Some(2.0) };
    let mut given = judge.by_geometry[knots.start];
    given.reverse();
    let pins = given.as_flattened().iter().copied().enumerate();
    let pins: Vec<(usize, f64)> = pins.filter(|_| is_given).collect();
    let fitted = fit_surface(&geometry, [noise, nearness, crossing], &pins);
    let surfaces = judge.by_geometry[knots.clone()].iter_mut();
    for (surface, values) in surfaces.zip(fitted.chunks(GEOMETRY_VALUES)) {
        surface.as_flattened_mut().copy_from_slice(values);
        surface.reverse();
    }
}

/// What the extent makes of it, up to the noise from which on it changes nothing.
fn fit_extent(judge: &mut Judge, records: &[Record]) {
    let changeable = |record: &Record| -> Option<SurfaceSample<3>> {
        let e = &record.evidence;
        let by_place = judge.log_odds_by_place(e);
        let extent = sharp_extent(e.extent?, e.noise_over_spacing);
        let at = [by_place, e.noise_over_spacing, -extent.ln_1p()];
        is_within(&ODDS_KNOTS, by_place).then_some(record.at(at))
    };
    let open: Vec<_> = records.iter().filter_map(changeable).collect();
    let noises = &NOISE_KNOTS[..=EXTENT_NOISES];
    let noise = Axis { knots: noises, usual: None };
    let odds = Axis { knots: &ODDS_KNOTS, usual: Some(1.0) };
    let extent = Axis { knots: &EXTENT_KNOTS, usual: Some(0.0) };
    let row = noises.len() * EXTENT_KNOTS.len();
    let mut pins = border(&ODDS_KNOTS, row);
    for (knot, odds) in ODDS_KNOTS.into_iter().enumerate() {
        let last = (knot + 1) * row - EXTENT_KNOTS.len();
        pins.extend((0..EXTENT_KNOTS.len()).map(|column| (last + column, odds)));
    }
    let fitted = fit_surface(&open, [odds, noise, extent], &pins);
    for (row, values) in fitted.chunks(row).enumerate() {
        for (of_noise, values) in
            judge.over_extent.iter_mut().zip(values.chunks(EXTENT_KNOTS.len()))
        {
            of_noise[row].copy_from_slice(values);
        }
    }
}

fn is_within(knots: &[f64], value: f64) -> bool {
    knots[0] < value && value < knots[knots.len() - 1]
}

/// Clouds wholly within solids, which hardly a pose that comes from outside is: a point clearly inside
/// is a collision by what the words mean, whatever crosses.
fn within(noises: &[f64]) -> impl Iterator<Item = SurfaceSample<3>> {
    const CLEARLY_INSIDE: f64 = -4.0;
    const WEIGHT: f64 = 100.0;
    let inside = DEVIATION_KNOTS.into_iter().filter(|&z| z <= CLEARLY_INSIDE);
    let places =
        inside.flat_map(|z| CROSSING_KNOTS.into_iter().map(move |crossing| (-z, crossing)));
    let at_each =
        move |(nearness, crossing)| noises.iter().map(move |&noise| [noise, nearness, crossing]);
    let weight = WEIGHT / noises.len() as f64;
    places.flat_map(at_each).map(move |at| SurfaceSample { at, came: true, weight })
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;

    use super::*;
    use crate::answers::tests::evidence as by_geometry;

    fn evidence(deviations: f64, crossing: f64, count: f64, noise: f64) -> ContactEvidence {
        ContactEvidence { misclassified: Some(count), ..by_geometry(deviations, crossing, noise) }
    }

    #[test]
    fn a_judge_that_made_the_truth_is_found_again() {
        let unit = |i: u64, k: u64| seed::unit(seed::derive(7, i, k));
        let record = |i| {
            let (deviations, crossing) = (6.0 * unit(i, 0), 5.0 * unit(i, 1));
            let count = 10.0 * unit(i, 2) * unit(i, 2);
            let noise = 2.0 * unit(i, 4);
            let evidence = evidence(deviations, crossing, count, noise);
            let log_odds = crossing * (1.2 - 0.4 * noise) - 1.5 * deviations + 0.5 * (count - 3.0);
            let collides = unit(i, 3) < 1.0 / (1.0 + (-log_odds).exp());
            Record { evidence, collides, weight: 1.0 }
        };
        let records: Vec<_> = (0..30_000).map(record).collect();
        let judge = fit_judge(&records).unwrap();
        // Averaged over what the classifier says, odds are nearer to even.
        let odds = |noise| judge.log_odds_by_geometry(&evidence(1.0, 3.6, 3.0, noise));
        assert!((1.0..2.4).contains(&odds(0.5)), "{}", odds(0.5));
        assert!((1.5..3.5).contains(&(odds(0.0) - odds(2.0))), "{} {}", odds(0.0), odds(2.0));
        // Where geometry leaves it open, the classifier decides.
        let counted = |count| judge.log_odds(&evidence(2.4, 3.6, count, 0.5));
        assert!(counted(8.0) > 0.8 && counted(0.1) < -0.5, "{} {}", counted(8.0), counted(0.1));
    }
}
