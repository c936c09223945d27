//! Depth images: read as the organised cloud of the same points, or refused with what to do.
#![allow(clippy::unwrap_used, reason = "tests")]

use crate::support::{Inputs, case_file, cube};
use cloudtouch::geom::{Pose, Vector3};
use cloudtouch_io::{DepthCamera, depth, write_cloud_pcd, write_mesh_obj};
use serde_json::{Value, json};

const WIDTH: usize = 96;
const HEIGHT: usize = 72;
const CAMERA: DepthCamera = DepthCamera {
    fx: 90.0,
    fy: 90.0,
    cx: 47.5,
    cy: 35.5,
    depth_scale: 0.001,
    image_size: Some((WIDTH, HEIGHT)),
};
const NUMBERS: &str = "--intrinsics=90,90,47.5,35.5";

fn png(color: png::ColorType, bits: png::BitDepth, bytes: &[u8]) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, WIDTH as u32, HEIGHT as u32);
    encoder.set_color(color);
    encoder.set_depth(bits);
    encoder.write_header().unwrap().write_image_data(bytes).unwrap();
    file
}

/// A wall one metre before the camera, a carton of 20 cm before it, and here and there no return.
fn carton(scale: f64) -> Vec<u8> {
    let steps = |index: usize| {
        let (u, v) = ((index % WIDTH) as f64 - CAMERA.cx, (index / WIDTH) as f64 - CAMERA.cy);
        let is_carton = [u, v].iter().all(|p| (p / CAMERA.fx * 0.8).abs() < 0.1);
        let uneven = f64::from((index * 7919 % 5) as u32) * 0.0005;
        let depth = uneven + if is_carton { 0.8 } else { 1.0 };
        if index % 97 == 5 { 0 } else { (depth / scale).round() as u16 }
    };
    let bytes: Vec<u8> = (0..WIDTH * HEIGHT).flat_map(|i| steps(i).to_be_bytes()).collect();
    png(png::ColorType::Grayscale, png::BitDepth::Sixteen, &bytes)
}

/// `depth.png`, `depth.pcd` of the same points, `camera.json` and `cube.obj`, 4 cm wide.
fn inputs() -> Inputs {
    let inputs = Inputs::new();
    std::fs::write(inputs.path("depth.png"), carton(0.001)).unwrap();
    let cloud = depth::parse(&carton(0.001), &CAMERA).unwrap();
    write_cloud_pcd(inputs.path("depth.pcd"), &cloud).unwrap();
    write_mesh_obj(inputs.path("cube.obj"), &cube(0.02)).unwrap();
    let file =
        json!({"fx": 90, "fy": 90, "cx": 47.5, "cy": 35.5, "width": WIDTH, "height": HEIGHT});
    inputs.write("camera.json", &file.to_string());
    inputs
}

/// The answer without the files, and what it cost.
fn answer(inputs: &Inputs, scene: &[&str], more: &[&str]) -> Value {
    let run = inputs.run(&[&["query", "--json"], scene, &["cube.obj"], more].concat());
    let mut answer = run.quiet(0).json_lines().remove(0);
    for key in ["scene", "stats"] {
        answer.as_object_mut().unwrap().remove(key);
    }
    answer
}

#[test]
fn a_depth_image_is_answered_as_the_organised_cloud_of_its_points() {
    let inputs = inputs();
    for (place, verdict, by) in [
        ("0.2,0,0.7", "free", json!(null)),
        ("0,0,0.79", "in_collision", json!(null)),
        // Behind the carton, behind the camera, outside its view.
        ("0,0,0.9", "undecided", json!("unseen")),
        ("0,0,-0.5", "undecided", json!("unseen")),
        ("0.7,0,0.8", "undecided", json!("unseen")),
    ] {
        for sensor in ["kinect", "stereo:0.1,90,0.05", "lidar:0.003,0.003", "iso:0.002"] {
            let more = [&format!("--translate={place}"), "--sensor", sensor];
            let image = answer(&inputs, &["depth.png", "--intrinsics=camera.json"], &more);
            let cloud = answer(&inputs, &["depth.pcd", "--sensor-pose=0,0,0"], &more);
            assert_eq!(image, cloud, "{place} {sensor}");
            assert_eq!((&image["verdict"], &image["undecided_by"]), (&json!(verdict), &by));
        }
    }
    // Numbers, or steps of another size, say the same.
    let more = ["--translate=0.2,0,0.7", "--sensor=kinect"];
    let image = answer(&inputs, &["depth.png", "--intrinsics=camera.json"], &more);
    assert_eq!(answer(&inputs, &["depth.png", NUMBERS], &more), image);
    std::fs::write(inputs.path("tum.png"), carton(0.0002)).unwrap();
    let tum = answer(&inputs, &["tum.png", NUMBERS, "--depth-scale=0.0002"], &more);
    assert_eq!(tum["verdict"], image["verdict"]);
    let nearest = |answer: &Value| answer["placement"]["nearest_m"].as_f64().unwrap();
    assert!((nearest(&tum) - nearest(&image)).abs() < 2e-3, "{tum}");
}

