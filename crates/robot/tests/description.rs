//! Descriptions that are wrong, and what is read of those that are right.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeMap;

use crate::support::{Arm, joints};
use cloudtouch::geom::Vector3;
use cloudtouch_io::write_mesh_obj;
use cloudtouch_robot::{JointsError, Robot};
use cloudtouch_testkit::scene::cuboid;

/// One link of this geometry, and one that hangs on it by this joint.
fn two_links(geometry: &str, joint: &str) -> String {
    format!(
        "<robot name='two'><link name='a'><collision><geometry>{geometry}</geometry></collision></link>\
         <link name='b'/><joint name='j' {joint}<parent link='a'/><child link='b'/></joint></robot>"
    )
}

const FIXED: &str = "type='fixed'>";
const BOX: &str = "<box size='0.1 0.1 0.1'/>";

fn mesh(file: &str, more: &str) -> String {
    two_links(&format!("<mesh filename='{file}' {more}/>"), FIXED)
}

#[test]
fn what_is_wrong_is_named_with_file_value_and_remedy() {
    let arm = Arm::default();
    let path = |name: &str| arm.path(name);
    write_mesh_obj(path("cube.obj"), &cuboid([0.1; 3])).unwrap();
    write_mesh_obj(path("mm.obj"), &cuboid([100.0; 3])).unwrap();
    std::fs::write(path("old.dae"), "<COLLADA/>").unwrap();
    std::fs::write(path("cut.stl"), "solid cut\nfacet").unwrap();
    let joint = |joint: &str| two_links(BOX, joint);
    let limits = "<limit lower='1' upper='-1' effort='0' velocity='0'/>";
    for (urdf, parts) in [
        (mesh("gone.stl", ""), vec!["link `a`", "gone.stl", "no file", "correct the path"]),
        // It was told that there is no file of no name.
        (mesh("", ""), vec!["link `a`", "empty filename", "name the file"]),
        (mesh("package://mine/cube.obj", ""), vec!["`a`", "`mine`", "name it in `packages`"]),
        (mesh("http://x.org/cube.obj", ""), vec!["`a`", "http://x.org/cube.obj", "package://"]),
        (mesh("old.dae", ""), vec!["`a`", "old.dae", "COLLADA", "convert it to STL or OBJ"]),
        (mesh("GONE.DAE", ""), vec!["`a`", "GONE.DAE", "convert it"]),
        (mesh("cut.stl", ""), vec!["`a`", "cut.stl"]),
        (
            mesh("mm.obj", ""),
            vec!["`a`", "mm.obj", "173.205 m", "millimetres", "0.001 0.001 0.001"],
        ),
        (mesh("cube.obj", "scale='0.001 0.001 0.001'"), vec!["`a`", "0.000 m", "scaled twice"]),
        (mesh("cube.obj", "scale='1 0 1'"), vec!["`a`", "mesh scale", "above 0"]),
        (mesh("cube.obj", "scale='1 nan 1'"), vec!["a", "NaN", "mesh scale", "finite"]),
        (two_links("<box size='1 -1 1'/>", FIXED), vec!["`a`", "-1", "box size"]),
        (two_links("<sphere radius='inf'/>", FIXED), vec!["`a`", "inf", "sphere radius"]),
        (joint("type='floating'>"), vec!["`j`", "floating", "pose of the base"]),
        (joint("type='continuous'><axis xyz='0 0 0'/>"), vec!["`j`", "axis of length zero"]),
        (joint("type='fixed'><origin xyz='0 nan 0'/>"), vec!["`j`", "NaN", "origin xyz"]),
        (joint(&format!("type='revolute'>{limits}")), vec!["`j`", "1 .. -1"]),
        // The joints were told to be beyond limits of 0 .. 0.
        (joint("type='revolute'>"), vec!["`j`", "no <limit>", "revolute", "make it continuous"]),
        (joint("type='prismatic'>"), vec!["`j`", "no <limit>", "prismatic", "make it fixed"]),
        (joint("type='continuous'><mimic joint='k'/>"), vec!["`j`", "mimics `k`"]),
        (joint("type='continuous'><mimic joint='j'/>"), vec!["`j`", "mimics `j`"]),
        (joint(FIXED).replace("child link='b'", "child link='c'"), vec!["`j`", "child `c`"]),
        (
            joint(FIXED).replace("child link='b'", "child link='a'"),
            vec!["`a` is carried by itself"],
        ),
        (joint(FIXED).replace("link name='b'", "link name='a'"), vec!["link `a`", "twice"]),
        (
            joint(FIXED).replace("</robot>", "<link name='c'/></robot>"),
            vec!["`c`", "one root (`a`)"],
        ),
        (two_links(BOX, FIXED).replace("collision", "visual"), vec!["no link has <collision>"]),
        ("<robot name='x'".to_owned(), vec!["cannot be understood", "xacro"]),
        (" \n".to_owned(), vec!["is empty", "give a file that describes the robot"]),
    ] {
        let error = arm.of(&urdf).unwrap_err().to_string();
        for part in parts.iter().chain(&["arm.urdf: "]) {
            assert!(error.contains(part), "{part:?} in {error}");
        }
    }
    let error = Robot::from_urdf(path("none.urdf"), &[]).unwrap_err().to_string();
    assert!(error.contains("none.urdf") && error.contains("cannot be read"), "{error}");
}

