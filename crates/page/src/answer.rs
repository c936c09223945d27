//! The words of a view.

use cloudtouch::geom::Pose;
use cloudtouch::{Contact, Report, Verdict};

use crate::body::Body;
use crate::data;
use crate::escape::html;
use crate::fact::Fact;
use crate::facts;
use crate::page::Page;
use crate::view::View;
use crate::words;

/// Contacts that are listed; all are drawn.
const CONTACTS_LISTED: usize = 8;

/// The section of a view, of which only one is shown at a time.
pub(crate) fn section(number: usize, view: &View<'_>, page: &Page<'_>) -> String {
    let hidden = if number == page.start { "" } else { " hidden" };
    let facts = list(&facts::of_view(view));
    let body = match &view.asked {
        Some(asked) => {
            head(&asked.report, page)
                + &facts
                + &contacts(&asked.report.contacts)
                + &list(&about([asked.scene.body, asked.object.body], page))
                + &matrix(&asked.object.pose)
        }
        None => facts,
    };
    format!(
        "<section class=\"answer\" id=\"answer-{number}\"{hidden}>\n<h2>{}</h2>\n{body}</section>\n",
        html(&view.name)
    )
}

/// Which the two bodies are, and what they were taken for.
fn about(of: [usize; 2], page: &Page<'_>) -> Vec<Fact> {
    let about = of.map(|body| page.bodies.get(body).filter(|body| !body.about.is_empty()));
    let about = ["Scene", "Object"].into_iter().zip(about);
    let fact = |(label, body): (&str, Option<&Body>)| {
        let Body { name, about, .. } = body?;
        let is_told = name.is_empty() || name.eq_ignore_ascii_case(label);
        Some(Fact::new(label, if is_told { about.clone() } else { format!("{name}: {about}") }))
    };
    about.filter_map(fact).collect()
}

/// Names and texts as a list.
pub(crate) fn list(facts: &[Fact]) -> String {
    if facts.is_empty() {
        return String::new();
    }
    let each =
        |fact: &Fact| format!("<dt>{}</dt><dd>{}</dd>\n", html(&fact.label), html(&fact.text));
    format!("<dl>\n{}</dl>\n", facts.iter().map(each).collect::<String>())
}

fn head(report: &Report, page: &Page<'_>) -> String {
    let Report { verdict, undecided_by, collision_probability, warnings, .. } = report;
    // A mark beside the colour: not everybody tells colours apart.
    let (class, mark) = match verdict {
        Verdict::Free => ("free", "✓"),
        Verdict::InCollision => ("collision", "✕"),
        Verdict::Uncertain => ("uncertain", "?"),
        Verdict::Undecided => ("undecided", "!"),
    };
    let warnings: String = warnings
        .iter()
        .map(|warning| {
            let by = page.remedy.and_then(|of| of(warning)).map(|by| format!(" ({by})"));
            let words = warning.to_string() + &by.unwrap_or_default();
            format!("<p class=\"warning\">Warning: {}</p>\n", html(&words))
        })
        .collect();
    format!(
        "<p class=\"verdict {class}\"><span aria-hidden=\"true\">{mark}</span> {verdict} \
         <b>{}</b></p>\n<p>{}</p>\n{warnings}",
        words::probability(*collision_probability),
        html(&words::verdict(*verdict, *undecided_by))
    )
}

fn contacts(contacts: &[Contact]) -> String {
    if contacts.is_empty() {
        return String::new();
    }
    let row = |contact: &Contact| {
        let p = contact.point;
        format!(
            "<tr><td>{:.3}, {:.3}, {:.3}</td><td>{}</td><td>{:+.1}</td></tr>\n",
            p.x,
            p.y,
            p.z,
            words::probability(contact.probability),
            1e3 * contact.clearance_m
        )
    };
    let rows: String = contacts.iter().take(CONTACTS_LISTED).map(row).collect();
    let more = match contacts.len().saturating_sub(CONTACTS_LISTED) {
        0 => String::new(),
        more => format!("<p class=\"small\">and {more} more, less likely</p>\n"),
    };
    format!(
        "<h3>Where they touch or may touch</h3>\n<table><thead><tr><th>place (m)</th>\
         <th>probability</th><th>gap (mm)</th></tr></thead>\n<tbody>\n{rows}</tbody></table>\n{more}"
    )
}

fn matrix(pose: &Pose) -> String {
    let rows = data::rows(pose);
    let line = |row: &[f64]| row.iter().map(|x| format!(" {x:>9.6}")).collect::<String>();
    let lines: Vec<String> = rows.chunks(4).map(line).collect();
    format!(
        "<details><summary>Pose as a matrix, object to scene</summary><pre>{}</pre></details>\n",
        lines.join("\n")
    )
}
