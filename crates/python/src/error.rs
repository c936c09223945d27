//! Errors of the library as exceptions, with its own words.

use std::fmt::Display;

use pyo3::PyErr;
use pyo3::exceptions::PyValueError;

pyo3::create_exception!(
    cloudtouch,
    CloudtouchError,
    PyValueError,
    "What the library refuses: the message names the place, the value and a remedy."
);

/// The exception for an error of the library.
pub(crate) fn refused(error: impl Display) -> PyErr {
    CloudtouchError::new_err(error.to_string())
}

/// The same, with what it is about before it.
pub(crate) fn refused_for(what: impl Display, error: impl Display) -> PyErr {
    CloudtouchError::new_err(format!("{what}: {error}"))
}
