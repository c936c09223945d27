//! Probabilities for methods that give a score only.

use anyhow::{Context, Result, ensure};

use super::fit_plainly;
use crate::sweep::record::{Answers, Block};

/// Gives every answer without a probability one: a logistic function of its score, fitted on the
/// answers of the same method in all other families.
///
/// So a score is judged by what it is worth to somebody who never saw the family, as our own
/// probabilities are.
///
/// # Errors
///
/// When there is only one family, a score is infinite, or the other families have only collisions
/// or only free poses.
pub(crate) fn calibrate_scores(answers: &mut Answers) -> Result<()> {
    let mut methods: Vec<String> = Vec::new();
    let families = answers.families();
    for block in answers.blocks() {
        for (method, said) in &block.methods {
            let is_bare = said.iter().any(|s| s.probability.is_none());
            if is_bare && !methods.contains(method) {
                methods.push(method.clone());
            }
        }
    }
    for method in &methods {
        ensure!(families.len() > 1, "{method}: one family, none to fit its scores on");
        for family in &families {
            calibrate(answers, method, family)
                .with_context(|| format!("fit {method} for {family} on the other families"))?;
        }
    }
    Ok(())
}

fn calibrate(answers: &mut Answers, method: &str, family: &str) -> Result<()> {
    let said = |block: &Block| block.methods.iter().position(|(name, _)| name == method);
    if !answers.blocks().iter().any(|b| b.condition.family == family && said(b).is_some()) {
        return Ok(());
    }
    let (mut features, mut truths) = (Vec::new(), Vec::new());
    for block in answers.blocks().iter().filter(|b| b.condition.family != family) {
        let Some(at) = said(block) else { continue };
        features.extend(block.methods[at].1.iter().map(|s| vec![s.score]));
        truths.extend(block.truths.iter().map(|t| t.collides));
    }
    let fit = fit_plainly(&features, &truths)?;
    for block in answers.blocks_mut().iter_mut().filter(|b| b.condition.family == family) {
        let Some(at) = said(block) else { continue };
        for said in &mut block.methods[at].1 {
            let fitted = fit.probability(&[said.score]);
            said.probability = said.probability.or(Some(fitted));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use cloudtouch_testkit::noise::NoiseKind;

    use super::*;
    use crate::sweep::record::{Condition, Said, Truth};

    /// Ten poses of which the upper half collides, but for one on each side.
    fn block(family: &'static str, scale: f64, probability: Option<f64>) -> Block {
        let truths: Vec<Truth> = (0..10)
            .map(|i| Truth { collides: i >= 5 && i != 8 || i == 2, signed_distance: 0.0 })
            .collect();
        let said: Vec<Said> = (0..10)
            .map(|i| Said {
                score: scale * f64::from(i),
                probability,
                bounds: None,
                evidence: None,
                micros: 1.0,
            })
            .collect();
        Block {
            condition: Condition { family, points: 1, noise: NoiseKind::Gaussian, std: 0.0 },
            poses: (0..10).collect(),
            truths,
            methods: vec![("m".to_owned(), said)],
        }
    }

    fn probabilities(block: &Block) -> Vec<f64> {
        block.methods[0].1.iter().map(|s| s.probability.unwrap()).collect()
    }

    #[test]
    fn a_family_is_fitted_on_the_others() {
        let mut answers = Answers::default();
        for (family, scale) in [("a", 1.0), ("b", 3.0)] {
            answers.add(block(family, scale, None)).unwrap();
        }
        calibrate_scores(&mut answers).unwrap();
        let [a, b] = [0, 1].map(|i| probabilities(&answers.blocks()[i]));
        assert!(a.windows(2).all(|p| p[0] < p[1]));
        // The model of b crosses ½ at three times the score of a's own, 13.5 of its 0 to 9; the
        // model of a, at 4.5 of b's 0 to 27.
        assert!(a[9] < 0.5 && b[1] < 0.5 && b[2] > 0.5, "{a:?} {b:?}");
    }

    #[test]
    fn given_probabilities_stay_and_one_family_is_too_few() {
        let mut answers = Answers::default();
        answers.add(block("a", 1.0, Some(0.25))).unwrap();
        calibrate_scores(&mut answers).unwrap();
        assert_eq!(probabilities(&answers.blocks()[0]), [0.25; 10]);
        let mut alone = Answers::default();
        alone.add(block("a", 1.0, None)).unwrap();
        assert!(calibrate_scores(&mut alone).unwrap_err().to_string().contains("one family"));
    }
}
