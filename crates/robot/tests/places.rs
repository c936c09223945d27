//! Elements that are where they are not read, or in another file.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::Arm;

const SHAPE: &str = "<geometry><box size='1 1 1'/></geometry>";

/// A link, and one that hangs on it: what is in that, and in the joint between them.
fn robot(link: &str, joint: &str, beside: &str) -> String {
    format!(
        "<robot name='r'><link name='a'><collision>{SHAPE}</collision></link>\
         <link name='b'>{link}</link><joint name='j' type='fixed'><parent link='a'/><child link='b'/>\
         {joint}</joint>{beside}</robot>"
    )
}

/// They were passed over: a link without a shape touches nothing, and one at another place something else.
#[test]
fn shapes_where_they_are_not_read_were_not_there() {
    let arm = Arm::default();
    let collision = format!("<collision>{SHAPE}</collision>");
    for (urdf, told) in [
        (
            robot(SHAPE, "", ""),
            "<geometry> is in <link>, where it is not read: put it into <collision> or",
        ),
        (robot("<box size='1 1 1'/>", "", ""), "<box> is in <link>"),
        (
            robot("", &collision, ""),
            "<collision> is in <joint>, where it is not read: put it into <link>",
        ),
        (robot("", "", &collision), "<collision> is in <robot>"),
        (
            robot(&format!("<visual>{SHAPE}{collision}</visual>"), "", ""),
            "<collision> is in <visual>",
        ),
        (robot("<link name='c'/>", "", ""), "<link> is in <link>"),
        (robot("", "<axis xyz='0 0 1'><limit lower='1'/></axis>", ""), "<limit> is in <axis>"),
        (
            robot(
                "<collision><geometry><sphere radius='1'><origin xyz='0 0 1'/></sphere></geometry></collision>",
                "",
                "",
            ),
            "<origin> is in <sphere>",
        ),
        (robot(&collision.replace("</geometry>", "<sphere radius='9'/></geometry>"), "", ""), ""),
        (robot(&collision.replace("</collision>", &format!("{SHAPE}</collision>")), "", ""), ""),
    ] {
        let error = arm.of(&urdf).unwrap_err().to_string();
        assert!(error.contains("arm.urdf: ") && error.contains(told), "{error}");
    }
    let sensor = "<sensor name='s'><parent link='b'/><origin xyz='0 0 1'/></sensor>";
    let filter = format!("<self_filter>{SHAPE}</self_filter>{collision}");
    assert!(arm.of(&robot(&filter, "", sensor)).is_ok());
}

/// What was in it was not there.
#[test]
fn a_part_in_another_file_was_passed_over() {
    let arm = Arm::default();
    for include in ["<include filename='hand.urdf'/>", "<xi:include href='hand.urdf'></xi:include>"]
    {
        let error = arm.of(&robot("", "", include)).unwrap_err().to_string();
        assert!(error.contains("include> is not expanded"), "{error}");
    }
    let entity = "<!DOCTYPE robot [<!ENTITY hand SYSTEM 'hand.xml'>]>".to_owned();
    let error = arm.of(&(entity + &robot("", "", "&hand;"))).unwrap_err().to_string();
    assert!(error.contains("arm.urdf: "), "{error}");
}

/// A link or a shape with a prefix was not there, and a file of nothing else had "no elements".
#[test]
fn what_is_of_the_robot_and_has_a_prefix_was_not_there() {
    let plain = robot(&format!("<collision>{SHAPE}</collision>"), "", "");
    let arm = Arm::default();
    assert!(arm.of(&plain).is_ok());
    for (prefixed, told) in [
        (plain.replace('<', "<u:").replace("<u:/", "</u:"), "<u:robot> has a prefix"),
        (
            plain.replace("<collision", "<u:collision").replace("</collision", "</u:collision"),
            "write <collision>",
        ),
        (plain.replace("</robot>", "<u:link name='c'/></robot>"), "write <link>"),
    ] {
        let error = arm.of(&prefixed).unwrap_err().to_string();
        assert!(error.contains("arm.urdf: ") && error.contains(told), "{error}");
    }
    let others = "<s:camera><s:parent/></s:camera><u:collision_filter/>";
    assert!(arm.of(&robot("", "", others)).is_ok());
}
