//! Files whose elements are nested without end.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::Arm;

fn nested(inner: &str, times: usize) -> String {
    format!("<robot name='r'>{inner}{}{}</robot>", "<q>".repeat(times), "</q>".repeat(times))
}

/// It ended the program: one reader counts levels in 16 bits, the other calls itself for each.
#[test]
fn elements_nested_without_end_ended_the_program() {
    let arm = Arm::default();
    let srdf = arm.path("deep.srdf");
    std::fs::write(&srdf, nested("<disable_collisions link1='base' link2='hand'/>", 70_000))
        .unwrap();
    let of_srdf = arm.robot().with_srdf(&srdf).unwrap_err().to_string();
    let link =
        "<link name='a'><collision><geometry><sphere radius='1'/></geometry></collision></link>";
    let of_urdf = arm.of(&nested(link, 70_000)).unwrap_err().to_string();
    for error in [of_srdf, of_urdf] {
        assert!(error.contains("nested more than 100 deep"), "{error}");
    }
    assert!(arm.of(&nested(link, 90)).is_ok());
}
