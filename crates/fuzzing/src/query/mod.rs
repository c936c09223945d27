//! Queries: any two small bodies in any pose under any settings give a report that holds together,
//! or an error.

mod bodies;
mod check;
mod numbers;
mod settings;

use arbitrary::Unstructured;
use cloudtouch::{BodyRef, Cloud, PaperBodyRef, PaperCloud, PaperQuery, Query, SettingsError};

use bodies::Body;
use check::Limits;

/// Bytes as two bodies, a pose and settings.
///
/// # Panics
/// When a report contradicts itself or an error says nothing.
pub fn query(bytes: &[u8]) {
    // Bytes that run out read as zeros; an error only means that there is nothing to run.
    let _ = run(&mut Unstructured::new(bytes));
}

fn run(u: &mut Unstructured<'_>) -> arbitrary::Result<()> {
    if u.arbitrary()? { by_the_paper(u) } else { by_default(u) }
}

fn by_default(u: &mut Unstructured<'_>) -> arbitrary::Result<()> {
    let settings = settings::query_settings(u)?;
    let pose = numbers::pose(u)?;
    let query = Query::new(settings);
    let mut body = || bodies::body(u, settings::cloud_settings, Cloud::prepare);
    let Some((query, a, b)) = all(query, body()?, body()?) else { return Ok(()) };
    let answer = query.run(default_ref(&a), default_ref(&b), &pose);
    let limits = Limits {
        accept: settings.accept,
        reject: settings.reject,
        max_contacts: settings.max_contacts,
    };
    check::answer(&answer, &limits, [&a, &b].map(|body| points(body, Cloud::len)));
    Ok(())
}

fn by_the_paper(u: &mut Unstructured<'_>) -> arbitrary::Result<()> {
    let settings = settings::paper_settings(u)?;
    let pose = numbers::pose(u)?;
    let query = PaperQuery::new(settings);
    let mut body = || bodies::body(u, settings::paper_cloud_settings, PaperCloud::prepare);
    let Some((query, a, b)) = all(query, body()?, body()?) else { return Ok(()) };
    let answer = query.run(paper_ref(&a), paper_ref(&b), &pose);
    let limits = Limits {
        accept: settings.accept,
        reject: settings.reject,
        max_contacts: settings.max_contacts,
    };
    check::answer(&answer, &limits, [&a, &b].map(|body| points(body, PaperCloud::len)));
    Ok(())
}

/// A query and its bodies, where there is no error; the messages of errors are checked.
fn all<Q, C>(
    query: Result<Q, SettingsError>,
    a: Result<Body<C>, String>,
    b: Result<Body<C>, String>,
) -> Option<(Q, Body<C>, Body<C>)> {
    if let Err(error) = &query {
        check::message(&error.to_string());
    }
    [&a, &b].into_iter().filter_map(|body| body.as_ref().err()).for_each(|e| check::message(e));
    Some((query.ok()?, a.ok()?, b.ok()?))
}

fn default_ref(body: &Body<Cloud>) -> BodyRef<'_> {
    match body {
        Body::Cloud(cloud) => cloud.into(),
        Body::Mesh(mesh) => mesh.into(),
    }
}

fn paper_ref(body: &Body<PaperCloud>) -> PaperBodyRef<'_> {
    match body {
        Body::Cloud(cloud) => cloud.into(),
        Body::Mesh(mesh) => mesh.into(),
    }
}

fn points<C>(body: &Body<C>, count: impl Fn(&C) -> usize) -> usize {
    match body {
        Body::Cloud(cloud) => count(cloud),
        Body::Mesh(_) => 0,
    }
}
