//! Pages and frames as a program makes them.
#![allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]

use cloudtouch::geom::{Point3, PointCloud, Pose, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Query, QuerySettings, Report};
use cloudtouch_page::{Body, Fact, MOST_LIKELY, MOST_VIEWS, Page, Shape, View, notebook_frame};

const SIDE: u32 = 30;

fn floor() -> Cloud {
    let at = |i: u32| Point3::new(0.05 * f64::from(i % SIDE), 0.05 * f64::from(i / SIDE), 0.0);
    let cloud = PointCloud::from_points((0..SIDE * SIDE).map(at).collect());
    Cloud::prepare(&cloud, &CloudSettings::new(SensorModel::Isotropic { std: 0.002 })).unwrap()
}

fn pose() -> Pose {
    Pose::from_translation(Vector3::new(0.0, 0.0, 0.01))
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
