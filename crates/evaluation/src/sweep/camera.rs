//! What cloudtouch is for: a depth camera, a gripper, and how many free poses are stopped.

use anyhow::Result;
use cloudtouch::{Detail, QuerySettings};
use cloudtouch_testkit::family::Family;

use super::OURS;
use super::ask::{Asked, ask};
use super::judged::Judged;
use super::plan::Plan;
use crate::answers::{Answers, Condition, Pair, Question};
use crate::measures::Measure::{FalseStops, Misses, Stops};
use crate::methods::{Boxes, Distance, Ours};
use crate::report::{Section, Table};

/// Views for each draw of the sweep: a hundredth of the collisions is to be more than one or two.
const VIEWS: u32 = 5;
/// Standard deviations of the depth at 1 m, m.
const STDS: [f64; 4] = [0.001, 0.002, 0.005, 0.01];

/// The answers about a table before a depth camera.
pub(super) fn answers(draws: u32, poses: usize) -> Result<Answers> {
    let conditions = STDS.map(|std| Condition { points: 10_000, std }).to_vec();
    let families = vec![Family::Tabletop.into()];
    let pairs = vec![Pair::CloudMesh];
    let plan = Plan { families, pairs, conditions, stream: 3, ..Plan::full(VIEWS * draws, poses) };
    let [smoothed, distance] = [true, false].map(|smoothed| Asked::always(Distance { smoothed }));
    let (ours, mut free) = (Asked::always(Ours::new(OURS)?), Ours::new("free or not")?);
    free.query.detail = Detail::Free;
    ask(&plan, &[ours, Asked::always(free), smoothed, distance, Asked::always(Boxes)])
}

/// What is stopped, by how noisy the camera is.
pub(super) fn section(answers: &Answers) -> Section {
    let [ours, free, smoothed, distance, boxes] =
        std::array::from_fn(|k| answers.methods[k].as_str());
    let reject = QuerySettings::default().reject;
    let from = format!("stopped from P = {} on", reject.to_string().trim_start_matches('0'));
    let columns = [
        (ours, Stops(reject), from.as_str()),
        (ours, Misses(reject), "missed"),
        (boxes, Stops(0.5), "stopped by 1 cm boxes"),
        (boxes, Misses(0.5), "missed"),
        (ours, FalseStops(0.01), "stopped at 1 % misses"),
        (smoothed, FalseStops(0.01), "by smoothed distance"),
        (distance, FalseStops(0.01), "by distance"),
        (free, Stops(0.5), "not seen to be free"),
        (free, Misses(0.5), "missed"),
    ];
    let mut table = Table::new(["noise at 1 m"].into_iter().chain(columns.map(|(.., head)| head)));
    for std in STDS {
        let keep = |q: &Question| q.condition.std == std;
        let of = |(method, measure, _)| {
            Judged::pick(answers, &[method], keep).estimate(method, measure).to_string()
        };
        table.row([format!("{} mm", 1e3 * std)].into_iter().chain(columns.map(of)));
    }
    let count = answers.rows.len() / STDS.len();
    let text = format!(
        "Household objects on a table, 80 cm to 1.5 m before a depth camera with 10,000 returns, and a gripper whose \
         mesh is known, in {count} poses; half of them collide, half are within 3 cm of contact. The noise of a depth \
         grows with its square, and at edges some pixels float between both depths. *Stopped*: the share of free poses; \
         *missed*: of collisions; by the default threshold on P, by a map of boxes about the points, and by thresholds \
         that miss a hundredth of the collisions each, on P and on the distance of the points from the gripper, as \
         measured and after our own surface fit. *Not seen to be free*: by `Query::is_free`, which also stops what \
         reaches into space that the camera did not see, as these grippers often do. In brackets 95 % intervals."
    );
    Section::new("A depth camera and a gripper").text(text).text(table)
}
