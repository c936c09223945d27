//! Prints how honest the stated standard deviations are, as a page of Markdown:
//! `cargo run --release -p cloudtouch-noise --example sigma > docs/lab/sigma.md`.

#[allow(dead_code, reason = "tests use more of it")]
#[path = "../tests/common/mod.rs"]
mod common;

use common::sigma::{HONEST, Spread, rows};

fn main() {
    let rows = rows();
    println!("{}", head());
    for row in &rows {
        println!(
            "| {} | {} | {} | {} | {} | {} | {} |",
            row.shape,
            1e3 * row.spacing,
            1e3 * row.noise,
            standardised(row.faces),
            standardised(row.edges),
            error(row.faces),
            error(row.edges),
        );
    }
    let all = || rows.iter().flat_map(|row| [row.faces, row.edges]).flatten();
    let missed = all().filter(|spread| !is_honest(spread)).count();
    println!("\n{missed} of {} are outside these bounds, set in bold.", all().count());
}

fn head() -> String {
    let (low, high) = HONEST;
    format!(
        "# How honest the stated standard deviations are\n\n\
         Made by `cargo run --release -p cloudtouch-noise --example sigma > docs/lab/sigma.md`; held \
         by `crates/noise/tests/sigma.rs`.\n\n\
         Surfaces are sampled with isotropic noise and refined with `Combination::SurfacePosterior`. \
         The first two numbers are the root mean square of the error along the true normal over the \
         standard deviation stated along it: 1 is honest, more is too bold, less too careful, and \
         {low} to {high} is the target. Edges are points within a spacing of one, faces the others; \
         the last two numbers are the errors themselves. Left out: points within a spacing of the \
         rim of the plane, and cells of fewer than 50 points.\n\n\
         | surface | spacing mm | noise mm | faces | edges | error on faces mm | at edges mm |\n\
         | --- | --- | --- | --- | --- | --- | --- |"
    )
}

fn is_honest(spread: &Spread) -> bool {
    (HONEST.0..=HONEST.1).contains(&spread.standardised)
}

fn standardised(spread: Option<Spread>) -> String {
    spread.map_or("—".to_owned(), |spread| {
        let value = format!("{:.2}", spread.standardised);
        if is_honest(&spread) { value } else { format!("**{value}**") }
    })
}

fn error(spread: Option<Spread>) -> String {
    spread.map_or("—".to_owned(), |spread| format!("{:.2}", 1e3 * spread.error))
}
