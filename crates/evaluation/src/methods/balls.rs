//! Yes or no by capt: balls about the points of one cloud against the points of the other, the fastest check of
//! clouds that motion planners have.

use std::time::Instant;

use anyhow::Result;
use capt::Capt;
use cloudtouch_geom::Point3;

use super::{Draw, Method, Prepared, cleaned};
use crate::answers::{Pair, Said};

/// Balls of 1 cm about the points of the moving cloud.
pub struct Balls;

/// m.
const RADIUS: f32 = 0.01;

impl Method for Balls {
    fn name(&self) -> String {
        "capt, 1 cm balls".into()
    }

    fn prepare(&self, draw: &Draw<'_>) -> Result<Prepared> {
        let [a, b] = [cleaned(draw.a)?.points, cleaned(draw.b)?.points];
        let points: Vec<[f32; 3]> = a.iter().map(single).collect();
        let index = Capt::<3>::new(&points, (0.0, RADIUS), 8);
        Ok(Box::new(move |pair, a_from_b| {
            if pair == Pair::CloudMesh {
                return Ok(None);
            }
            let start = Instant::now();
            let touches =
                |p: &Point3| index.collides(&single(&a_from_b.transform_point(p)), RADIUS);
            Ok(Some(Said::score(f64::from(u8::from(b.iter().any(touches))), start)))
        }))
    }
}

fn single(point: &Point3) -> [f32; 3] {
    point.coords.map(|v| v as f32).into()
}
