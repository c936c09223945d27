//! Probabilities for methods that give a score only.

use anyhow::{Context, Result};

use crate::{
    answers::{Answers, Pair},
    measures::Logistic,
};

/// Gives every answer without a probability one: a logistic function of its score, fitted on the
/// answers of the same method to the same kind of pair in all other families.
///
/// So a score is judged by what it is worth to somebody who never saw the family, as our own
/// probabilities are.
///
/// # Errors
/// When there is nothing to fit on: one family only, or truths that are all alike.
pub(super) fn grade(answers: &mut Answers) -> Result<()> {
    let families = answers.families();
    let Answers { questions, methods } = answers;
    for (name, said) in methods {
        // Looked at before any is filled in.
        let is_bare: Vec<bool> =
            said.iter().map(|s| s.is_some_and(|s| s.probability.is_none())).collect();
        for (&family, pair) in families.iter().flat_map(|f| Pair::ALL.map(|pair| (f, pair))) {
            let of = |inside: bool| -> Vec<usize> {
                let is_wanted = |i: &usize| {
                    let question = &questions[*i];
                    is_bare[*i] && question.pair == pair && (question.family == family) == inside
                };
                (0..questions.len()).filter(is_wanted).collect()
            };
            let (judged, others) = (of(true), of(false));
            if judged.is_empty() {
                continue;
            }
            let score = |i: &usize| said[*i].map_or(f64::NAN, |s| s.score);
            let scores: Vec<Vec<f64>> = others.iter().map(|i| vec![score(i)]).collect();
            let truths: Vec<bool> = others.iter().map(|&i| questions[i].collides).collect();
            let fit = Logistic::fit(&scores, &truths)
                .with_context(|| format!("fit {name} for {family} on the other families"))?;
            let fitted: Vec<f64> = judged.iter().map(|i| fit.probability(&[score(i)])).collect();
            for (i, probability) in judged.into_iter().zip(fitted) {
                if let Some(said) = &mut said[i] {
                    said.probability = Some(probability);
                }
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answers::{Said, tests::question};

    #[test]
    fn a_family_does_not_change_its_own_fit() {
        let graded = |sign_in_c: f64| {
            let mut answers = Answers::default();
            for (family, sign) in [("a", 1.0), ("b", 1.0), ("c", sign_in_c)] {
                for pose in 0..60 {
                    // Overlapping scores, larger where it collides, but in c perhaps the other way.
                    let score = sign * (f64::from(pose % 30) / 10.0 + f64::from(pose % 2) - 2.0);
                    let said = [("x".to_owned(), Said::score(score, 1.0))];
                    answers.push(question(family, 0, pose, pose % 2 == 1), &said).unwrap();
                }
            }
            grade(&mut answers).unwrap();
            let said = answers.said("x").unwrap();
            said.iter().map(|s| s.unwrap().probability.unwrap()).collect::<Vec<f64>>()
        };
        let (same, other) = (graded(1.0), graded(-1.0));
        // In c the same rule holds as without knowledge of c; in a and b not.
        let at_same_score = |all: &[f64], from: usize| all[from] - all[from + 1];
        assert!(at_same_score(&same, 120) < 0.0 && at_same_score(&other, 120) > 0.0);
        assert!(same[0] != other[0]);
    }
}
