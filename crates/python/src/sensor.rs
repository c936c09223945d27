//! Sensors by their specs.

use cloudtouch::noise::{NoiseError, SensorModel};
use pyo3::prelude::*;

use crate::error::refused_for;

/// The sensor of a spec. `auto` is of the tool, whose answers say what it chose: an array has nobody to tell.
pub(crate) fn stated(spec: &str) -> Result<SensorModel, String> {
    if spec.trim() == "auto" {
        return Err(
            "`auto` is of the command-line tool alone: give the spec that `cloudtouch info FILE` suggests"
                .to_owned(),
        );
    }
    spec.parse().map_err(|error: NoiseError| error.to_string())
}

/// Refuses what is no spec of a sensor, by the name of the argument.
#[pyfunction]
#[pyo3(signature = (spec, name, /))]
pub(crate) fn check_sensor(spec: &str, name: &str) -> PyResult<()> {
    stated(spec).map(|_| ()).map_err(|error| refused_for(name, error))
}
