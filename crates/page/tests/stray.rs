//! A page of a map with a point at the origin: the others keep their millimetres.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use base64::Engine as _;
use cloudtouch::geom::{Point3, Pose};
use cloudtouch_page::{Body, Page, Shape, Standing, View};

/// About the middle of the box, 2,700 km away, single precision rounds to a quarter of a metre.
#[test]
fn a_stray_point_rounded_all_others() {
    let at =
        |i: u32| Point3::new(5e5 + 0.0371 * f64::from(i), 5.4e6 + 0.0173 * f64::from(i), 300.0);
    let points: Vec<Point3> = (0..999).map(at).chain([Point3::origin()]).collect();
    let shape = Shape::Cloud { points: points.clone(), brightness: None };
    let body = Body { name: "map".to_owned(), about: String::new(), shape };
    let view = View::of_all("all", vec![Standing { body: 0, pose: Pose::identity() }]);
    let html = Page { bodies: vec![body], views: vec![view], ..Page::default() }.html();
    let (_, data) = html.split_once("id=\"data\">").unwrap();
    let data: serde_json::Value =
        serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap();
    let drawn = &data["bodies"][0];
    let middle: [f64; 3] = serde_json::from_value(drawn["middle"].clone()).unwrap();
    let bytes =
        base64::engine::general_purpose::STANDARD.decode(drawn["positions"].as_str().unwrap());
    let bytes = bytes.unwrap();
    let floats =
        bytes.chunks_exact(4).map(|b| f64::from(f32::from_le_bytes(b.try_into().unwrap())));
    let floats: Vec<f64> = floats.collect();
    for (p, wanted) in floats.chunks_exact(3).zip(&points).take(999) {
        let p = Point3::new(p[0], p[1], p[2]) + Point3::from(middle).coords;
        assert!((p - wanted).norm() < 1e-5, "{p} for {wanted}");
    }
}
