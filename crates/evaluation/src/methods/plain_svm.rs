//! A kernel classifier without robust terms: trained on the measured points as if they were exact,
//! with the sensor's noise only in the probabilities read off it.

use std::time::Instant;

use anyhow::Result;
use cloudtouch::QuerySettings;
use cloudtouch_geom::{Covariance, Point3, Pose, UncertainPoint};
use cloudtouch_noise::Neighborhoods;
use cloudtouch_svm::{Class, Classifier, Kernel, Problem, Settings};

use super::{Draw, Method, Prepared, cleaned};
use crate::{
    answers::{Pair, Said},
    leaf,
};

/// Points of each side nearest to where the clouds are closest.
const POINTS_A_SIDE: usize = 60;
const RELATIVE_GAP: f64 = 1e-4;
/// What is said where no classifier can be had.
const UNDETERMINED: f64 = 0.5;

/// Answers for two clouds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlainSvm;

impl Method for PlainSvm {
    fn name(&self) -> String {
        "plain SVM".into()
    }

    fn prepare(&self, draw: &Draw<'_>) -> Result<Prepared> {
        let a = Neighborhoods::try_new(cleaned(draw.a)?.points)?;
        let b = Neighborhoods::try_new(cleaned(draw.b)?.points)?;
        let covariances = [draw.a.std, draw.b.std].map(|std| Covariance::isotropic(std * std));
        Ok(Box::new(move |pair, a_from_b| {
            if pair == Pair::CloudMesh {
                return Ok(None);
            }
            let start = Instant::now();
            let Some(middle) = closest(&a, &b, a_from_b) else { return Ok(None) };
            let [of_a, of_b] = covariances;
            let near_a: Vec<UncertainPoint> = nearest(&a, &middle)
                .map(|mean| UncertainPoint { mean, covariance: of_a })
                .collect();
            let in_b = a_from_b.inverse().transform_point(&middle);
            let near_b: Vec<UncertainPoint> = nearest(&b, &in_b)
                .map(|p| UncertainPoint { mean: a_from_b.transform_point(&p), covariance: of_b })
                .collect();
            let probability = largest(&near_a, &near_b)?;
            let said = Said::score(probability, start);
            Ok(Some(Said { probability: Some(probability), ..said }))
        }))
    }
}

/// The middle between the closest points of the two clouds, in the frame of A.
fn closest(a: &Neighborhoods, b: &Neighborhoods, a_from_b: &Pose) -> Option<Point3> {
    let moved = b.points().iter().map(|p| a_from_b.transform_point(p));
    let pairs = moved.filter_map(|p| Some((a.nearest_to(&p, 1).first().copied()?, p)));
    let (near, p) =
        pairs.min_by(|(x, _), (y, _)| x.squared_distance.total_cmp(&y.squared_distance))?;
    Some(nalgebra::center(&a.points()[near.index], &p))
}

fn nearest<'a>(cloud: &'a Neighborhoods, to: &Point3) -> impl Iterator<Item = Point3> + use<'a> {
    cloud.nearest_to(to, POINTS_A_SIDE).into_iter().map(|found| cloud.points()[found.index])
}

/// The largest probability of a point to be on the wrong side.
fn largest(a: &[UncertainPoint], b: &[UncertainPoint]) -> Result<f64> {
    let Some((unit_box, samples)) = leaf::posed([a, b], 0.0) else {
        return Ok(UNDETERMINED);
    };
    // The width and the penalty of ours, so that only the robust terms differ.
    let gamma = QuerySettings::default().gamma;
    let problem = Problem::try_new(&samples, Kernel::Gaussian { gamma })?;
    let settings = Settings { relative_gap: RELATIVE_GAP, ..Settings::default() };
    let solution = problem.solve(&settings)?;
    let Ok(classifier) = Classifier::try_new(&problem, &solution) else { return Ok(UNDETERMINED) };
    let classifier = classifier.outside(unit_box);
    let of = |points: &[UncertainPoint], class| {
        let p = points.iter().map(|p| classifier.probability(p, class).unwrap_or(UNDETERMINED));
        p.fold(0.0, f64::max)
    };
    Ok(f64::max(of(a, Class::A), of(b, Class::B)))
}
