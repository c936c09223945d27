//! A six-axis arm of boxes and cylinders as a URDF in a temporary folder.
#![allow(clippy::unwrap_used, reason = "a failing helper fails the test")]

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;

use cloudtouch::geom::{Point3, PointCloud};
use cloudtouch::{Query, QuerySettings};
use cloudtouch_robot::{Robot, RobotError};
use tempfile::TempDir;

/// Noise of the scans, m.
pub(crate) const STD: f64 = 0.002;

/// Straight up at zero; links are cylinders along z from their joint upwards.
pub(crate) struct Arm(TempDir);

impl Default for Arm {
    fn default() -> Self {
        Self(tempfile::tempdir().unwrap())
    }
}

impl Arm {
    /// Child link, axis, height of the joint over the one before, m.
    pub(crate) const JOINTS: [(&str, char, f64); 6] = [
        ("turret", 'z', 0.1),
        ("upper_arm", 'y', 0.1),
        ("forearm", 'y', 0.4),
        ("wrist_1", 'z', 0.35),
        ("wrist_2", 'y', 0.05),
        ("hand", 'z', 0.05),
    ];
    /// Links that are cylinders: radius and length, m.
    pub(crate) const CYLINDERS: [(&str, f64, f64); 3] =
        [("upper_arm", 0.05, 0.38), ("forearm", 0.04, 0.33), ("hand", 0.03, Self::HAND)];
    /// Length of the hand, m.
    pub(crate) const HAND: f64 = 0.15;
    /// How far up the hand reaches, m.
    pub(crate) const TOP: f64 = 0.1 + 0.1 + 0.4 + 0.35 + 0.05 + 0.05 + Self::HAND;

    pub(crate) fn urdf() -> String {
        let boxed = |name: &str, size: &str, z: f64| {
            format!(
                "<link name='{name}'><collision><origin xyz='0 0 {z}'/><geometry><box size='{size}'/>\
                 </geometry></collision></link>\n"
            )
        };
        let mut text = "<robot name='arm'>\n".to_owned();
        text += &boxed("base", "0.2 0.2 0.08", 0.04);
        text += &boxed("turret", "0.1 0.1 0.08", 0.04);
        text += "<link name='wrist_1'/><link name='wrist_2'/>\n";
        for (name, radius, length) in Self::CYLINDERS {
            let _ = writeln!(
                text,
                "<link name='{name}'><collision><origin xyz='0 0 {}'/><geometry><cylinder \
                 radius='{radius}' length='{length}'/></geometry></collision></link>",
                0.5 * length
            );
        }
        let mut parent = "base";
        for ((child, axis, height), name) in Self::JOINTS.into_iter().zip(NAMES) {
            let axis = if axis == 'z' { "0 0 1" } else { "0 1 0" };
            let _ = writeln!(
                text,
                "<joint name='{name}' type='revolute'><parent link='{parent}'/><child link='{child}'/>\
                 <origin xyz='0 0 {height}'/><axis xyz='{axis}'/>\
                 <limit lower='-3' upper='3' effort='1' velocity='1'/></joint>"
            );
            parent = child;
        }
        text + "</robot>\n"
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn robot(&self) -> Robot {
        self.of(&Self::urdf()).unwrap()
    }

    /// A robot of another description.
    pub(crate) fn of(&self, urdf: &str) -> Result<Robot, RobotError> {
        let path = self.path("arm.urdf");
        std::fs::write(&path, urdf).unwrap();
        Robot::from_urdf(path, &[])
    }

    pub(crate) fn srdf(&self, pairs: &[[&str; 2]]) -> PathBuf {
        let path = self.path("arm.srdf");
        let disabled = pairs.iter().map(|[a, b]| {
            format!("<disable_collisions link1='{a}' link2='{b}' reason='Never'/><group name='{a}{b}'/>\n")
        });
        let text = format!("<robot name='arm'>{}</robot>", disabled.collect::<String>());
        std::fs::write(&path, text).unwrap();
        path
    }
}

const NAMES: [&str; 6] = ["waist", "shoulder", "elbow", "roll", "pitch", "flange"];

pub(crate) fn joints(angles: [f64; 6]) -> BTreeMap<String, f64> {
    NAMES.map(str::to_owned).into_iter().zip(angles).collect()
}

pub(crate) fn query() -> Query {
    Query::new(QuerySettings::default()).unwrap()
}

/// A wall across x, 80 cm wide and high, with points 1 cm apart.
pub(crate) fn wall(x: f64) -> PointCloud {
    let at = |i: i32| (f64::from(i % 80) - 39.5) * 0.01;
    PointCloud::from_points(
        (0..6400).map(|i| Point3::new(x, at(i), 0.2 + at(i / 80))).collect::<Vec<Point3>>(),
    )
}
