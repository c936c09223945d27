//! Small inputs in a temporary folder, and runs of the tool on them.
#![allow(clippy::unwrap_used, reason = "a failing helper fails the test")]

pub(crate) mod browser;
pub(crate) mod pages;

use std::path::PathBuf;
use std::process::Output;

use assert_cmd::Command;
use cloudtouch::geom::{Point3, PointCloud, TriangleMesh};
use serde_json::Value;
use tempfile::TempDir;

/// A folder with `floor.pcd`, a flat square of 1 m with points 5 cm apart, and `box.obj`, a
/// watertight cube of 20 cm about the origin.
pub(crate) struct Inputs(TempDir);

/// Poses of the box over the floor with clear answers: (verdict, exit code, height of its centre).
pub(crate) const HEIGHTS: [(&str, i32, f64); 3] =
    [("free", 0, 0.5), ("uncertain", 10, 0.1005), ("in_collision", 20, 0.05)];

impl Inputs {
    pub(crate) fn new() -> Self {
        let inputs = Self(tempfile::tempdir().unwrap());
        cloudtouch_io::write_cloud_pcd(inputs.path("floor.pcd"), &floor()).unwrap();
        cloudtouch_io::write_mesh_obj(inputs.path("box.obj"), &cube(0.1)).unwrap();
        inputs
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).unwrap();
    }

    /// Runs the tool in this folder.
    pub(crate) fn run(&self, arguments: &[&str]) -> Run {
        let mut command = Command::cargo_bin("cloudtouch").unwrap();
        Run(command.current_dir(self.0.path()).args(arguments).output().unwrap())
    }

    /// `query floor.pcd box.obj` with the box at a height, and more arguments.
    pub(crate) fn query_at(&self, height: f64, more: &[&str]) -> Run {
        let translate = format!("--translate=0.01,0.02,{height}");
        let arguments = ["query", "floor.pcd", "box.obj", "--sensor=iso:0.002", &translate];
        self.run(&[&arguments, more].concat())
    }

    /// Names of everything in the folder.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<String> =
            entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

/// What a run of the tool left behind.
pub(crate) struct Run(Output);

impl Run {
    pub(crate) fn code(&self) -> i32 {
        self.0.status.code().unwrap()
    }

    pub(crate) fn stdout(&self) -> String {
        String::from_utf8(self.0.stdout.clone()).unwrap()
    }

    pub(crate) fn stderr(&self) -> String {
        String::from_utf8(self.0.stderr.clone()).unwrap()
    }

    /// Checks the exit code, and that nothing was said on standard error.
    pub(crate) fn quiet(self, code: i32) -> Self {
        assert_eq!((self.code(), self.stderr().as_str()), (code, ""), "{}", self.stdout());
        self
    }

    /// Every line of standard output as JSON.
    pub(crate) fn json_lines(&self) -> Vec<Value> {
        self.stdout().lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }
}

/// A case file with the given entries, as JSON text.
pub(crate) fn case_file(cases: &[String]) -> String {
    format!(
        r#"{{"format":1,"length_unit":"m","pose":"object to scene","cases":[{}]}}"#,
        cases.join(",")
    )
}

/// A case of the box over the floor.
pub(crate) fn case_at(id: &str, height: f64) -> String {
    format!(
        r#"{{"id":"{id}","scene":"floor.pcd","object":"box.obj","scene_sensor":"iso:0.002",
            "pose":[[1,0,0,0.01],[0,1,0,0.02],[0,0,1,{height}],[0,0,0,1]]}}"#
    )
}

pub(crate) fn floor() -> PointCloud {
    let points = (0..21 * 21)
        .map(|i| (i % 21, i / 21))
        .map(|(i, j)| Point3::new(0.05 * f64::from(i) - 0.5, 0.05 * f64::from(j) - 0.5, 0.0));
    PointCloud::from_points(points.collect())
}

/// A closed cube about the origin, `half` metres from its centre to its faces.
pub(crate) fn cube(half: f64) -> TriangleMesh {
    let side = |bit: usize| if bit == 0 { -half } else { half };
    let vertices =
        (0..8).map(|i| Point3::new(side(i & 1), side(i >> 1 & 1), side(i >> 2 & 1))).collect();
    let quads =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleMesh::new(vertices, triangles).unwrap()
}
