//! Report pages as they were written.

use serde_json::Value;

use super::Inputs;

/// What the script of a page is given.
pub(crate) fn data(page: &str) -> Value {
    let (_, rest) = page.split_once("<script type=\"application/json\" id=\"data\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

/// A page among the files.
pub(crate) fn page(inputs: &Inputs, name: &str) -> String {
    std::fs::read_to_string(inputs.path(name)).unwrap()
}
