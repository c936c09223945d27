//! Pages and frames as a program makes them.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use std::sync::Arc;

use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings, Report, Scene};
use cloudtouch_page::{
    Body, Cast, Fact, MOST_LIKELY, MOST_VIEWS, Page, Shape, View, notebook_frame,
};

const SIDE: u32 = 30;

fn floor() -> Cloud {
    let at = |i: u32| Point3::new(0.05 * f64::from(i % SIDE), 0.05 * f64::from(i / SIDE), 0.0);
    let cloud = PointCloud::from_points((0..SIDE * SIDE).map(at).collect());
    Cloud::prepare(&cloud, &CloudSettings::new(SensorModel::Isotropic { std: 0.002 })).unwrap()
}

fn pose() -> Pose {
    Pose::from_translation(up(0.01))
}

fn up(height: f64) -> Vector3 {
    Vector3::new(0.0, 0.0, height)
}

fn report(cloud: &Cloud) -> Report {
    Query::new(QuerySettings::default()).unwrap().run(cloud, cloud, &pose()).unwrap()
}

fn page<'a>(cloud: &Cloud, reports: impl IntoIterator<Item = &'a Report>) -> Page<'a> {
    let shape = Shape::cloud(cloud.len(), |index| cloud.point(index));
    let body = Body { name: "<floor> & more".to_owned(), about: "a cloud".to_owned(), shape };
    let view = |report| {
        let more = vec![Fact::new("Said by", "the <program>")];
        View::of_pair("'here'", [0, 0], pose(), report).with_more(more)
    };
    let views = reports.into_iter().map(view).collect();
    Page { title: "A \"title\"".to_owned(), bodies: vec![body], views, ..Page::default() }
}

/// What the script of a page is given.
fn data(page: &Page<'_>) -> serde_json::Value {
    let html = page.html();
    let (_, data) = html.split_once("id=\"data\">").unwrap();
    serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap()
}

#[test]
fn a_frame_holds_the_page_and_nothing_of_it_leaves_the_attribute() {
    let cloud = floor();
    let report = report(&cloud);
    let page = page(&cloud, [&report]);
    let frame = notebook_frame(&page, 480);
    let (head, rest) = frame.split_once("srcdoc=\"").unwrap();
    assert!(head.contains("sandbox=\"allow-scripts\"") && head.contains("height:480px"));
    let (held, tail) = rest.split_once('"').unwrap();
    assert_eq!(tail, "></iframe>");
    // What a browser makes of the attribute.
    let names = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&#39;", "'"), ("&amp;", "&")];
    let read = names.iter().fold(held.to_owned(), |text, (name, c)| text.replace(name, c));
    assert!(read == page.html());
    assert!(read.contains("<dt>Said by</dt><dd>the &lt;program&gt;</dd>"));
}

#[test]
fn a_page_without_views_is_a_page() {
    let html = page(&floor(), []).html();
    assert!(html.contains("<title>A &quot;title&quot;</title>") && html.ends_with("</html>\n"));
}

#[test]
fn a_scene_has_a_view_of_all_and_one_of_each_pair_that_may_touch() {
    let floor = Arc::new(cloudtouch::Body::from(floor()));
    let mut scene = Scene::default();
    scene.add("floor", Arc::clone(&floor), Pose::identity()).unwrap();
    scene
        .add("sheet", Arc::clone(&floor), Pose::from_translation_rpy(up(0.0), [0.2, 0.0, 0.0]))
        .unwrap();
    scene.add("far", floor, Pose::from_translation(up(3.0))).unwrap();
    let checked = scene.check(&Query::new(QuerySettings::default()).unwrap());
    assert_eq!(checked.pairs.len(), 1);
    let cast = Cast::of(&scene, Some("far"), str::to_uppercase).unwrap();
    let page = Page::of_scene(cast, &scene, &checked).unwrap();
    let names: Vec<&str> = page.bodies.iter().map(|body| &*body.name).collect();
    assert_eq!((names[0], &*page.bodies[0].about), ("far", "FAR"));
    let [all, pair] = &page.views[..] else { panic!("{} views", page.views.len()) };
    assert!(all.asked.is_none() && all.around.len() == 3 && page.start == 1);
    let asked = pair.asked.as_ref().unwrap();
    assert_eq!(pair.around.iter().map(|of| names[of.body]).collect::<Vec<_>>(), ["far"]);
    for (standing, name) in
        [(asked.scene, &checked.pairs[0].a), (asked.object, &checked.pairs[0].b)]
    {
        assert_eq!((names[standing.body], standing.pose), (&**name, scene.pose(name).unwrap()));
    }
    let data = data(&page);
    assert_eq!(data["views"][0]["middle"], data["views"][1]["middle"]);
}

/// However many points every view colours, the page stays small, and says that it leaves some out.
#[test]
fn many_views_that_colour_many_points_stay_within_the_limit() {
    let cloud = floor();
    let mut report = report(&cloud);
    report.point_probabilities.a = (0..cloud.len()).map(|i| (i, 0.5)).collect();
    let html = page(&cloud, std::iter::repeat_n(&report, MOST_VIEWS)).html();
    let each = MOST_LIKELY / MOST_VIEWS / 2;
    assert!(each < cloud.len());
    let note = format!("no more than the {each} likeliest points of a cloud are coloured");
    assert_eq!(html.matches(&note).count(), 1);
    assert!(html.len() < 12_000_000, "{}", html.len());
}

/// All poses were shown as that of the first suited.
#[test]
fn each_pose_is_turned_as_its_own_scene_is_upright() {
    let cloud = floor();
    let report = report(&cloud);
    let room = page(&cloud, [&report, &report, &report]);
    // A wall as a camera sees it: about its axis, 2 m ahead.
    let middle = Vector3::new(0.7, 0.7, -2.0);
    let shape = Shape::cloud(cloud.len(), |index| cloud.point(index) - middle);
    let wall = Body { name: "wall".to_owned(), about: "a cloud".to_owned(), shape };
    let mut page = Page { bodies: vec![room.bodies[0].clone(), wall], ..room };
    page.views[1].asked.as_mut().unwrap().scene.body = 1;
    let data = data(&page);
    let upright = data["views"].as_array().unwrap().iter().map(|view| view["upright"].as_str());
    assert_eq!(upright.collect::<Vec<_>>(), [Some("z"), Some("camera"), Some("z")]);
}

/// From 100 m on, and below -10 m, a number of the matrix ran into the one before it.
#[test]
fn the_numbers_of_a_far_pose_ran_together() {
    let cloud = floor();
    let report = report(&cloud);
    let mut page = page(&cloud, [&report]);
    let far = Vector3::new(500_000.25, -10.5, 5_400_000.125);
    page.views[0].asked.as_mut().unwrap().object.pose = Pose::from_translation(far);
    let html = page.html();
    let (_, matrix) = html.split_once("Pose as a matrix").unwrap();
    let (_, matrix) = matrix.split_once("<pre>").unwrap();
    let (matrix, _) = matrix.split_once("</pre>").unwrap();
    let numbers: Result<Vec<f64>, _> = matrix.split_whitespace().map(str::parse).collect();
    let [x, y, z] = far.into();
    let expected = [1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, y, 0.0, 0.0, 1.0, z, 0.0, 0.0, 0.0, 1.0];
    assert_eq!(numbers, Ok(expected.to_vec()), "{matrix}");
}
