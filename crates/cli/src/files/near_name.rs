//! Fields that are nearly known ones: where others are passed over, a slip of the pen would be too.

use strsim::osa_distance;

/// The known name that is meant by one that is none. Names that are given as well are not meant: what is
/// beside them is something else.
pub(crate) fn meant<'a>(
    name: &str,
    known: &[&'a str],
    is_given: impl Fn(&str) -> bool,
) -> Option<&'a str> {
    let is_meant = |candidate: &&&str| !is_given(candidate) && is_near(name, candidate);
    known.iter().find(is_meant).copied()
}

/// Whether a name is another, as an option or a field, in whatever case, in the plural or with a slip where it is long.
pub(crate) fn is_spelt(name: &str, other: &str) -> bool {
    let (name, other) = (letters(name), letters(other));
    let is_plural = name.strip_suffix('s') == Some(&other);
    name == other || is_plural || (other.len() >= 5 && osa_distance(&name, &other) <= 1)
}

/// The same letters, or as many words of which each is cut short or misspelt.
fn is_near(name: &str, known: &str) -> bool {
    let words = |text: &str| -> Vec<String> {
        text.split(|c: char| !c.is_alphanumeric()).map(letters).collect()
    };
    let (given, wanted) = (words(name), words(known));
    let all_near = || given.iter().zip(&wanted).all(|(a, b)| is_near_word(a, b));
    letters(name) == letters(known) || (given.len() == wanted.len() && all_near())
}

fn letters(text: &str) -> String {
    text.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

/// Of short words most are a slip away from another.
fn is_near_word(word: &str, known: &str) -> bool {
    let slips = match known.len() {
        0..4 => 0,
        4 => 1,
        _ => 2,
    };
    let is_cut = word.len() >= 3 && known.starts_with(word);
    is_cut || osa_distance(word, known) <= slips
}
