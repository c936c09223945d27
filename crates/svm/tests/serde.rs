//! Solutions and classifiers to text and back.

use crate::support::{Difficulty, cell, settings};
use cloudtouch_svm::Class;
use cloudtouch_svm::{Classifier, Kernel, Problem, Settings, Solution, separate};

#[test]
fn what_was_trained_comes_back_bit_for_bit() {
    let (samples, gamma) = cell(Difficulty::Easy, 10, 1);
    let problem = Problem::new(&samples, Kernel::Gaussian { gamma }).unwrap();
    let solution = problem.solve(&settings(1e-4)).unwrap();
    let text = serde_json::to_string(&solution).unwrap();
    assert_eq!(serde_json::from_str::<Solution>(&text).unwrap(), solution);

    let f = Classifier::new(&problem, &solution).unwrap();
    let g: Classifier = serde_json::from_str(&serde_json::to_string(&f).unwrap()).unwrap();
    assert_eq!(f, g);
    for s in &samples {
        assert_eq!(f.probability(&s.point, s.class), g.probability(&s.point, s.class));
    }
    let side = |class: Class| -> Vec<_> {
        samples.iter().filter(|s| s.class == class).map(|s| s.point).collect()
    };
    let plane = separate(&side(Class::A), &side(Class::B), 4.75).unwrap();
    let text = serde_json::to_string(&plane).unwrap();
    assert_eq!(serde_json::from_str::<cloudtouch_svm::Separation>(&text).unwrap(), plane);
}

#[test]
fn settings_left_out_are_the_default_ones() {
    let partial: Settings = serde_json::from_str("{\"relative_gap\": 1e-5}").unwrap();
    assert_eq!(partial, Settings { relative_gap: 1e-5, ..Settings::default() });
}
