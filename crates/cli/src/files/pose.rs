//! A pose as sixteen numbers in a text.

use anyhow::{Context as _, Result, anyhow, bail};
use cloudtouch::geom::{Pose, PoseError};
use nalgebra::Matrix4;

use super::json::within_reach;

/// No message quotes more of a word.
const EXCERPT: usize = 40;

/// Numbers row by row; brackets, commas and line breaks only separate them, so that a JSON or
/// numpy matrix can be pasted; what follows a `#` is a comment.
///
/// # Errors
/// When there are not sixteen numbers, or they are no rigid motion or one beyond 1e10 m.
pub fn parse(text: &str) -> Result<Pose> {
    let separator = |c: char| c.is_whitespace() || "[](),;".contains(c);
    let (mut numbers, mut lines) = (Vec::new(), Vec::new());
    for (line, content) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        let content = content.split('#').next().unwrap_or_default();
        for word in content.split(separator).filter(|w| !w.is_empty()) {
            let number: f64 = word.parse().with_context(|| {
                let found: String = word.chars().take(EXCERPT).collect();
                format!(
                    "line {}: `{found}` is not a number; write a 4x4 row-major matrix",
                    line + 1
                )
            })?;
            numbers.push(number);
            lines.push(line + 1);
        }
    }
    if numbers.len() != 16 {
        bail!("found {} numbers: a pose is a 4x4 row-major matrix, 16 numbers", numbers.len());
    }
    let pose = Pose::try_from_matrix(&Matrix4::from_row_slice(&numbers));
    within_reach(pose.map_err(|error| match error {
        // Its rows count from 0, and stand in any line.
        PoseError::NotFinite { row, column, .. } => {
            anyhow!("line {}: {error}", lines[4 * row + column])
        }
        other => other.into(),
    })?)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn reads_rows_with_or_without_brackets() {
        let plain = "1 0 0 0.5\n0 1 0 0\n0 0 1 -2\n0 0 0 1\n";
        let json = "[[1,0,0,0.5],[0,1,0,0],[0,0,1,-2],[0,0,0,1]]";
        assert_eq!(parse(plain).unwrap(), parse(json).unwrap());
        assert_eq!(parse(plain).unwrap().translation().z, -2.0);
        let commented = format!("# camera to base, 2026\n{plain}# end");
        assert_eq!(parse(plain).unwrap(), parse(&commented).unwrap());
    }

    #[test]
    fn says_what_is_wrong_and_where() {
        let error = parse("1 0 0 0\n0 one 0 0\n").unwrap_err();
        assert!(format!("{error:#}").contains("line 2: `one`"), "{error:#}");
        assert!(parse("1 2 3").unwrap_err().to_string().contains("found 3 numbers"));
        assert!(parse("2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1").is_err());
        let error = parse("# x\n\n1 0 0 0\n0 1 nan 0\n0 0 1 0\n0 0 0 1\n").unwrap_err();
        assert!(error.to_string().contains("line 4: pose entry (1, 2) is NaN"), "{error}");
    }
}
