//! Recordings on the command line: what a build with the feature `mcap` reads, and one without says.
#![allow(clippy::unwrap_used, reason = "tests")]

/// Compiled with the feature too, as CI builds: without, it once did not compile.
#[test]
#[cfg_attr(feature = "mcap", ignore = "of a build without the feature")]
fn a_build_without_the_feature_says_how_to_build_with_it() {
    let inputs = crate::support::Inputs::new();
    inputs.write("run.mcap", "never looked at");
    for arguments in [
        &["info", "run.mcap"][..],
        &["info", "run.mcap#/points@1"],
        &["query", "run.mcap#/points", "box.obj"],
        &["query", "floor.pcd", "run.mcap"],
    ] {
        let run = inputs.run(arguments);
        assert_eq!(run.code(), 1);
        assert!(run.stderr().contains("run.mcap: is a recording"), "{}", run.stderr());
        assert!(run.stderr().contains("--features mcap"), "{}", run.stderr());
    }
}

#[cfg(feature = "mcap")]
mod with_feature {
    use std::collections::BTreeMap;
    use std::fs::File;

    use mcap::Writer;
    use mcap::records::MessageHeader;

    use crate::support::{self, Inputs, case_file, floor};

    /// The floor as a message of ROS 1, at a height in a frame.
    fn message(height: f32, frame: &str) -> Vec<u8> {
        let points = floor().points;
        let mut bytes = Vec::new();
        // Sequence, stamp, frame.
        let length = frame.len() as u32;
        bytes.extend([0, 5, 0, length].iter().flat_map(|v| v.to_le_bytes()));
        bytes.extend(frame.bytes());
        // Height, width, fields.
        bytes.extend([1, points.len() as u32, 3].iter().flat_map(|v| v.to_le_bytes()));
        for (offset, name) in [(0_u32, b'x'), (4, b'y'), (8, b'z')] {
            bytes.extend(1_u32.to_le_bytes());
            bytes.push(name);
            bytes.extend(offset.to_le_bytes());
            bytes.push(7);
            bytes.extend(1_u32.to_le_bytes());
        }
        bytes.push(0);
        for value in [12, 12 * points.len() as u32, 12 * points.len() as u32] {
            bytes.extend(value.to_le_bytes());
        }
        for point in points {
            for value in [point.x as f32, point.y as f32, point.z as f32 + height] {
                bytes.extend(value.to_le_bytes());
            }
        }
        bytes.push(1);
        bytes
    }

    /// `run.mcap` with the floor of [`floor`] after 2 s and half a metre lower at its beginning, and
    /// another topic.
    fn inputs() -> Inputs {
        let inputs = Inputs::new();
        let floors = [("/floor", 0, -0.5), ("/floor", 2, 0.0), ("/b", 1, 0.0)];
        record(&inputs, "run.mcap", &floors.map(|(topic, time, z)| (topic, time, z, "base")));
        inputs
    }

    /// A recording of floors: topic, seconds, height and frame.
    fn record(inputs: &Inputs, file: &str, floors: &[(&str, u64, f32, &str)]) {
        let mut writer = Writer::new(File::create(inputs.path(file)).unwrap()).unwrap();
        let schema = writer.add_schema("sensor_msgs/PointCloud2", "ros1msg", b"").unwrap();
        for &(topic, seconds, height, frame) in floors {
            let channel_id = writer.add_channel(schema, topic, "ros1", &BTreeMap::new()).unwrap();
            let time = 1_700_000_000_000_000_000 + seconds * 1_000_000_000;
            let header =
                MessageHeader { channel_id, sequence: 0, log_time: time, publish_time: time };
            writer.write_to_known_channel(&header, &message(height, frame)).unwrap();
        }
        writer.finish().unwrap();
    }

    const POSE: &str = "--translate=0.01,0.02,0.1";

