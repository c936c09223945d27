//! What holds the object in a collision, from one place that is tried to the next.
//!
//! Of hundreds of places most are not free, and where a body holds much of a cloud all of that has to be looked
//! through to find what is deepest. A few points that were deep inside at one place mostly are at the next one too,
//! and that they are is enough: further evidence only raises the odds.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::time::Instant;

use cloudtouch_bvh::NodeId;
use cloudtouch_geom::Pose;

use crate::body::BodyRef;
use crate::error::QueryError;
use crate::query::run::Query;
use crate::query::steering::is_enough;
use crate::query::weigh::weigh;
use crate::report::Report;
use crate::search::is_enough_of_leaf;

/// So many leaves are remembered: in another direction another one holds the object.
const REMEMBERED: usize = 8;

/// The leaves of a cloud that held a point deep inside a mesh, the latest first.
#[derive(Debug, Default)]
pub(super) struct HeldBy(RefCell<VecDeque<NodeId>>);

impl HeldBy {
    /// Whether one of the leaves tells that a query, which decides at one probability, would not read as free.
    pub(super) fn is_still(
        &self,
        query: &Query,
        bodies: (BodyRef<'_>, BodyRef<'_>),
        a_from_b: &Pose,
    ) -> bool {
        // Such a query stops, and may read as free, where it is not known yet that it is not.
        if query.settings().stop_above < query.settings().reject {
            return false;
        }
        let task = query.task(Instant::now(), bodies);
        let local = bodies.0.shape().local_from(&bodies.1.shape(), a_from_b);
        let holds = |leaf: &NodeId| {
            is_enough_of_leaf(*leaf, bodies, &local, |deviations| is_enough(deviations, 0.0, &task))
        };
        let mut leaves = self.0.borrow_mut();
        let holding = leaves.iter().position(holds);
        if let Some(leaf) = holding.and_then(|at| leaves.remove(at)) {
            leaves.push_front(leaf);
        }
        holding.is_some()
    }

    /// [`Query::run`] where no more than the verdict is asked for, which remembers what is deepest.
    pub(super) fn run(
        &self,
        query: &Query,
        (a, b): (BodyRef<'_>, BodyRef<'_>),
        a_from_b: &Pose,
    ) -> Result<Report, QueryError> {
        if let (BodyRef::Mesh(_), BodyRef::Mesh(_)) = (a, b) {
            return query.run(a, b, a_from_b);
        }
        query.terms().ask((a.shape(), b.shape()), a_from_b, |start, local, evidence| {
            let task = query.task(start, (a, b));
            let weighed = weigh((a, b), local, &task, &mut evidence.stats)?;
            if let Some(leaf) = weighed.looked.leaf {
                let mut leaves = self.0.borrow_mut();
                leaves.retain(|known| *known != leaf);
                leaves.push_front(leaf);
                leaves.truncate(REMEMBERED);
            }
            Ok(weighed.estimate(None, &task, evidence))
        })
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{PointCloud, TriangleMesh, Vector3};
    use cloudtouch_noise::SensorModel;
    use cloudtouch_testkit::measured::measured;
    use cloudtouch_testkit::scene;
    use proptest::prelude::*;

    use super::*;
    use crate::body::Body;
    use crate::mesh::Mesh;
    use crate::query::QuerySettings;
    use crate::{Cloud, CloudSettings};

    /// One that is open has no inside.
    fn shape(which: usize) -> TriangleMesh {
        match which {
            0 => scene::cuboid([0.3, 0.2, 0.1]),
            1 => scene::sphere(0.12, 3),
            2 => scene::torus(0.12, 0.04, 24),
            _ => scene::rectangle(0.3, 0.2),
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

        #[test]
        fn what_held_before_tells_no_other_than_a_query(
            shapes in [0..3_usize, 0..4_usize],
            mesh_is_a in any::<bool>(),
            is_refined in any::<bool>(),
            std in prop_oneof![Just(0.0), 0.0002_f64..0.01],
            probability in 0.02..0.9_f64,
            stop_above in prop_oneof![3 => Just(0.999), 1 => 0.01..0.9_f64],
            angles in prop::array::uniform3(-3.0..3.0_f64),
            offsets in prop::collection::vec(prop::array::uniform3(-0.15..0.15_f64), 40),
            seed in any::<u64>(),
        ) {
            let points = measured(&shape(shapes[0]), 0.012, std, seed);
            let settings = CloudSettings::new(SensorModel::Isotropic { std });
            let cloud = Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap();
            let cloud = Body::Cloud(if is_refined { cloud.refined().unwrap() } else { cloud });
            let mesh = Body::from(Mesh::prepare(&shape(shapes[1])).unwrap());
            let bodies = match mesh_is_a {
                true => ((&mesh).into(), (&cloud).into()),
                false => ((&cloud).into(), (&mesh).into()),
            };
            let settings = QuerySettings { stop_above, ..QuerySettings::default() };
            let query = Query::new(settings).unwrap().deciding(probability);
            let held_by = HeldBy::default();
            // Places near one another, as where a way is halved.
            for offset in offsets.iter().flat_map(|o| [1.0, 0.5, 0.75].map(|k| Vector3::from(*o) * k)) {
                let pose = Pose::from_translation_rpy(offset, angles);
                let report = query.run(bodies.0, bodies.1, &pose).unwrap();
                if held_by.is_still(&query, bodies, &pose) {
                    prop_assert!(report.bounds[1] >= probability, "{:?}", report.bounds);
                    prop_assert!(report.collision_probability >= probability);
                }
                let again = held_by.run(&query, bodies, &pose).unwrap();
                prop_assert_eq!(report.bounds, again.bounds);
                prop_assert_eq!(report.collision_probability, again.collision_probability);
            }
        }
    }
}
