//! Text of others in a page: names of files, ids of cases and messages may hold anything.

/// Text as content or quoted attribute of HTML. Control characters, which HTML cannot have, are
/// spelled out.
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
            c if c.is_control() => safe.extend(c.escape_default()),
            c => safe.push(c),
        }
    }
    safe
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