    #[test]
    fn info_lists_the_topics_or_describes_a_scan() {
        let inputs = inputs();
        let text = inputs.run(&["info", "run.mcap"]).quiet(0).stdout();
        for expected in [
            "/b      1 scans, 1.000 to 1.000 s, frame base\n",
            "/floor  2 scans, 0.000 to 2.000 s, frame base\n",
            "run.mcap#/b@1.000 is the first scan",
        ] {
            assert!(text.contains(expected), "`{expected}` is not in\n{text}");
        }
        let text = inputs.run(&["info", "run.mcap#/floor@1"]).quiet(0).stdout();
        for expected in ["/floor at 2 s, frame base, stamp 5.000 s\n", "rows        441"] {
            assert!(text.contains(expected), "`{expected}` is not in\n{text}");
        }
        let text = inputs.run(&["info", "run.mcap#/floor@1", "--cloud-unit=mm"]).quiet(0).stdout();
        assert!(text.contains("box         (-0.001, -0.001, 0.000)"), "{text}");
        for (scan, unit) in [("run.mcap", "--cloud-unit=mm"), ("run.mcap#/floor", "--unit=mm")] {
            assert_eq!(inputs.run(&["info", scan, unit]).code(), 2);
        }
    }

    #[test]
    fn a_scan_answers_as_the_same_cloud_in_a_file_does() {
        let inputs = inputs();
        let answer = |scene: &str| {
            let arguments = ["query", scene, "box.obj", "--sensor=iso:0.002", POSE, "--json"];
            let mut answer = inputs.run(&arguments).quiet(0).json_lines().remove(0);
            assert_eq!(answer["scene"]["file"], scene);
            for key in ["scene", "stats"] {
                answer.as_object_mut().unwrap().remove(key);
            }
            answer
        };
        // Single precision like the message.
        let single = cloudtouch::geom::PointCloud::from_points(
            floor().points.iter().map(|p| p.map(|v| f64::from(v as f32))).collect(),
        );
        cloudtouch_io::write_cloud_pcd(inputs.path("single.pcd"), &single).unwrap();
        assert_eq!(answer("run.mcap#/floor@1"), answer("single.pcd"));
        assert_eq!(answer("run.mcap#/b"), answer("single.pcd"));
        assert_ne!(answer("run.mcap#/floor"), answer("single.pcd"));
    }

    /// They were laid on top of each other: the frame of a message was not looked at.
    #[test]
    fn scans_in_different_frames_are_no_one_scene() {
        let inputs = inputs();
        record(&inputs, "two.mcap", &[("/a", 0, 0.0, "left"), ("/b", 1, 0.0, "/tip")]);
        let run = |also: &str| {
            let arguments = ["query", "two.mcap#/a", "box.obj", POSE, "--also", also];
            inputs.run(&arguments)
        };
        let other = run("two.mcap#/b");
        assert_eq!(other.code(), 1);
        for part in ["two.mcap#/a: is in the frame left", "two.mcap#/b in the frame tip", "scene"] {
            assert!(other.stderr().contains(part), "{}", other.stderr());
        }
        assert_eq!(run("run.mcap#/floor").code(), 1);
        assert_eq!(run("floor.pcd").code(), 0, "a file does not tell its frame");
        record(&inputs, "same.mcap", &[("/d", 0, -0.5, "left")]);
        run("same.mcap").quiet(0);
    }

    /// Of a robot that drove on they were laid on top of each other, and nothing told of it.
    #[test]
    fn scans_that_were_not_taken_at_once_give_a_warning() {
        let inputs = inputs();
        let floors = [("/a", 0, 0.0, "left"), ("/a", 2, 0.0, "left"), ("/b", 0, -0.5, "left")];
        record(&inputs, "left.mcap", &floors);
        record(&inputs, "map.mcap", &floors.map(|(topic, time, z, _)| (topic, time, z, "/map")));
        let run = |recording: &str, also: &str| {
            let [scene, also] = ["#/a@0", also].map(|scan| format!("{recording}{scan}"));
            inputs.run(&["query", &scene, "box.obj", POSE, "--also", &also])
        };
        let told = run("left.mcap", "#/b@0").stderr() + &run("map.mcap", "#/a@1").stderr();
        assert!(!told.contains("before or after"), "{told}");
        let told = run("left.mcap", "#/a@1").stderr();
        for part in ["left.mcap#/a@0: the other", "2.00 s before", "stood still", "its pose"] {
            assert!(told.contains(part), "{told}");
        }
    }

