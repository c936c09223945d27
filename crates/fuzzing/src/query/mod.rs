//! Queries: any two small bodies in any pose under any settings give a report that holds together,
//! or an error.

mod bodies;
mod check;
mod numbers;
mod settings;

use arbitrary::Unstructured;
use cloudtouch::{Body, Query};

/// Bytes as two bodies, a pose and settings.
///
/// # Panics
/// When a report contradicts itself or an error says nothing.
pub fn query(bytes: &[u8]) {
    // Bytes that run out read as zeros; an error only means that there is nothing to run.
    let _ = run(&mut Unstructured::new(bytes));
}

fn run(u: &mut Unstructured<'_>) -> arbitrary::Result<()> {
    let settings = settings::query_settings(u)?;
    let pose = numbers::pose(u)?;
    let query = Query::new(settings);
    let (a, b) = (bodies::body(u, settings.mode)?, bodies::body(u, settings.mode)?);
    for error in [query.as_ref().err().map(ToString::to_string), a.as_ref().err().cloned()] {
        error.iter().for_each(|message| check::message(message));
    }
    if let Err(message) = &b {
        check::message(message);
    }
    let (Ok(query), Ok(a), Ok(b)) = (query, a, b) else { return Ok(()) };
    match query.run(&a, &b, &pose) {
        Ok(report) => check::report(&report, query.settings(), [points(&a), points(&b)]),
        Err(error) => check::message(&error.to_string()),
    }
    Ok(())
}

fn points(body: &Body) -> usize {
    match body {
        Body::Cloud(cloud) => cloud.len(),
        Body::Mesh(_) => 0,
    }
}
