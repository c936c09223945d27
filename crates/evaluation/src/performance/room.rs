//! The piano in the room, prepared: every method asked about all poses in turn.

use anyhow::Result;
use cloudtouch::Detail;
use cloudtouch_geom::TriangleMesh;
use cloudtouch_testkit::poses_by_class::Class;

use super::scene::{POINTS, STD, Scene};
use super::timing::{p95, ratio, time, within};
use super::turns::{Timed, table, take_turns};
use crate::answers::Pair;
use crate::methods::{Balls, Distance, Draw, ExactMeshes, Method, Ours};
use crate::report::{Findings, Section, Target};
use crate::statistics::median;

/// The larger of the two noises, m.
const LARGE_STD: f64 = 0.01;

const INTRODUCTION: &str = "Room and piano, 10,000 points each, two clouds with default settings. A third of the \
poses is far (at least 10 cm apart), a third near (exact surfaces within 2 cm of one another, half free and half in \
overlap), a third deep (at least 5 cm of overlap). The methods take turns, each asked about one \
pose after another. The first answer is not timed: it fills what is computed once. Of seven others the least counts.

- `ours`: refined clouds (`Cloud::refined`), as for a scene that many poses are tested in; `verdict alone`: no more is \
asked (`Detail::Verdict`); `free or not`: even less (`Query::is_free`), yes or no as parry3d and capt say; `not \
refined`: as for a frame that is looked at a few times; `geometry alone`: no classifier is trained, so what that costs.
- `parry3d, exact meshes`: `intersection_test` on the surfaces that the clouds were drawn from, in about 10,000 \
triangles each. No sensor knows them: it is told more than the others.
- `distance`: the nearest point of the room for every point of the piano by kiddo, sought no farther than the \
smallest distance so far.
- `capt, 1 cm balls`: whether a point of the piano is within 1 cm of one of the room, by a collision-affording point \
tree without the instructions of nightly compilers; asked after all others, so as not to take their caches.

False stops and misses: free poses called collisions, and collisions called free; ours calls from ½ on, a distance \
has no threshold. AUC of a method that says only yes or no is what ties leave.";

const OF_MESHES: &str = "The same room and poses, the piano known as a mesh of about 10,000 triangles: closed, and \
open, with one triangle left out, so that it has no inside.";

/// Measures at both noises, and against meshes.
pub(super) fn measure(scene: &Scene) -> Findings {
    let mut section = Section::new("Prepared queries").text(INTRODUCTION);
    let mut targets = Vec::new();
    for std in [STD, LARGE_STD] {
        let timed = ask(scene, std)?;
        targets.extend(judged(&timed, std));
        section =
            section.text(format_args!("### Noise of {:.0} mm", 1e3 * std)).text(table(&timed));
    }
    let [_, closed] = scene.meshes(POINTS);
    let open = TriangleMesh::new(closed.vertices().to_vec(), closed.triangles()[1..].to_vec())?;
    section = section.text("### Against a mesh").text(OF_MESHES);
    for (name, mesh) in [("closed", &closed), ("open", &open)] {
        let (room, piano) = (scene.room(POINTS, STD), scene.piano(STD));
        let draw = Draw { family: "", a: &room, b: &piano, mesh };
        let ours = Ours::new(&format!("ours, {name} mesh"))?.refined();
        let timed = take_turns(&[&ours], &draw, Pair::CloudMesh, &scene.poses)?;
        let all = timed[0].seconds(None);
        let what = |which| format!("10k points × {name} mesh of 10k triangles: {which}");
        targets.push(within(&what("median"), median(&all), 3e-4));
        targets.push(within(&what("p95"), p95(&all), 3e-3));
        section = section.text(table(&timed));
    }
    Ok((section, targets))
}

fn ask(scene: &Scene, std: f64) -> Result<Vec<Timed>> {
    let (room, piano) = (scene.room(POINTS, std), scene.piano(std));
    let draw = Draw { family: "", a: &room, b: &piano, mesh: &scene.piano };
    let refined = Ours::new("ours")?.refined();
    let geometry = Ours::new("ours, geometry alone")?.refined().without_classifier();
    let mut verdict = Ours::new("ours, verdict alone")?.refined();
    verdict.query.detail = Detail::Verdict;
    let mut free = Ours::new("ours, free or not")?.refined();
    free.query.detail = Detail::Free;
    let methods: [&dyn Method; 7] = [
        &refined,
        &verdict,
        &free,
        &Ours::new("ours, not refined")?,
        &geometry,
        &ExactMeshes(scene.meshes(POINTS)),
        &Distance { smoothed: false },
    ];
    let mut timed = take_turns(&methods, &draw, Pair::CloudCloud, &scene.poses)?;
    timed.extend(take_turns(&[&Balls], &draw, Pair::CloudCloud, &scene.poses)?);
    Ok(timed)
}

/// Twice as long is given where the noise is larger.
fn judged(timed: &[Timed], std: f64) -> Vec<Target> {
    let times = if std == LARGE_STD { 2.0 } else { 1.0 };
    let at = format!("10k × 10k points, {:.0} mm of noise", 1e3 * std);
    let of = |class| timed[0].seconds(Some(class));
    let [far, near, deep] = [Class::Far, Class::Near, Class::Deep].map(|c| median(&of(c)));
    let [ours, meshes, distance, balls] = [0, 5, 6, 7].map(|i| median(&timed[i].seconds(None)));
    let compared = |with: f64| format!("{} ({} to {})", ratio(ours / with), time(ours), time(with));
    let by_meshes = format!("{at}: median ≤ {} × parry3d on exact meshes", 2.0 * times);
    let by = |peer| format!("{at}: median ≤ 0.2 × {peer}");
    let [refined, fresh] = [0, 3].map(|i| timed[i].prepare / (2 * POINTS) as f64);
    vec![
        within(&format!("{at}: far, median"), far, 15e-6 * times),
        within(&format!("{at}: near, median"), near, 500e-6 * times),
        within(&format!("{at}: near, p95"), p95(&of(Class::Near)), 2e-3 * times),
        within(&format!("{at}: deep, median"), deep, 200e-6 * times),
        Target::new(by_meshes, compared(meshes), ours / meshes <= 2.0 * times),
        Target::new(by("kiddo's smallest distance"), compared(distance), ours / distance <= 0.2),
        Target::new(by("capt"), compared(balls), ours / balls <= 0.2),
        within(&format!("{at}: a cloud prepared and refined"), POINTS as f64 * refined, 0.02),
        within(&format!("{at}: refining, a point"), refined - fresh, 3e-6),
    ]
}