    /// Its noise went by the distance from the origin of a map, and nothing told of it.
    #[test]
    fn a_scan_in_a_frame_that_is_no_sensors_gives_a_warning() {
        let inputs = inputs();
        record(&inputs, "map.mcap", &[("/a", 0, 0.0, "/map"), ("/b", 1, 0.0, "r/odom")]);
        let run = |scene: &str, more: &[&str]| {
            let arguments = ["query", scene, "box.obj", "--translate=0,0,0.5"];
            inputs.run(&[&arguments, more].concat()).stderr()
        };
        const LASER: &str = "--sensor=lidar:0.02,0.003";
        for (scene, frame) in [("map.mcap#/a", "frame map,"), ("map.mcap#/b", "frame r/odom,")] {
            let told = run(scene, &[LASER]);
            assert!(told.contains(frame) && told.contains("give --sensor-pose"), "{told}");
        }
        for (scene, more) in [
            ("map.mcap#/a", &[LASER, "--sensor-pose=0,0,1"][..]),
            ("map.mcap#/a", &["--sensor=iso:0.002"]),
            ("run.mcap#/b", &[LASER]),
        ] {
            let told = run(scene, more);
            assert!(!told.contains("is in the frame"), "{told}");
        }
    }

    #[test]
    fn batches_and_paths_take_scans_too() {
        let inputs = inputs();
        let case = |scene: &str| support::case_at(scene, 0.1005).replace("floor.pcd", scene);
        inputs.write(
            "cases.json",
            &case_file(
                &["#/floor@1", "#/floor@0", "#/none"].map(|scan| case(&format!("run.mcap{scan}"))),
            ),
        );
        // Scans of two topics of one recording, told apart.
        let table = inputs.run(&["batch", "cases.json"]).stdout();
        for file in ["run.mcap#/floor@1 / box.obj", "run.mcap#/floor@0 / box.obj"] {
            assert!(table.contains(file), "{table}");
        }
        let lines = inputs.run(&["batch", "cases.json", "--json"]).json_lines();
        assert_eq!(lines[0]["verdict"], "uncertain");
        assert_eq!(lines[1]["verdict"], "free");
        let error = lines[2]["error"].as_str().unwrap();
        assert!(error.contains("there is no topic /none: PointCloud2 is on /b, /floor"), "{error}");
        inputs.write("path.csv", "x,y,z,qw,qx,qy,qz\n0,0,0.5,1,0,0,0\n0,0,0.4,1,0,0,0\n");
        let arguments = ["path", "run.mcap#/floor@1", "box.obj", "--poses=path.csv", "--json"];
        assert_eq!(inputs.run(&arguments).quiet(0).json_lines()[0]["verdict"], "free");
    }

    #[test]
    fn the_recording_of_a_scan_is_an_input_that_is_never_replaced() {
        let inputs = inputs();
        let before = std::fs::read(inputs.path("run.mcap")).unwrap();
        std::os::unix::fs::symlink(inputs.path("run.mcap"), inputs.path("out.csv")).unwrap();
        for output in ["--csv=run.mcap", "--csv=out.csv", "--ply=./run.mcap"] {
            let run = inputs.run(&["query", "run.mcap#/b", "box.obj", POSE, output, "--force"]);
            assert_eq!(run.code(), 1);
            assert!(run.stderr().contains("is an input of this very command"), "{}", run.stderr());
        }
        let case = support::case_at("a", 0.1).replace("floor.pcd", "run.mcap#/b");
        inputs.write("cases.json", &case_file(&[case]));
        let run = inputs.run(&["batch", "cases.json", "--jsonl=run.mcap", "--force"]);
        assert!(run.stderr().contains("is an input of this very command"), "{}", run.stderr());
        assert_eq!(std::fs::read(inputs.path("run.mcap")).unwrap(), before);
    }

    #[test]
    fn a_scan_that_is_not_there_is_an_error_with_its_file() {
        let inputs = inputs();
        for (scene, expected) in [
            ("run.mcap", "several topics hold PointCloud2: name one of /b, /floor"),
            ("run.mcap#/floor@9", "no message at or after 9 s"),
            ("run.mcap#/floor@x", "\"x\" is no time"),
            ("gone.mcap#/floor", "cannot be read"),
        ] {
            let run = inputs.run(&["query", scene, "box.obj", POSE]);
            assert_eq!(run.code(), 1);
            let file = scene.split('#').next().unwrap();
            assert!(run.stderr().contains(expected), "{}", run.stderr());
            assert!(run.stderr().starts_with(&format!("error: {file}")), "{}", run.stderr());
        }
    }
}