/// Only a probability was warned of, which is small where nothing was seen.
#[test]
fn a_pose_that_is_free_and_may_be_in_what_was_not_seen_is_warned_of() {
    let inputs = inputs();
    let options =
        ["--sensor=iso:0.002", "--translate=0.15,0,0.89", "--pose-std=0.03,0,0,0,0,0", "--json"];
    let run = inputs.run(&[&["query", "depth.png", NUMBERS, "cube.obj"][..], &options].concat());
    let answer = run.json_lines().remove(0);
    let under = &answer["pose_uncertainty"];
    let [probability, most] = [&under["probability"], &under["bounds"][1]].map(Value::as_f64);
    assert!(answer["verdict"] == "free" && probability < Some(0.1) && most > Some(0.1), "{answer}");
    let told = format!("up to {:.3}", most.unwrap());
    let words = run.stderr();
    assert!(words.contains("--pose-std") && words.contains(&told), "{words}");
}

/// A depth image has no frame but its camera's: the place of that puts it into the frame of the poses.
#[test]
fn the_place_of_the_camera_places_a_depth_image() {
    let inputs = inputs();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let turn = [half, -half, 0.0, 0.0];
    let pose = Pose::try_from_quaternion(Vector3::new(0.1, 0.2, 1.5), turn).unwrap();
    let cloud = depth::parse(&carton(0.001), &CAMERA).unwrap().transformed(&pose);
    write_cloud_pcd(inputs.path("placed.pcd"), &cloud).unwrap();
    let placed = format!("--sensor-pose=0.1,0.2,1.5,{},0,0,{half}", -half);
    for place in [[0.2, 0.0, 0.7], [0.0, 0.0, 0.9]] {
        let at = pose.transform_point(&place.into());
        let at = format!("--translate={},{},{}", at.x, at.y, at.z);
        let more = [&at, &placed, "--sensor=kinect"];
        let image = answer(&inputs, &["depth.png", NUMBERS], &more);
        assert_eq!(image, answer(&inputs, &["placed.pcd"], &more));
        assert_eq!(image["verdict"], if place[2] > 0.8 { "undecided" } else { "free" }, "{image}");
    }
}

/// The range that is left out of what a camera saw is on no command line.
#[test]
fn a_range_within_what_a_camera_does_not_see_leaves_no_point() {
    let run = inputs().run(&[
        "query",
        "depth.png",
        "cube.obj",
        NUMBERS,
        "--sensor=kinect",
        "--max-range=0.05",
    ]);
    assert_eq!((run.code(), run.stdout().as_str()), (2, ""));
    for part in ["depth.png: --max-range 0.05", "0.1 m", "--min-range 0"] {
        assert!(run.stderr().contains(part), "{}", run.stderr());
    }
}

