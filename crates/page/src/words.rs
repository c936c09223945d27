//! Words and numbers of answers for people, the same on a page and on a terminal.

use cloudtouch::{Clearance, Undecided, Unseen, Verdict};

/// A probability with the digits that mean something.
pub fn probability(p: f64) -> String {
    if p == 0.0 || p >= 1e-3 { format!("{p:.3}") } else { format!("{p:.0e}") }
}

/// A distance in millimetres, of less than a tenth in micrometres, from a metre on in metres.
pub fn length(metres: f64) -> String {
    match metres.abs() {
        size if size > 0.0 && size < 1e-4 => format!("{:.1} µm", 1e6 * metres),
        size if size < 1.0 => format!("{:.1} mm", 1e3 * metres),
        _ => format!("{metres:.2} m"),
    }
}

/// How many decimals of metres tell something of a body so large, m.
pub fn decimals(size: f64) -> usize {
    if size > 0.0 { (1.0 - size.log10().floor()).clamp(3.0, 9.0) as usize } else { 3 }
}

/// How large a body is, m.
pub fn across(size: f64) -> String {
    format!("{size:.0$} m across", decimals(size))
}

/// How much of a body a depth image did not see, and why.
pub fn unseen(unseen: &Unseen) -> String {
    let all = [
        ("behind the camera", unseen.behind_camera),
        ("outside of its view", unseen.outside_view),
        ("in holes of the image", unseen.hole),
        ("beyond the range kept", unseen.out_of_range),
        ("behind what it saw", unseen.behind_returns),
    ];
    let shares: Vec<String> = all
        .iter()
        .filter(|(_, share)| *share > 0.0)
        .map(|(place, share)| format!("{} {place}", percent(*share)))
        .collect();
    if shares.is_empty() {
        return format!("nothing of the {}", unseen.body);
    }
    format!("{} of the {}: {}", percent(unseen.share()), unseen.body, shares.join(", "))
}

/// Rounded up, as in the warning: what is above the share allowed is not told as if it were not; the last digit of
/// a product is no share (7 % of 0.07, not 8).
fn percent(share: f64) -> String {
    format!("{:.0} %", (100.0 * share - 1e-9).max(0.0).ceil())
}

/// What a verdict means, in a sentence.
pub fn verdict(verdict: Verdict, by: Option<Undecided>) -> String {
    match verdict {
        Verdict::Free => "The surfaces are apart: even the upper bound on the probability of a \
                          collision is below the threshold."
            .to_owned(),
        Verdict::InCollision => {
            "The surfaces touch or overlap: the probability is above the threshold.".to_owned()
        }
        Verdict::Uncertain => "The surfaces may touch or be apart: the measurements do not tell. \
                               Look again, move away, or use a better sensor."
            .to_owned(),
        Verdict::Undecided => {
            format!(
                "No decision: {}. Treat it as not free.",
                by.map_or_else(|| "see the warnings".to_owned(), |by| by.to_string())
            )
        }
    }
}

/// A measured gap, or what is known where none was measured: `at_least` m, if anything bounds it.
pub fn clearance(measured: Option<Clearance>, at_least: Option<f64>) -> String {
    match measured {
        Some(Clearance { mean, std, is_bound, .. }) => {
            let deeper = if is_bound { " or deeper" } else { "" };
            let side = if mean < 0.0 { "overlap of" } else { "gap of" };
            format!("{side} {}{deeper}, standard deviation {}", length(mean.abs()), length(std))
        }
        None => match at_least.filter(|least| *least > 0.0) {
            Some(least) => format!("at least {}", length(least)),
            None => "not computed".to_owned(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_share_above_the_one_allowed_was_told_as_that_one() {
        let told = [0.0, 0.001, 0.052, 0.07, 1.0].map(percent);
        assert_eq!(told, ["0 %", "1 %", "6 %", "7 %", "100 %"]);
    }

    #[test]
    fn what_is_smaller_than_a_millimetre_was_told_as_nothing() {
        assert_eq!([0.0, 3e-5, 0.0021].map(length), ["0.0 mm", "30.0 µm", "2.1 mm"]);
        let sizes = [0.0, f64::NAN, 3e-4, 4e-3, 0.2, 21.0];
        assert_eq!(sizes.map(decimals), [3, 3, 5, 4, 3, 3]);
        assert_eq!(across(4.26e-3), "0.0043 m across");
    }

    #[test]
    fn a_clearance_says_which_side_and_how_sure() {
        let of = |mean, is_bound| {
            let mut measured = Clearance::new(mean, 0.01);
            measured.is_bound = is_bound;
            clearance(Some(measured), None)
        };
        assert_eq!(of(0.0299, false), "gap of 29.9 mm, standard deviation 10.0 mm");
        assert_eq!(of(-0.0092, true), "overlap of 9.2 mm or deeper, standard deviation 10.0 mm");
        assert_eq!(clearance(None, Some(0.0512)), "at least 51.2 mm");
        assert_eq!(clearance(None, Some(-0.1)), "not computed");
        assert_eq!(clearance(None, Some(43.8512)), "at least 43.85 m");
        assert_eq!(clearance(None, None), "not computed");
    }
}