#[test]
fn meshes_are_found_by_package_file_and_path_and_scaled() {
    let arm = Arm::default();
    let folder = arm.path("elsewhere/meshes");
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("mm.obj");
    write_mesh_obj(&file, &cuboid([100.0, 200.0, 300.0])).unwrap();
    let urdf = arm.path("arm.urdf");
    let packages = [("mine".to_owned(), arm.path("elsewhere"))];
    let scale = "scale='0.001 0.001 -0.001'";
    for name in [
        "package://mine/meshes/mm.obj",
        &format!("file://{}", file.display()),
        "elsewhere/meshes/mm.obj",
    ] {
        std::fs::write(&urdf, mesh(name, scale)).unwrap();
        let robot = Robot::from_urdf(&urdf, &packages).unwrap();
        let links = robot.self_filter(&BTreeMap::new(), &Default::default(), 0.0).unwrap();
        let [link] = &links[..] else { panic!("one link is a mesh") };
        assert!((link.mesh.size() - Vector3::new(0.1, 0.2, 0.3).norm()).abs() < 1e-12);
        assert!(link.mesh.is_watertight() && link.mesh.signed_distance(&Default::default()) < 0.0);
    }
    // A package is found beside the folder of the URDF, too.
    std::fs::write(&urdf, mesh("package://elsewhere/meshes/mm.obj", scale)).unwrap();
    Robot::from_urdf(&urdf, &[]).unwrap();
}

/// Its schema asks for a velocity, which places nothing; the message named neither joint nor remedy.
#[test]
fn a_limit_without_velocity_was_no_urdf() {
    let arm = Arm::default();
    let limited = |more: &str| two_links(BOX, &format!("type='revolute'><limit {more}/>"));
    let robot = arm.of(&limited("lower='-1' upper='2'")).unwrap();
    assert_eq!(robot.joints()[0].limits, Some([-1.0, 2.0]));
    let error = arm.of(&limited("")).unwrap_err().to_string();
    assert!(error.contains("joint `j` has no <limit> with a range"), "{error}");
}

