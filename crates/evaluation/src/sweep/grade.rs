//! Probabilities for methods that give a score only.

use anyhow::{Context, Result};

use crate::{
    answers::{Answers, Pair, Row},
    measures::Logistic,
};

/// Gives every answer without a probability one: a logistic function of its score, fitted on the
/// answers of the same method to the same kind of pair in all other families.
///
/// So a score is judged by what it is worth to somebody who never saw the family, as our own
/// probabilities are.
/// Fails where there is nothing to fit on: one family only, or truths that are all alike.
pub(super) fn grade(answers: &mut Answers) -> Result<()> {
    let families = answers.families();
    let Answers { methods, rows } = answers;
    for (which, name) in methods.iter().enumerate() {
        // Looked at before any is filled in.
        let bare = |(i, (_, said)): (usize, &Row)| {
            said[which].filter(|said| said.probability.is_none()).map(|said| (i, said.score))
        };
        let bare: Vec<(usize, f64)> = rows.iter().enumerate().filter_map(bare).collect();
        for (&family, pair) in families.iter().flat_map(|f| Pair::ALL.map(|pair| (f, pair))) {
            let (judged, others): (Vec<_>, Vec<_>) = bare
                .iter()
                .copied()
                .filter(|(i, _)| rows[*i].0.pair == pair)
                .partition(|(i, _)| rows[*i].0.family == family);
            if judged.is_empty() {
                continue;
            }
            let (scores, truths): (Vec<f64>, Vec<bool>) =
                others.into_iter().map(|(i, score)| (score, rows[i].0.collides)).unzip();
            let fit = Logistic::fit(&scores, &truths)
                .with_context(|| format!("fit {name} for {family} on the other families"))?;
            for (i, score) in judged {
                if let Some(said) = &mut rows[i].1[which] {
                    said.probability = Some(fit.probability(score));
                }
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;
    use crate::answers::{Said, tests::question};

    #[test]
    fn a_family_does_not_change_its_own_fit() {
        let graded = |sign_in_c: f64| {
            let mut answers = Answers { methods: vec!["x".into()], rows: Vec::new() };
            for (family, sign) in [("a", 1.0), ("b", 1.0), ("c", sign_in_c)] {
                for pose in 0..60 {
                    // Overlapping scores, larger where it collides, but in c perhaps the other way.
                    let score = sign * (f64::from(pose % 30) / 10.0 + f64::from(pose % 2) - 2.0);
                    let said = vec![Some(Said::score(score, Instant::now()))];
                    answers.push((question(family, 0, pose, pose % 2 == 1), said)).unwrap();
                }
            }
            grade(&mut answers).unwrap();
            let said = answers.rows.iter().map(|(_, said)| said[0].unwrap());
            said.map(|said| said.probability.unwrap()).collect::<Vec<f64>>()
        };
        let (same, other) = (graded(1.0), graded(-1.0));
        // In c the same rule holds as without knowledge of c; in a and b not.
        let at_same_score = |all: &[f64], from: usize| all[from] - all[from + 1];
        assert!(at_same_score(&same, 120) < 0.0 && at_same_score(&other, 120) > 0.0);
        assert!(same[0] != other[0]);
    }
}
