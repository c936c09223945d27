//! Text of others in a page: names of files, ids of cases and messages may hold anything.

use std::borrow::Cow;

/// Text as content or quoted attribute of HTML. Control characters, which HTML cannot have, are
/// spelled out, and so are those that turn the direction of what follows them: numbers too.
pub(crate) fn html(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            '\n' | '\t' => safe.push(c),
            c if c.is_control() || turns(c) => safe.extend(c.escape_default()),
            c => safe.push(c),
        }
    }
    safe
}

/// Whether a character sets the direction of text, its own aside (Unicode's Bidi_Control).
fn turns(c: char) -> bool {
    matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Text that a script puts into the page, which makes no HTML of it.
pub(crate) fn plain(text: &str) -> Cow<'_, str> {
    match text.contains(turns) {
        true => text
            .chars()
            .map(|c| if turns(c) { c.escape_default().to_string() } else { c.to_string() })
            .collect(),
        false => text.into(),
    }
}

/// JSON as content of a script element: nothing in it can end the element or begin a comment. The
/// characters occur in strings only, where JSON may spell them by their number.
pub(crate) fn json(text: &str) -> String {
    text.replace('&', "\\u0026").replace('<', "\\u003c").replace('>', "\\u003e")
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn nothing_leaves_its_place() {
        let hostile = "</script><img src=x onerror='alert(1)'>\"&\u{7}<!--";
        let safe = html(hostile);
        assert!(!safe.contains(['<', '>', '"', '\'', '\u{7}']), "{safe}");
        assert!(safe.ends_with("&amp;\\u{7}&lt;!--"), "{safe}");
    }

    /// A file name turned round the numbers that followed it in a sentence: 21 triangles for 12.
    #[test]
    fn a_name_does_not_turn_what_follows_it() {
        let name = "a\u{202e}gpj.obj\u{2066}";
        assert_eq!(html(name), "a\\u{202e}gpj.obj\\u{2066}");
        assert_eq!(plain(name), "a\\u{202e}gpj.obj\\u{2066}");
        // Letters that are written from the right have their direction in themselves.
        let letters = "\u{5e1}\u{5e8}\u{5d9}\u{5e7}\u{5d4} é\u{301} 扫描 🤖.pcd";
        assert_eq!((html(letters), plain(letters)), (letters.to_owned(), letters.into()));
    }

    proptest! {
        #[test]
        fn json_means_the_same_afterwards(text in ".*") {
            let text = format!("{text}</script>");
            let safe = json(&serde_json::to_string(&text).unwrap_or_default());
            prop_assert!(!safe.contains(['<', '>', '&']));
            prop_assert_eq!(serde_json::from_str::<String>(&safe).ok(), Some(text));
        }
    }
}
