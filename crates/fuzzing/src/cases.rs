//! Case files: any bytes give cases, each of them good or with its reason, or one error.

use std::path::Path;

use cloudtouch_cli::files::case;

/// No message is longer: it holds an excerpt of the file, never the file.
const LONGEST_MESSAGE: usize = 450;

/// Bytes as a case file.
///
/// # Panics
/// When a case that was taken has a pose that is not finite, or an error says nothing.
pub fn case_file(bytes: &[u8]) {
    match case::parse(bytes, Path::new("folder")) {
        Ok(file) => {
            for (id, case) in file.cases {
                match case {
                    Ok(case) => {
                        assert_eq!(case.scene_from_object.non_finite_entry(), None, "{id}");
                    }
                    Err(error) => check_message(&format!("{error:#}")),
                }
            }
        }
        Err(error) => check_message(&format!("{error:#}")),
    }
}

fn check_message(message: &str) {
    assert!(!message.trim().is_empty(), "an error without a message");
    let length = message.chars().count();
    assert!(length < LONGEST_MESSAGE, "{length} characters of message");
}