/// It was told to be beyond limits of 0 .. 0, and not that the file has no range.
#[test]
fn a_joint_without_a_range_is_told_to_have_none() {
    let arm = Arm::default();
    for (kind, range, instead) in [
        ("revolute", "", ", or make it continuous"),
        ("revolute", "lower='0' upper='0.0'", ", or make it continuous"),
        ("prismatic", "lower='0' upper='-0'", "into the URDF"),
    ] {
        let limit = format!("type='{kind}'><limit {range} effort='9' velocity='1'/>");
        let robot = arm.of(&two_links(BOX, &limit)).unwrap();
        let at = |value: f64| robot.link_poses(&BTreeMap::from([("j".to_owned(), value)]));
        assert!(at(0.0).is_ok(), "{limit}");
        let error = at(0.5).unwrap_err().to_string();
        assert!(error.contains("joint `j` is at 0.5, and its <limit> keeps it at 0"), "{error}");
        assert!(error.contains("left out or 0") && error.ends_with(instead), "{error}");
    }
}

/// A URDF in the place of the SRDF let no pair touch, without a word.
#[test]
fn a_urdf_is_not_taken_for_an_srdf() {
    let arm = Arm::default();
    let urdf = arm.path("itself.urdf");
    std::fs::write(&urdf, two_links(BOX, FIXED)).unwrap();
    let error = arm.of(&two_links(BOX, FIXED)).unwrap().with_srdf(urdf).unwrap_err().to_string();
    assert!(error.contains("itself.urdf") && error.contains("give the SRDF"), "{error}");
}

/// What an SRDF of MoveIt says beside its pairs names joints and frames that are no links.
#[test]
fn links_of_an_srdf_that_are_not_there_are_named() {
    let arm = Arm::default();
    let of = |pairs: &str| {
        let more = "<virtual_joint name='v' type='fixed' parent_frame='world' child_link='a'/>\
                    <passive_joint name='j'/><group name='g'><joint name='k'/></group>";
        let srdf = arm.path("two.srdf");
        std::fs::write(&srdf, format!("<robot name='two'>{more}{pairs}</robot>")).unwrap();
        arm.of(&two_links(BOX, FIXED)).unwrap().with_srdf(srdf).unwrap()
    };
    let pair =
        |link: &str| format!("<disable_collisions link1='a' link2='{link}' reason='Never'/>");
    assert!(of(&pair("b")).unknown_links().is_empty());
    assert_eq!(of(&(pair("c") + &pair("b") + &pair("c"))).unknown_links(), ["c"]);
}

#[test]
fn positions_that_place_no_robot_are_refused() {
    let robot = Arm::default().robot();
    let with = |name: &str, value: f64| {
        let mut changed = joints([0.0; 6]);
        changed.insert(name.to_owned(), value);
        robot.link_poses(&changed).unwrap_err()
    };
    let unknown = with("elbo", 0.0);
    assert!(matches!(&unknown, JointsError::Unknown { name, .. } if name == "elbo"));
    assert!(unknown.to_string().contains("`elbow`"), "{unknown}");
    assert!(matches!(with("elbow", f64::NAN), JointsError::NotFinite { .. }));
    let beyond = with("elbow", 3.1);
    assert!(beyond.to_string().contains("3.1, beyond its limits -3 .. 3"), "{beyond}");
    assert!(with("elbow", 90.0).to_string().contains("in degrees"));
    assert!(with("elbow", -90.0).to_string().contains("in degrees"));
    let mut few = joints([0.0; 6]);
    few.remove("elbow");
    few.remove("waist");
    let missing = robot.link_poses(&few).unwrap_err().to_string();
    assert!(missing.contains("`elbow`, `waist`"), "{missing}");
}

