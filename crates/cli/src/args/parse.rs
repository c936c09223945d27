//! Numbers of options, with what they may be.

use std::str::FromStr;

use cloudtouch::{OutlierSettings, Query};
use cloudtouch_cli::numbers;

use crate::sensor::SensorChoice;

pub(super) fn parse_length(text: &str) -> Result<f64, String> {
    let length = numbers::finite(text)?;
    if length >= 0.0 { Ok(length) } else { Err("a length in metres is 0 or more".to_owned()) }
}

pub(super) fn parse_positive(text: &str) -> Result<f64, String> {
    let length = numbers::finite(text)?;
    if length > 0.0 { Ok(length) } else { Err("it must be above 0, such as 0.01".to_owned()) }
}

pub(super) fn parse_fraction(text: &str) -> Result<f64, String> {
    let fraction = numbers::finite(text)?;
    let is_between = fraction > 0.0 && fraction < 1.0;
    if is_between { Ok(fraction) } else { Err("give a number above 0 and below 1".to_owned()) }
}

pub(super) fn parse_tolerance(text: &str) -> Result<f64, String> {
    let tolerance = parse_fraction(text)?;
    let least = Query::LEAST_TOLERANCE;
    if tolerance >= least {
        return Ok(tolerance);
    }
    Err(format!(
        "give {least:e} or more, such as 0.001: the finer, the longer a path near contact takes"
    ))
}

pub(super) fn parse_accept(text: &str) -> Result<f64, String> {
    let accept = numbers::finite(text)?;
    if (0.5..=1.0).contains(&accept) { Ok(accept) } else { Err("give 0.5 to 1".to_owned()) }
}

pub(super) fn parse_reject(text: &str) -> Result<f64, String> {
    let reject = numbers::finite(text)?;
    if (0.0..=0.5).contains(&reject) { Ok(reject) } else { Err("give 0 to 0.5".to_owned()) }
}

pub(super) fn parse_milliseconds(text: &str) -> Result<u64, String> {
    match text.trim().parse::<u64>() {
        Ok(milliseconds) if milliseconds > 0 => Ok(milliseconds),
        _ => Err("give whole milliseconds, 1 or more".to_owned()),
    }
}

/// A count or a seed; its bound is far beyond what is meant.
pub(super) fn parse_whole<T: FromStr>(text: &str) -> Result<T, String> {
    let form = "give a whole number from 0 on in digits, 1000000 and not 1e6";
    text.trim().parse().map_err(|_| form.to_owned())
}

/// More neighbours than this take minutes and smooth everything away.
const MOST_NEIGHBORS: usize = 200;

pub(super) fn parse_outliers(text: &str) -> Result<OutlierSettings, String> {
    let form = "write neighbours and standard deviations, as in 8,3";
    let (neighbors, deviations) = text.split_once(',').ok_or_else(|| form.to_owned())?;
    match neighbors.trim().parse::<usize>() {
        Ok(neighbors) if neighbors > MOST_NEIGHBORS => Err(format!(
            "{neighbors} neighbours are too many: 8 are usual, {MOST_NEIGHBORS} the most"
        )),
        Ok(neighbors) if neighbors > 0 => {
            let deviations = numbers::finite(deviations)?;
            if deviations <= 0.0 {
                return Err(format!(
                    "{deviations} standard deviations would leave out much of every surface: give \
                     them above 0; 3 are usual"
                ));
            }
            Ok(OutlierSettings { neighbors, deviations })
        }
        _ => Err(format!("`{neighbors}` is not a number of neighbours: {form}")),
    }
}

pub(super) fn parse_sensor_for(text: &str) -> Result<(String, SensorChoice), String> {
    let (name, spec) = text
        .split_once('=')
        // Every path has the empty name in it.
        .filter(|(name, _)| !name.is_empty())
        .ok_or_else(|| format!("`{text}`: write NAME=SPEC, as in mug=kinect"))?;
    let sensor = spec.parse::<SensorChoice>().map_err(|error| error.to_string())?;
    Ok((name.to_owned(), sensor))
}
