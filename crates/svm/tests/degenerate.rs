//! Hard inputs: no panic, no NaN, bounded work, and an honest ending.
#![allow(clippy::unwrap_used, reason = "a panic is how a test fails, in its helpers too")]

use crate::support::{Stream, settings, solver};
use cloudtouch_geom::{Covariance, Point3, UncertainPoint, Vector3};
use cloudtouch_svm::{
    Class, Classifier, Kernel, Problem, Rung, Sample, Settings, Solution, Status,
};

fn sample(at: [f64; 3], class: Class, std: f64, penalty: f64) -> Sample {
    let covariance = Covariance::isotropic(std * std);
    Sample {
        point: UncertainPoint { mean: Point3::from(at), covariance },
        class,
        radius: 1.0,
        penalty,
    }
}

/// Solves with both kernels and the default settings; checks what must hold for every input.
fn check(samples: &[Sample], gamma: f64) -> Vec<Solution> {
    [Kernel::Linear, Kernel::Gaussian { gamma }]
        .into_iter()
        .map(|kernel| {
            let problem = Problem::new(samples, kernel).unwrap();
            let solution = problem.solve(&Settings::default()).unwrap();
            assert_ne!(solution.status, Status::NotFinite, "{kernel:?}");
            assert!(solution.alpha.iter().all(|a| a.is_finite()));
            assert!(solution.v.iter().flat_map(|v| v.iter()).all(|v| v.is_finite()));
            for value in [solution.bias, solution.primal, solution.dual, solution.relative_gap] {
                assert!(value.is_finite());
            }
            let n = samples.len();
            assert!(solution.effort.smo_steps <= n * n / 2 + 50 + 20 * n);
            assert!(solution.dual <= solution.primal * (1.0 + 1e-9));
            if matches!(solution.status, Status::Converged | Status::Collapsed) {
                assert!(solution.relative_gap <= 1e-3);
            }
            if solution.status == Status::Collapsed {
                assert!(Classifier::new(&problem, &solution).is_err());
            }
            solution
        })
        .collect()
}

fn grid(
    count: usize,
    place: impl Fn(f64) -> [f64; 3],
    class: Class,
    std: f64,
    penalty: f64,
) -> Vec<Sample> {
    (0..count).map(|k| sample(place(k as f64 / count as f64), class, std, penalty)).collect()
}

fn all_converged(solutions: &[Solution]) -> bool {
    solutions.iter().all(|s| s.status == Status::Converged)
}

#[test]
fn identical_clouds_collapse() {
    let mut stream = Stream::new(1);
    for std in [0.0, 0.01, 1.0] {
        for penalty in [1e-2, 100.0, 1e6] {
            let a: Vec<Sample> = (0..12)
                .map(|_| {
                    let at = [stream.unit(), stream.unit(), stream.unit()];
                    sample(at, Class::A, std, penalty)
                })
                .collect();
            let b = a.iter().map(|s| Sample { class: Class::B, ..*s });
            let both: Vec<Sample> = a.iter().copied().chain(b).collect();
            for solution in check(&both, 10.0) {
                assert_eq!(solution.status, Status::Collapsed, "std {std} penalty {penalty}");
            }
        }
    }
}

#[test]
fn ellipsoids_larger_than_the_scene_leave_no_plane() {
    let mut both = grid(10, |t| [t, 0.0, 0.1], Class::A, 10.0, 100.0);
    both.extend(grid(10, |t| [t, 0.0, 0.0], Class::B, 10.0, 100.0));
    // The Gaussian kernel can still bend f flat at every point, so only the plane must collapse.
    assert_eq!(check(&both, 10.0)[0].status, Status::Collapsed);
}

#[test]
fn one_point_a_side_and_one_against_many() {
    let pair =
        [sample([0.0; 3], Class::A, 0.01, 100.0), sample([0.5, 0.0, 0.0], Class::B, 0.01, 100.0)];
    assert!(all_converged(&check(&pair, 5.0)));
    let mut many = grid(3000, |t| [t, (37.0 * t).sin(), 0.0], Class::B, 0.001, 10.0);
    many.push(sample([0.5, 0.0, 0.4], Class::A, 0.01, 1000.0));
    let problem = Problem::new(&many, Kernel::Gaussian { gamma: 5.0 }).unwrap();
    let solution =
        problem.solve(&Settings { max_steps: Some(2000), ..Settings::default() }).unwrap();
    assert_eq!(solution.status, Status::Converged);
}

