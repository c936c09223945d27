//! Poses in a table: a place and a quaternion in each line.

use anyhow::{Context as _, Result, bail};
use cloudtouch::geom::{Pose, Vector3};

/// No message quotes more of a word or a row.
const EXCERPT: usize = 40;

/// Real parts smaller than that are of half a turn, or of one that lacks some two degrees.
const NO_REAL_PART: f64 = 0.02;

/// The columns, in the order of a table that does not name them.
const COLUMNS: [&str; 7] = ["x", "y", "z", "qw", "qx", "qy", "qz"];

/// What trajectories of TUM call the first of them.
const PLACES: [&str; 3] = ["tx", "ty", "tz"];

/// What recorders put beside them.
const TIMES: [&str; 4] = ["t", "time", "timestamp", "stamp"];

/// How a table begins that does not name its columns.
#[derive(Debug, Clone, PartialEq)]
pub struct Unnamed {
    /// The line of its first row, from 1.
    pub line: usize,
    /// The row.
    pub row: String,
    /// Every row is half a turn or nearly: where the real part is written last, as ROS does, none of them
    /// is turned much about x.
    pub are_half_turns: bool,
}

/// Where in a line each of the columns is, and how many numbers it has.
struct Order {
    places: [usize; 7],
    count: usize,
}

pub(super) fn parse(text: &str) -> Result<(Vec<Pose>, Option<Unnamed>)> {
    let mut poses = Vec::new();
    let mut order: Option<Order> = None;
    let mut unnamed: Option<Unnamed> = None;
    for (line, content) in text.lines().enumerate() {
        let content = content.trim();
        let is_header = poses.is_empty()
            && order.is_none()
            && content.starts_with(|c: char| c.is_alphabetic() || c == '"');
        let place = || format!("line {} of the path", line + 1);
        if let Some(comment) = content.strip_prefix('#') {
            // So numpy writes a header.
            if let Some(named) = named(comment.trim()).filter(|_| poses.is_empty()) {
                order = Some(named);
            }
        } else if is_header {
            order = Some(header(content).with_context(place)?);
        } else if !content.is_empty() {
            let pose = match &order {
                Some(order) => of_row(content, order),
                None => of_unnamed(content),
            };
            let pose = pose.with_context(place)?;
            let is_half_turn = pose.rotation().w.abs() < NO_REAL_PART;
            match &mut unnamed {
                Some(unnamed) => unnamed.are_half_turns &= is_half_turn,
                None if order.is_none() => {
                    let row = content.chars().take(EXCERPT).collect();
                    unnamed = Some(Unnamed { line: line + 1, row, are_half_turns: is_half_turn });
                }
                None => {}
            }
            poses.push(pose);
        }
    }
    Ok((poses, unnamed))
}

/// Where each column is: many write the real part of a quaternion last.
fn header(content: &str) -> Result<Order> {
    named(content).with_context(|| {
        let given: String = content.chars().take(EXCERPT).collect();
        let columns = COLUMNS.join(",");
        let wrong = wrong(content);
        format!(
            "`{given}`: name the columns {columns}, in any order, such as x,y,z,qx,qy,qz,qw: {wrong}"
        )
    })
}

/// Which names are no columns, there twice or left out.
fn wrong(content: &str) -> String {
    let as_column = |name: String| match PLACES.iter().position(|place| *place == name) {
        Some(index) => COLUMNS[index].to_owned(),
        None => name,
    };
    let names: Vec<String> = names(content).map(as_column).collect();
    let known = |name: &str| COLUMNS.iter().chain(&TIMES).any(|of| *of == name);
    let list = |label: &str, names: Vec<&str>| {
        let quoted = names.into_iter().map(|name| name.chars().take(EXCERPT).collect::<String>());
        let quoted = quoted.map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        (!quoted.is_empty()).then(|| format!("{label} {quoted}"))
    };
    let unknown = names.iter().filter(|name| !known(name)).map(String::as_str).collect();
    let again = |(place, name): &(usize, &String)| known(name) && names[..*place].contains(name);
    let twice = names.iter().enumerate().filter(again).map(|(_, name)| name.as_str()).collect();
    let is_missing = |column: &&&str| !names.iter().any(|name| name == **column);
    let missing = COLUMNS.iter().filter(is_missing).copied().collect();
    let all = [list("unknown", unknown), list("twice", twice), list("missing", missing)];
    all.into_iter().flatten().collect::<Vec<_>>().join("; ")
}

/// In lower case and without quotes.
fn names(content: &str) -> impl Iterator<Item = String> {
    cells(content).map(|name| name.trim_matches('"').to_lowercase())
}

/// The columns where these are all that is named.
fn named(content: &str) -> Option<Order> {
    let names: Vec<String> = names(content).collect();
    let place_of = |wanted: &str| names.iter().position(|name| name == wanted);
    let mut places = [0; 7];
    for (index, column) in COLUMNS.into_iter().enumerate() {
        let other = PLACES.get(index).and_then(|name| place_of(name));
        places[index] = place_of(column).or(other)?;
    }
    let times = names.iter().filter(|name| TIMES.contains(&name.as_str())).count();
    (names.len() == COLUMNS.len() + times).then_some(Order { places, count: names.len() })
}

/// What stands between semicolons, else between commas, else between white space.
fn cells(line: &str) -> Box<dyn Iterator<Item = &str> + '_> {
    match [';', ','].into_iter().find(|separator| line.contains(*separator)) {
        Some(separator) => Box::new(line.split(separator).map(str::trim)),
        None => Box::new(line.split_whitespace()),
    }
}

/// Without names, spaces are as likely those of a trajectory that begins with a time.
fn of_unnamed(content: &str) -> Result<Pose> {
    if content.contains(';') || !content.contains(',') {
        bail!(
            "numbers are separated by commas, or by spaces or semicolons below a line that names the \
             columns, such as `timestamp tx ty tz qx qy qz qw`"
        );
    }
    of_row(content, &Order { places: [0, 1, 2, 3, 4, 5, 6], count: COLUMNS.len() })
}

fn of_row(content: &str, order: &Order) -> Result<Pose> {
    let number = |(place, word): (usize, &str)| -> Result<f64> {
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => {
                let word: String = word.chars().take(EXCERPT).collect();
                let column = order.places.iter().position(|of| *of == place);
                let name = column.map_or(String::new(), |of| format!(", {}", COLUMNS[of]));
                bail!(
                    "`{word}` is not a finite number (column {}{name}); write it like -0.25 or 1e-3",
                    place + 1
                )
            }
        }
    };
    let numbers = cells(content).enumerate().map(number).collect::<Result<Vec<f64>>>()?;
    if numbers.len() != order.count {
        let times = if order.count > COLUMNS.len() { " and a time, as the header has" } else { "" };
        let (count, columns) = (order.count, COLUMNS.join(","));
        bail!(
            "write {count} numbers, {columns}{times}: metres and a quaternion; {} are given",
            numbers.len()
        );
    }
    let [x, y, z, w, i, j, k] = order.places.map(|place| numbers[place]);
    Ok(Pose::try_from_quaternion(Vector3::new(x, y, z), [w, i, j, k])?)
}