/// A gripper: one finger slides, the other follows the other way.
#[test]
fn a_joint_that_mimics_follows() {
    let finger = |name: &str, joint: &str, more: &str| {
        format!(
            "<link name='{name}'/><joint name='{joint}' type='prismatic'><parent link='palm'/>\
             <child link='{name}'/><axis xyz='0 2 0'/>\
             <limit lower='-0.05' upper='0.05' effort='1' velocity='1'/>{more}</joint>"
        )
    };
    let urdf = format!(
        "<robot name='gripper'><link name='palm'><collision><geometry>{BOX}</geometry></collision></link>\
         {}{}</robot>",
        finger("right", "right_slide", "<mimic joint='left_slide' multiplier='-2' offset='0.01'/>"),
        finger("left", "left_slide", ""),
    );
    let robot = Arm::default().of(&urdf).unwrap();
    let at = |positions: &[(&str, f64)]| {
        let positions = positions.iter().map(|&(name, at)| (name.to_owned(), at)).collect();
        let poses = robot.link_poses(&positions)?;
        Ok::<_, JointsError>(["left", "right"].map(|link| poses[link].translation().y))
    };
    // The axis is a direction, whatever its length.
    let [left, right] = at(&[("left_slide", 0.02)]).unwrap();
    assert!((left - 0.02).abs() < 1e-15 && (right + 0.03).abs() < 1e-15);
    assert_eq!(at(&[("left_slide", 0.02), ("right_slide", -0.03)]).unwrap(), [left, right]);
    let error = at(&[("left_slide", 0.02), ("right_slide", 0.03)]).unwrap_err();
    assert!(matches!(error, JointsError::Mimic { .. }), "{error}");
    // What follows has limits of its own.
    let error = at(&[("left_slide", 0.04)]).unwrap_err().to_string();
    assert!(error.contains("`right_slide` is at -0.07"), "{error}");
    assert!(matches!(at(&[]).unwrap_err(), JointsError::Missing { .. }));
}

/// Of links that no chain of joints leads to, the first in the file was named, which may have a parent, and of a circle
/// an empty name.
#[test]
fn where_links_are_no_tree_a_second_root_or_a_circle_is_named() {
    let joined = |pairs: &[[&str; 2]]| {
        let joint = |[parent, child]: &[&str; 2]| {
            format!(
                "<joint name='to_{child}' type='fixed'><parent link='{parent}'/><child link='{child}'/></joint>"
            )
        };
        let links = ["a", "b", "c", "d"].map(|link| {
            format!("<link name='{link}'><collision><geometry>{BOX}</geometry></collision></link>")
        });
        let joints: String = pairs.iter().map(joint).collect();
        let urdf = format!("<robot name='four'>{}{joints}</robot>", links.concat());
        Arm::default().of(&urdf).map_or_else(|error| error.to_string(), |_| String::new())
    };
    assert_eq!(joined(&[["b", "a"], ["d", "b"], ["a", "c"]]), "");
    let error = joined(&[["a", "b"], ["d", "c"]]);
    assert!(error.contains("(`a`): no chain of joints leads to `d`"), "{error}");
    let under_it = [["c", "b"], ["d", "c"], ["c", "d"]];
    let of_all = [["b", "a"], ["a", "b"], ["d", "c"], ["c", "d"]];
    for circle in [&under_it[..], &of_all] {
        let error = joined(circle);
        let is_named = |link: &&str| error.contains(&format!("link `{link}` is carried by itself"));
        assert!(["a", "c", "d"].iter().any(is_named), "{error}");
        assert!(error.contains("correct the parent"), "{error}");
    }
}

/// The square of its length was infinite, and the joint moved nothing.
#[test]
fn an_axis_is_a_direction_however_long_it_is() {
    for length in [1e-6, 1.0, 1e200, 1.5e308] {
        let joint = format!("type='continuous'><axis xyz='0 {length:e} 0'/>");
        let robot = Arm::default().of(&two_links(BOX, &joint)).unwrap();
        let poses = robot.link_poses(&BTreeMap::from([("j".to_owned(), 1.0)])).unwrap();
        let turned = poses["b"].transform_vector(&Vector3::x());
        assert!(
            (turned - Vector3::new(1.0_f64.cos(), 0.0, -1.0_f64.sin())).norm() < 1e-12,
            "{length}"
        );
    }
}
