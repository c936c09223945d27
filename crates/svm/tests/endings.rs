//! How a solve ended, and what a caller sees of it meanwhile.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use std::ops::ControlFlow;

use crate::support::{Difficulty, cell, settings, solver};
use cloudtouch_svm::{
    Class, Kernel, Problem, Progress, Rung, Sample, Settings, SettingsError, Solver, Status,
};

fn problem(difficulty: Difficulty, per_side: usize, seed: u64) -> Problem {
    let (samples, gamma) = cell(difficulty, per_side, seed);
    Problem::new(&samples, Kernel::Gaussian { gamma }).unwrap()
}

/// Nothing separates a cloud from itself, however tightly it is asked.
#[test]
fn a_collapse_was_hidden_behind_a_tolerance_out_of_reach() {
    let (samples, gamma) = cell(Difficulty::Contact, 8, 1);
    let a: Vec<Sample> = samples.into_iter().filter(|s| s.class == Class::A).collect();
    let mut both = a.clone();
    both.extend(a.iter().map(|s| {
        let mut twin = Sample { class: Class::B, ..*s };
        twin.point.mean.x += 1e-7;
        twin
    }));
    let problem = Problem::new(&both, Kernel::Gaussian { gamma }).unwrap();
    for gap in [1e-3, 1e-8, 1e-12, 1e-16] {
        let solution = problem.solve(&settings(gap)).unwrap();
        assert_eq!(solution.status, Status::Collapsed, "{gap:e}: {}", solution.relative_gap);
    }
}

#[test]
fn one_status_stood_for_all_that_fell_short() {
    let hard = problem(Difficulty::Hard, 20, 1);
    let alone = Settings { fallback: false, ..settings(1e-8) };
    let few = hard.solve(&Settings { max_steps: Some(20), ..alone }).unwrap();
    assert_eq!((few.status, few.ends.smo), (Status::StepLimit, Some(Status::StepLimit)));
    assert_eq!(few.ends.interior_point, None);
    assert_eq!(hard.solve(&alone).unwrap().status, Status::SlowProgress);
    let with_others = hard.solve(&settings(1e-8)).unwrap();
    assert_eq!(with_others.status, Status::Converged);
    assert_eq!(with_others.ends.smo, Some(Status::SlowProgress));
    assert_eq!(with_others.ends.interior_point, Some(Status::Converged));
    assert_eq!(with_others.ends.clarabel, None);

    // No rung gets that far: rounding is in the way.
    let out_of_reach = hard.solve(&settings(1e-18)).unwrap();
    assert_eq!(out_of_reach.ends.interior_point, Some(Status::Stalled));
    let clarabel = out_of_reach.ends.clarabel;
    if cfg!(feature = "clarabel") {
        assert!(clarabel.is_some() && clarabel != Some(Status::NotBuilt));
    } else {
        assert_eq!((clarabel, out_of_reach.status), (Some(Status::NotBuilt), Status::Stalled));
    }
}

#[test]
fn endings_read_as_sentences() {
    for status in [Status::Converged, Status::TooLarge, Status::NotBuilt, Status::Cancelled] {
        assert!(status.to_string().len() > 5);
    }
    assert_eq!(Rung::Smo.to_string(), "SMO");
}

#[test]
fn the_log_shows_every_rung_closing_in() {
    let hard = problem(Difficulty::Hard, 20, 1);
    let mut log: Vec<Progress> = Vec::new();
    let watched = solver(&settings(1e-6)).solve_watched(&hard, None, &mut |progress| {
        log.push(*progress);
        ControlFlow::Continue(())
    });
    assert_eq!(watched, hard.solve(&settings(1e-6)).unwrap());
    let of = |rung| log.iter().filter(move |p| p.rung == rung);
    assert!(of(Rung::Smo).count() > 2);
    assert_eq!(of(Rung::InteriorPoint).count(), watched.effort.interior_iterations + 1);
    let last = of(Rung::InteriorPoint).next_back().unwrap();
    assert!(last.relative_gap <= 1e-6 && last.dual <= last.primal);
    assert!(last.violation < of(Rung::Smo).next().unwrap().violation);
    for progress in &log {
        assert!(progress.dual <= progress.primal * (1.0 + 1e-9), "{progress:?}");
    }
}

#[test]
fn a_watch_that_breaks_ends_the_solve_with_what_it_has() {
    let hard = problem(Difficulty::Hard, 20, 1);
    let whole = hard.solve(&settings(1e-8)).unwrap();
    for looks in [1, 3, 8, 60] {
        let mut left = looks;
        let stopped = solver(&settings(1e-8)).solve_watched(&hard, None, &mut |_| {
            left -= 1;
            if left == 0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        let cut_short = left == 0;
        assert_eq!(stopped.status == Status::Cancelled, cut_short, "{looks} looks");
        assert!(left >= 0 && stopped.relative_gap >= whole.relative_gap);
        // What there is, is feasible and says how good it is.
        assert!(stopped.dual <= whole.primal && whole.dual <= stopped.primal);
    }
}

#[test]
fn a_solver_used_before_answers_as_a_new_one() {
    let mut used = Solver::new(settings(1e-6)).unwrap();
    for (difficulty, per_side) in
        [(Difficulty::Hard, 15), (Difficulty::Easy, 20), (Difficulty::Contact, 4)]
    {
        let problem = problem(difficulty, per_side, 3);
        assert_eq!(used.solve(&problem), problem.solve(&settings(1e-6)).unwrap());
    }
}

#[test]
fn settings_out_of_range_are_refused_before_anything_is_done() {
    let bad = settings(f64::NAN);
    assert!(matches!(Solver::new(bad), Err(SettingsError::RelativeGap { .. })));
    assert!(problem(Difficulty::Easy, 4, 1).solve(&settings(0.0)).is_err());
}
