//! Slips in the numbers and the range of a joint of a URDF.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::Arm;
use cloudtouch_robot::{Robot, RobotError};

/// A link of this geometry, and one that hangs on it by a joint with this limit.
fn robot(geometry: &str, limit: &str) -> Result<Robot, RobotError> {
    let limit = format!("<limit {limit} effort='1' velocity='1'/>");
    Arm::default().of(&format!(
        "<robot name='r'><link name='a'><collision><geometry>{geometry}</geometry></collision></link>\
         <link name='b'/><joint name='j' type='revolute'><parent link='a'/><child link='b'/>{limit}</joint></robot>"
    ))
}

/// They were read as left out: the joint could not move that way.
#[test]
fn slips_in_the_range_of_a_joint_are_refused() {
    for (limit, told) in [
        ("lower='-1' uper='1'", "`uper` of <limit> is not known: write upper"),
        ("Lower='-1' upper='1'", "`Lower` of <limit> is not known: write lower"),
        ("min='-1' max='1'", "`min` of <limit> is not known: write lower"),
        ("lower='-1' Upper_Limit='1'", "`Upper_Limit` of <limit> is not known: write upper"),
    ] {
        let error = robot("<sphere radius='1'/>", limit).unwrap_err().to_string();
        assert!(error.contains(told), "{error}");
    }
    let drive = "lower='-1' upper='1' command_effort='3' current='2'";
    assert!(robot("<sphere radius='1'/>", drive).is_ok());
}

/// A file of sixty links was to be searched for what had no name.
#[test]
fn what_cannot_be_read_is_told_with_its_link_or_joint_and_line() {
    let good = "<robot name='r'>\n<link name='a'>\n<collision><geometry><sphere radius='1'/></geometry></collision>\n\
                </link>\n<link name='b'/>\n<joint name='j' type='fixed'>\n<parent link='a'/>\n<child link='b'/>\n\
                </joint>\n</robot>";
    assert!(Arm::default().of(good).is_ok());
    for (right, wrong, place, told) in [
        ("<child link='b'/>", "", "joint `j`, line 6", "missing field `child`"),
        ("<child link='b'/>", "<child/>", "joint `j`, line 6", "missing field `link`"),
        ("type='fixed'", "type='hinge'", "joint `j`, line 6", "`hinge`"),
        ("<sphere radius='1'/>", "", "link `a`, line 2", "<geometry> is empty: put"),
        ("<sphere radius='1'/>", "<sphere/>", "link `a`, line 2", "missing field `radius`"),
        // The words of the reader were about tokens.
        (
            "<sphere radius='1'/>",
            "<sphere radius='1'/><!-- and --><box size='1 1 1'/>",
            "link `a`, line 2",
            "<box> is a second shape in <geometry>: give each a <collision> of its own",
        ),
        ("<sphere radius='1'/>", "<cone radius='1'/>", "link `a`, line 2", "`cone`"),
        ("radius='1'", "radius='5cm'", "link `a`, line 2", "`radius` of <sphere> is `5cm`"),
        ("link name='b'", "link", "<link>, line 5", "missing field `name`"),
        ("</geometry>", "</geometri>", "link `a`, line 3", "`</geometri>`"),
        ("</joint>\n</robot>", "", "joint `j`, where the file ends", ""),
        ("</robot>", "", "the file ends before </robot>", ""),
    ] {
        let error = Arm::default().of(&good.replacen(right, wrong, 1)).unwrap_err().to_string();
        let place = format!("arm.urdf: cannot be understood: {place}: ");
        assert!(error.contains(&place) && error.contains(told), "{place}{told} is not in {error}");
        assert_eq!(error.lines().count(), 1, "{error}");
    }
}

/// Of the thousands of pairs in an SRDF, none was named.
#[test]
fn a_pair_of_an_srdf_that_cannot_be_read_is_told_with_its_line() {
    let arm = Arm::default();
    let good = "<robot name='r'>\n<group name='g'/>\n<disable_collisions link1='base' link2='hand'/>\n\
                <disable_collisions\n link1='turret' link2='hand' reason='Never'/>\n</robot>";
    let read = |text: &str| {
        let srdf = arm.path("arm.srdf");
        std::fs::write(&srdf, text).unwrap();
        arm.robot().with_srdf(srdf).map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(read(good), Ok(()));
    for (right, wrong, told) in [
        ("link1='turret'", "", "<disable_collisions>, line 4: missing field"),
        ("link2='hand'/>", "Link2='hand'/>", "<disable_collisions>, line 3: missing field"),
        ("'Never'/>", "'Never'>", "<disable_collisions>, line 6: "),
        ("</robot>", "", "the file ends before </robot>: "),
    ] {
        let error = read(&good.replacen(right, wrong, 1)).unwrap_err();
        assert!(error.contains("arm.srdf: ") && error.contains(told), "{told} is not in {error}");
    }
}

/// Which number of which element it is was not told.
#[test]
fn what_is_no_number_is_told_with_its_element_and_attribute() {
    for (geometry, limit, told) in [
        ("<mesh filename='a' scale='0.001'/>", "", "`scale` of <mesh> is `0.001`: give 3 numbers"),
        ("<sphere radius=''/>", "", "`radius` of <sphere> is ``: give 1 number"),
        ("<sphere radius='5cm'/>", "", "`radius` of <sphere> is `5cm`: `5cm` is not a number"),
        (
            "<sphere radius='1'/>",
            "lower='-1' upper='1,5'",
            "`upper` of <limit> is `1,5`: `1,5` is not",
        ),
    ] {
        let error = robot(geometry, limit).unwrap_err().to_string();
        assert!(error.contains("arm.urdf: ") && error.contains(told), "{error}");
    }
}