#[test]
fn every_command_reads_them() {
    let inputs = inputs();
    let run = |arguments: &[&str]| inputs.run(arguments).quiet(0).stdout();
    let info = run(&["info", "depth.png", NUMBERS]);
    for part in [
        "fx 90, fy 90, cx 47.5, cy 35.5 pixels, 0.001 m a step: sees 56.1 x 43.6 degrees",
        "(a 96 x 72 image)",
        "sensor      kinect",
    ] {
        assert!(info.contains(part), "{info}");
    }
    let query = run(&["query", "depth.png", "cube.obj", NUMBERS, "--sensor=auto"]);
    assert!(query.starts_with("scene: depth image of "), "{query}");
    assert!(query.contains("points in steps of 0.001 m, sensor kinect"), "{query}");

    inputs.write("poses.csv", "x,y,z,qw,qx,qy,qz\n0.2,0,0.6,1,0,0,0\n0.2,0,0.7,1,0,0,0\n");
    let path = ["path", "depth.png", "cube.obj", NUMBERS, "--sensor=kinect", "--poses=poses.csv"];
    assert!(run(&[&path[..], &["--json"]].concat()).contains(r#""verdict":"free""#));
    let pose = "[[1,0,0,0],[0,1,0,0],[0,0,1,0.9],[0,0,0,1]]";
    let case = format!(r#"{{"scene":"depth.png","object":"cube.obj","pose":{pose}}}"#);
    inputs.write("cases.json", &case_file(&[case]));
    let batch = ["batch", "cases.json", NUMBERS, "--sensor=kinect", "--json", "--html=a.html"];
    assert!(run(&batch).contains(r#""undecided_by":"unseen""#));
    // An object may be one too, such as what a second camera sees.
    let object = ["query", "floor.pcd", "depth.png", NUMBERS, "--translate=0,0,3", "--json"];
    let object = inputs.run(&object).quiet(0).json_lines().remove(0);
    assert_eq!(object["object"]["unit"], "0.001 m");
}

#[test]
fn bodies_of_a_scene_have_their_own_cameras() {
    let inputs = inputs();
    let run = |image: Value, more: &[&str]| {
        let pose = json!([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0.79], [0, 0, 0, 1]]);
        let bodies = json!({"format": 1, "length_unit": "m", "bodies": [
            image, {"name": "cube", "file": "cube.obj", "pose": pose},
        ]});
        inputs.write("scene.json", &bodies.to_string());
        inputs.run(&[&["scene", "scene.json", "--sensor=kinect"], more].concat())
    };
    let image = |fields: Value| {
        let mut image = json!({"name": "carton", "file": "depth.png"});
        image.as_object_mut().unwrap().extend(fields.as_object().unwrap().clone());
        image
    };
    let expected = run(image(json!({"intrinsics": "camera.json"})), &[]).quiet(0).stdout();
    assert!(expected.contains("in collision: 1 of 1 pairs"), "{expected}");
    let numbers = [90.0, 90.0, 47.5, 35.5];
    for (fields, more) in [
        (json!({"intrinsics": numbers, "depth_scale": 0.001}), &[][..]),
        (json!({"depth_scale": 0.001}), &["--intrinsics=camera.json"]),
        // What a body says itself wins.
        (json!({"intrinsics": numbers}), &["--intrinsics=50,50,47.5,35.5"]),
        (json!({"depth_scale": 0.001}), &[NUMBERS, "--depth-scale=0.01"]),
    ] {
        assert_eq!(run(image(fields), more).quiet(0).stdout(), expected);
    }
    let other = |file: &str| json!({"name": "x", "file": file, "depth_scale": 0.001});
    for (body, parts) in [
        (image(json!({})), ["`carton`", "--intrinsics FX,FY,CX,CY"]),
        (image(json!({"intrinsics": [90, 90, 47.5]})), ["`intrinsics` is [90,90,47.5]", "cy"]),
        (image(json!({"intrinsics": [0, 90, 47.5, 35.5]})), ["fx is 0", "above 0"]),
        (image(json!({"intrinsics": "gone.json"})), ["gone.json", "cannot be read"]),
        (image(json!({"intrinsics": numbers, "depth_scale": 1000})), ["is 1000 m", "0.001"]),
        (image(json!({"intrinsics": numbers, "unit": "mm"})), ["`unit`", "`depth_scale`"]),
        (other("cube.obj"), ["`depth_scale` are of a depth image", "leave them out"]),
        (other("floor.pcd"), ["`depth_scale` are of a depth image", "leave them out"]),
    ] {
        let error = run(body, &[]).stderr();
        assert!(parts.iter().all(|part| error.contains(part)), "{error}");
    }
}

#[test]
fn slips_are_told_with_what_to_do() {
    let inputs = inputs();
    let grey = png::ColorType::Grayscale;
    let eight = png(grey, png::BitDepth::Eight, &[9; WIDTH * HEIGHT]);
    std::fs::write(inputs.path("eight.png"), eight).unwrap();
    let zero = png(grey, png::BitDepth::Sixteen, &[0; 2 * WIDTH * HEIGHT]);
    std::fs::write(inputs.path("zero.png"), zero).unwrap();
    let color = png(png::ColorType::Rgb, png::BitDepth::Eight, &[9; 3 * WIDTH * HEIGHT]);
    std::fs::write(inputs.path("color.png"), color).unwrap();
    let whole = carton(0.001);
    std::fs::write(inputs.path("cut.png"), &whole[..whole.len() / 2]).unwrap();
    inputs.write("lens.json", r#"{"K":[90,0,47.5,0,90,35.5,0,0,1],"D":[0.1,0,0,0,0]}"#);
    inputs.write("scaled.json", r#"{"fx":90,"fy":90,"cx":47.5,"cy":35.5,"depth_scale":0.1}"#);
    inputs.write("camera.yaml", "k: [90, 0, 47.5, 0, 90, 35.5, 0, 0, 1]\n");
    for (code, arguments, parts) in [
        (
            1,
            "depth.png",
            &["depth.png", "intrinsics of its camera", "--intrinsics FX,FY,CX,CY"][..],
        ),
        (1, "eight.png --intrinsics camera.json", &["eight.png: byte 24", "8-bit grey", "16-bit"]),
        (1, "color.png --intrinsics camera.json", &["color.png", "8-bit colour", "depth image"]),
        (1, "zero.png --intrinsics camera.json", &["zero.png", "none of 6912 pixels", "camera"]),
        (1, "cut.png --intrinsics camera.json", &["cut.png: byte ", "the file ends", "cut off"]),
        (1, "depth.png --intrinsics gone.json", &["gone.json: cannot be read"]),
        (1, "depth.png --intrinsics lens.json", &["lens.json", "`D` has 0.1", "rectify"]),
        (1, "depth.png --intrinsics scaled.json", &["`depth_scale` is 0.1", "--depth-scale"]),
        (1, "depth.png --intrinsics camera.yaml", &["camera.yaml", "of a YAML file"]),
        (1, "depth.png --intrinsics 960,960,960,540", &["cx is 960", "96 columns", "colour"]),
        (1, "depth.png --intrinsics 0.9,0.9,0.5,0.5", &["fx is 0.9", "in pixels"]),
        (
            1,
            "depth.png --intrinsics camera.json --max-points 6911",
            &["6912 points", "--max-points"],
        ),
        (2, "depth.png --intrinsics 90,90,47.5", &["3 numbers", "fx,fy,cx,cy"]),
        (2, "depth.png --intrinsics 90 90 47.5 35.5", &["with commas, as in 90,90,47.5,35.5"]),
        (2, "depth.png --intrinsics nan,90,47.5,35.5", &["`nan` is not finite"]),
        (2, "depth.png --intrinsics 90,0,47.5,35.5", &["fy is 0", "above 0"]),
        (2, "depth.png --intrinsics camera.json --depth-scale 1000", &["is 1000 m", "0.001"]),
        (2, "depth.png --intrinsics camera.json --depth-scale 0", &["is 0 m", "above 0"]),
        (2, "depth.png --intrinsics camera.json --cloud-unit mm", &["--depth-scale, metres"]),
        (2, "floor.pcd --intrinsics camera.json", &["--intrinsics is for depth", "leave it out"]),
        (2, "floor.pcd --depth-scale 0.001", &["--depth-scale is for depth", "leave it out"]),
    ] {
        let words: Vec<&str> = arguments.split(' ').collect();
        for command in [&["query", "cube.obj"][..], &["info"]] {
            let (command, object) = command.split_first().unwrap();
            // The scene comes before the object, and options after both.
            let line = [&[*command, words[0]], object, &words[1..]].concat();
            let run = inputs.run(&line);
            let error = run.stderr();
            assert_eq!((run.code(), run.stdout().as_str()), (code, ""), "{line:?}: {error}");
            assert!(parts.iter().all(|part| error.contains(part)), "{line:?}: {error}");
        }
    }
    // The scale that is not clear is none once it is said.
    let said = ["info", "depth.png", "--intrinsics=scaled.json", "--depth-scale=0.001"];
    assert_eq!(
        inputs.run(&said).quiet(0).stdout(),
        inputs.run(&["info", "depth.png", NUMBERS]).stdout()
    );
    // What may be meant is warned of: another order, or those of another size.
    for numbers in ["90,47.5,90,35.5", "120,120,80,60"] {
        let run = inputs.run(&["info", "depth.png", "--intrinsics", numbers]);
        assert!(run.code() == 0 && run.stderr().contains("in this order"), "{}", run.stderr());
    }
    // Steps that make all too large, and images that need not be in one frame.
    let large = inputs.run(&["info", "depth.png", NUMBERS, "--depth-scale=0.1"]).quiet(0).stdout();
    assert!(large.contains("from point to point: --depth-scale?"), "{large}");
    let several =
        ["query", "depth.png", "cube.obj", "--also=depth.pcd", NUMBERS, "--sensor=kinect"];
    let error = inputs.run(&several).stderr();
    assert!(error.contains("of a camera that stood still"), "{error}");
    // In a case file they would change nothing.
    let case = r#"{"scene":"depth.png","object":"cube.obj","pose":[],"intrinsics":[1,1,1,1]}"#;
    inputs.write("cases.json", &case_file(&[case.to_owned()]));
    let error = inputs.run(&["batch", "cases.json"]);
    assert!(error.stdout().contains("there is no field `intrinsics`: give it as an option"));
}
