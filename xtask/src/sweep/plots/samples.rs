//! Made-up answers for the tests of the figures.

use cloudtouch_geom::seed;
use cloudtouch_testkit::noise::NoiseKind;

use crate::sweep::{
    measures::Judged,
    record::{Answers, Block, Condition, Said, Truth},
};

/// Two families under five noises, with so many poses of signed distances up to 100 mm; "ours"
/// has probabilities, of which those in family b are too certain, "rival" scores only.
pub(super) fn answers(poses: u32) -> Answers {
    let mut answers = Answers::default();
    for (family, width) in [("a", 1.0), ("b", 0.5)] {
        for std in [0.0, 0.002, 0.005, 0.01, 0.02] {
            let unit = |pose: u32, use_of| {
                seed::unit(seed::derive(family.as_bytes()[0].into(), pose.into(), use_of))
            };
            let truths: Vec<Truth> = (0..poses)
                .map(|pose| 0.2 * (unit(pose, 0) - 0.4))
                .map(|d| Truth { collides: d < 0.0, signed_distance: d })
                .collect();
            let said = |method: u64, blur: f64| -> Vec<Said> {
                let of_pose = |(pose, truth): (u32, &Truth)| {
                    let seed = seed::derive(
                        method,
                        pose.into(),
                        (1e4 * std) as u64 + u64::from(family == "b"),
                    );
                    // About logistic, like the probability below.
                    let u = seed::unit(seed).clamp(1e-6, 1.0 - 1e-6);
                    let score = -truth.signed_distance + blur * (u / (1.0 - u)).ln();
                    let p = 1.0 / (1.0 + (-score / (width * blur)).exp());
                    Said {
                        score,
                        probability: (method == 0).then_some(p),
                        bounds: (method == 0).then_some([0.9 * p, 0.9 * p + 0.1]),
                        evidence: None,
                        micros: 1000.0 + 500.0 * u,
                    }
                };
                (0..poses).zip(&truths).map(of_pose).collect()
            };
            let methods = vec![
                ("ours".to_owned(), said(0, 0.004 + 0.5 * std)),
                ("rival".to_owned(), said(1, 0.008 + 1.5 * std)),
            ];
            let condition = Condition { family, points: 2500, noise: NoiseKind::Gaussian, std };
            let block = Block { condition, poses: (0..poses).collect(), truths, methods };
            answers.add(block).unwrap();
        }
    }
    answers
}

/// Both methods under some of the conditions.
pub(super) fn pick(answers: &Answers, keep: impl Fn(&Condition) -> bool) -> Judged {
    Judged::pick(answers, &["ours", "rival"], |condition, _| keep(condition))
}

/// Both methods at the poses within 3 cm.
pub(super) fn pick_near(answers: &Answers) -> Judged {
    Judged::pick(answers, &["ours", "rival"], |_, t| t.signed_distance.abs() < 0.03)
}