#[test]
fn equal_points_collinear_and_coplanar_clouds() {
    let same = |class, z| vec![sample([0.1, 0.2, z], class, 0.01, 100.0); 7];
    assert!(all_converged(&check(&[same(Class::A, 0.3), same(Class::B, 0.0)].concat(), 5.0)));
    for solution in check(&[same(Class::A, 0.0), same(Class::B, 0.0)].concat(), 5.0) {
        assert_eq!(solution.status, Status::Collapsed);
    }
    let line = |class, from: f64| grid(9, move |t| [from + 0.4 * t, 0.0, 0.0], class, 0.001, 100.0);
    assert!(all_converged(&check(&[line(Class::A, 0.0), line(Class::B, 0.6)].concat(), 5.0)));
    // Interleaved on one line and in one plane: only that it ends is asked.
    check(&[line(Class::A, 0.0), line(Class::B, 0.02)].concat(), 5.0);
    let plane = |class, shift: f64| {
        grid(25, move |t| [(25.0 * t % 5.0) / 5.0 + shift, t, 0.0], class, 0.01, 100.0)
    };
    check(&[plane(Class::A, 0.0), plane(Class::B, 0.1)].concat(), 5.0);
}

#[test]
fn a_cloud_that_is_part_of_the_other() {
    let whole = grid(20, |t| [t, 0.3 * t * t, 0.0], Class::A, 0.01, 100.0);
    let part = whole.iter().take(5).map(|s| Sample { class: Class::B, ..*s });
    check(&whole.iter().copied().chain(part).collect::<Vec<_>>(), 10.0);
}

#[test]
fn extreme_penalties_and_widths() {
    let mut stream = Stream::new(3);
    for penalty in [1e-3, 1e3, 1e9] {
        for gamma in [1e-6, 1.0, 1e6] {
            for gap in [-0.1, 0.2] {
                let cloud = |class: Class, z: f64, stream: &mut Stream| -> Vec<Sample> {
                    (0..12)
                        .map(|_| {
                            let at = [stream.unit(), stream.unit(), z + 0.05 * stream.unit()];
                            sample(at, class, 0.02, penalty)
                        })
                        .collect()
                };
                let a = cloud(Class::A, gap, &mut stream);
                let b = cloud(Class::B, 0.0, &mut stream);
                check(&[a, b].concat(), gamma);
            }
        }
    }
}

#[test]
fn singular_and_badly_conditioned_covariances() {
    let shapes = [
        Covariance::diagonal([1e-2, 0.0, 0.0]),
        Covariance::diagonal([1e-2, 1e-14, 1e-14]),
        Covariance::diagonal([1e-2, 1e-2, 0.0]),
        Covariance::diagonal([1e-300, 0.0, 0.0]),
    ];
    for covariance in shapes {
        let with = |s: Sample| Sample { point: UncertainPoint { covariance, ..s.point }, ..s };
        let mut both = grid(10, |t| [t, 0.1 * t, 0.2], Class::A, 0.0, 100.0);
        both.extend(grid(10, |t| [t, -0.1 * t, 0.0], Class::B, 0.0, 100.0));
        let both: Vec<Sample> = both.into_iter().map(with).collect();
        assert!(all_converged(&check(&both, 10.0)), "{covariance:?}");
    }
}

#[test]
fn numbers_out_of_range_never_converge() {
    let huge =
        [sample([1e200; 3], Class::A, 0.0, 1.0), sample([-1e200, 0.0, 0.0], Class::B, 0.0, 1.0)];
    let problem = Problem::new(&huge, Kernel::Linear).unwrap();
    let solution = problem.solve(&Settings::default()).unwrap();
    assert!(!matches!(solution.status, Status::Converged), "{:?}", solution.status);
    assert!(Classifier::new(&problem, &solution).is_err());
}

