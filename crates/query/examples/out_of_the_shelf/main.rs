//! A gripper that scrapes along the board of a shelf, pulled out of it by the gradient of a collision's log
//! odds: twenty poses, all at once, with `argmin`.
//!
//! Run with `cargo run --release -p cloudtouch --example out_of_the_shelf [PICTURE.svg]`; the
//! picture is that of docs/motion.md.

mod picture;
mod round;
mod scene;

use anyhow::Result;
use cloudtouch::geom::Pose;
use cloudtouch::{Path, Query, QuerySettings, Report, Swept, Verdict};
use cloudtouch_testkit::exact::ExactMesh;

use scene::{Bodies, sagging};

const SEED: u64 = 7;
const MOST_ROUNDS: usize = 20;
/// Every pose is to have an upper bound below this: half of what reads as free.
const MOST: f64 = 0.05;
/// Stretches this short of the path are not divided further.
const TOLERANCE: f64 = 0.001;

/// A path, and what is told along it.
struct Told {
    poses: Vec<Along>,
    swept: Swept,
}

/// A pose, and what is told of it.
struct Along {
    pose: Pose,
    report: Report,
    /// What the clearance is above nineteen times of twenty, m.
    careful: f64,
    /// Whether the surfaces that were scanned do.
    touches: bool,
}

struct Pulled {
    before: Told,
    after: Told,
    rounds: usize,
}

fn main() -> Result<()> {
    let Pulled { before, after, rounds } = pull(MOST_ROUNDS)?;
    println!("pose  P before  P after  clearance before  after, mm");
    for (k, (was, is)) in before.poses.iter().zip(&after.poses).enumerate() {
        let p = [was, is].map(|told| told.report.collision_probability);
        let [was, is] = [was, is].map(|told| 1e3 * told.careful);
        println!("{k:4}  {:8.3}  {:7.3}  {was:16.1}  {is:9.1}", p[0], p[1]);
    }
    for (name, told) in [("before", &before), ("after", &after)] {
        let (verdict, [low, high]) = (told.swept.verdict, told.swept.bounds);
        let touching = told.poses.iter().filter(|told| told.touches).count();
        println!("{name}: {verdict}, P on the way {low:.3} to {high:.3}; {touching} poses touch");
    }
    println!("{rounds} rounds");
    if let Some(file) = std::env::args_os().nth(1) {
        std::fs::write(file, picture::svg([&before.poses, &after.poses])?)?;
    }
    Ok(())
}

/// Pulls the path out, in no more rounds than this.
fn pull(most_rounds: usize) -> Result<Pulled> {
    let bodies = Bodies::prepare(SEED)?;
    let query = Query::new(QuerySettings::default())?;
    let before = sagging();
    let mut after = before.clone();
    let mut rounds = 0;
    while rounds < most_rounds && !is_out(&query, &bodies, &after)? {
        round::round(&query, &bodies, &mut after)?;
        rounds += 1;
    }
    let told = |path: &[Pose]| tell(&query, &bodies, path);
    Ok(Pulled { before: told(&before)?, after: told(&after)?, rounds })
}

/// Whether no pose is likely to collide, nor what lies between them.
fn is_out(query: &Query, Bodies { scan, hand, .. }: &Bodies, path: &[Pose]) -> Result<bool> {
    for pose in path {
        if query.run(scan, hand, pose)?.bounds[1] > MOST {
            return Ok(false);
        }
    }
    let swept = query.sweep(scan, hand, &Path::through(path)?, TOLERANCE)?;
    Ok(swept.verdict == Verdict::Free)
}

fn tell(query: &Query, bodies: &Bodies, path: &[Pose]) -> Result<Told> {
    let Bodies { scan, hand, .. } = bodies;
    let (shelf, gripper) = (ExactMesh::new(&bodies.shelf), ExactMesh::new(&bodies.gripper));
    let ask = |&pose: &Pose| -> Result<Along> {
        let report = query.run(scan, hand, &pose)?;
        let [careful, _] = query.clearance_interval(scan, hand, &pose, 0.9)?;
        Ok(Along { pose, report, careful, touches: shelf.intersects(&gripper, &pose) })
    };
    let poses = path.iter().map(ask).collect::<Result<_>>()?;
    Ok(Told { poses, swept: query.sweep(scan, hand, &Path::through(path)?, TOLERANCE)? })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_that_scrapes_along_a_board_is_certified_after_it_is_pulled_out() {
        let Pulled { before, after, rounds } = pull(MOST_ROUNDS).unwrap();
        let count = |is: fn(&Along) -> bool| before.poses.iter().filter(|told| is(told)).count();
        assert!(count(|told| told.report.collision_probability > 0.9) >= 5);
        assert!(count(|told| told.touches) >= 5);
        assert_eq!(before.swept.verdict, Verdict::InCollision);
        assert!(rounds > 0);
        for (k, told) in after.poses.iter().enumerate() {
            assert!(told.report.bounds[1] <= MOST, "{k}: {:?}", told.report.bounds);
            assert_eq!(told.report.verdict, Verdict::Free, "{k}");
            assert!(told.careful > 0.0 && !told.touches, "{k}");
        }
        let swept = &after.swept;
        assert_eq!((swept.verdict, swept.certified_free_until), (Verdict::Free, 1.0));
        // The ends stay, and no pose jumps.
        let ends = |told: &Told| [told.poses[0].pose, told.poses[told.poses.len() - 1].pose];
        assert_eq!(ends(&before), ends(&after));
        for pair in after.poses.windows(2) {
            let step = pair[1].pose.translation() - pair[0].pose.translation();
            assert!(step.norm() < 0.05, "{step}");
        }
    }

    #[test]
    fn without_a_round_it_stays_in_collision() {
        let Pulled { before, after, .. } = pull(0).unwrap();
        assert!(before.poses.iter().zip(&after.poses).all(|(was, is)| was.pose == is.pose));
        assert_eq!(after.swept.verdict, Verdict::InCollision);
    }
}