/// The relative gap stays near 1 for more than ten iterations while multipliers grow from 10 to 1e7.
#[test]
fn the_interior_point_method_gave_up_while_multipliers_grew_to_a_large_penalty() {
    for (penalty, gamma) in
        [(1e6, 1.0), (1e7, 1.0), (1e7, 10.0), (1e9, 0.1), (1e9, 1.0), (1e9, 10.0)]
    {
        let mut stream = Stream::new(17);
        // Sheets that cross: slack at many points, so that their multipliers go to the penalty.
        let mut sheet = |class: Class, slope: f64| -> Vec<Sample> {
            let mut at = |_| {
                let (x, y) = (stream.unit() - 0.5, stream.unit() - 0.5);
                sample([x, y, slope * x + 0.01 * stream.unit()], class, 0.02, penalty)
            };
            (0..30).map(&mut at).collect()
        };
        let both = [sheet(Class::A, 0.4), sheet(Class::B, 0.0)].concat();
        let problem = Problem::new(&both, Kernel::Gaussian { gamma }).unwrap();
        let solution = problem.solve(&settings(1e-4)).unwrap();
        let place = format!("C {penalty}, gamma {gamma}: {:?}", solution.rung);
        assert_eq!(solution.status, Status::Converged, "{place}");
        assert_ne!(solution.rung, Rung::Clarabel, "{place}");
    }
}

/// Its answer was said to have converged where only what it solves had: the gap of all points was
/// thousands of times the tolerance.
#[test]
fn what_is_said_to_have_converged_is_within_its_tolerance() {
    let mut stream = Stream::new(23);
    for case in 0..400 {
        let penalty = stream.log_range(1e8, 1e11);
        let mut point = |class| {
            let at = [stream.unit(), stream.unit(), 0.3 * stream.unit()];
            sample(at, class, 0.0, penalty)
        };
        let classes = [[Class::A; 4], [Class::B; 4]];
        let samples: Vec<Sample> = classes.into_iter().flatten().map(&mut point).collect();
        let kernel = Kernel::Gaussian { gamma: stream.log_range(0.1, 50.0) };
        let problem = Problem::new(&samples, kernel).unwrap();
        let solution = problem.solve(&settings(1e-8)).unwrap();
        let converged = [Some(solution.status), solution.ends.smo, solution.ends.interior_point];
        if converged.contains(&Some(Status::Converged)) {
            assert!(solution.relative_gap <= 1e-8, "{case}: {solution:?}");
        }
    }
}

/// The squares of what it is clipped by vanished, so that its cone vectors were thousands of times too long, and
/// the dual above every primal.
#[test]
fn a_start_of_next_to_nothing_is_feasible() {
    let mut stream = Stream::new(29);
    for case in 0..60 {
        let mut along_a_line = |k: u32| {
            let class = if k < 4 { Class::A } else { Class::B };
            let std = if k.is_multiple_of(2) { 0.0 } else { stream.log_range(1e-3, 1e2) };
            let at = [stream.unit(), 0.0, 0.0];
            Sample { radius: 1e-6, ..sample(at, class, std, stream.log_range(1e-4, 1e2)) }
        };
        let samples: Vec<Sample> = (0..10).map(&mut along_a_line).collect();
        let problem = Problem::new(&samples, Kernel::Gaussian { gamma: 1.0 }).unwrap();
        let cold = problem.solve(&settings(1e-6)).unwrap();
        let mut start = cold.clone();
        start.alpha.fill(f64::MIN_POSITIVE);
        start.v.fill(Vector3::repeat(1e-310));
        let warm = solver(&settings(1e-6)).solve_from(&problem, &start);
        assert!(warm.dual <= cold.primal * (1.0 + 1e-9), "{case}: {} {}", warm.dual, cold.primal);
        for (v, alpha) in warm.v.iter().zip(&warm.alpha) {
            assert!(v.norm() <= 1e-6 * alpha * (1.0 + 1e-9), "{case}: {} {alpha}", v.norm());
        }
    }
}
