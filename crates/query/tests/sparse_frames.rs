//! The frame in which sparse clouds are stored does not decide their probability: where a few points
//! fit several surfaces, which one is taken must not hang on rounding.

use crate::common::{ask, prepare, uniform};
use cloudtouch::Mode;
use cloudtouch::geom::{Point3, Pose, Vector3, seed};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};

/// What the library promises.
const TOLERANCE: f64 = 1e-3;
const PAIRS: u64 = 1000;

/// Numbers in [0, 1), one after another.
struct Draws {
    stream: u64,
    next: u64,
}

impl Draws {
    fn unit(&mut self) -> f64 {
        self.next += 1;
        uniform(self.stream, self.next)
    }

    fn within(&mut self, half: f64) -> f64 {
        half * (2.0 * self.unit() - 1.0)
    }

    fn motion(&mut self, far: f64) -> Pose {
        let translation = Vector3::from_fn(|_, _| self.within(far));
        let turn = [self.within(3.1), self.within(3.1), self.within(3.1)];
        Pose::from_translation_rpy(translation, turn)
    }

    /// A place on a plane, a box, a ball or a saddle some 20 cm wide.
    fn place(&mut self, shape: u64) -> Point3 {
        let [u, v, w] = [self.within(0.1), self.within(0.1), self.within(0.1)];
        match shape {
            0 => Point3::new(u, v, 0.0),
            1 => match (3.0 * self.unit()) as u32 {
                0 => Point3::new(0.1_f64.copysign(w), u, v),
                1 => Point3::new(u, 0.1_f64.copysign(w), v),
                _ => Point3::new(u, v, 0.1_f64.copysign(w)),
            },
            2 => Point3::from(Vector3::new(u, v, w).normalize() * 0.1),
            _ => Point3::new(u, v, 4.0 * (u * u - v * v)),
        }
    }

    /// 30 to 400 noisy points of one of these, turned and moved by a little.
    fn cloud(&mut self, std: f64) -> Vec<Point3> {
        let shape = (4.0 * self.unit()) as u64;
        let count = (30.0 * (400.0_f64 / 30.0).powf(self.unit())) as usize;
        let pose = self.motion(0.1);
        let exact: Vec<_> = (0..count).map(|_| pose.transform_point(&self.place(shape))).collect();
        add_noise(&exact, NoiseKind::Gaussian, std, seed::derive(self.stream, self.next, 0))
    }
}

fn moved(points: &[Point3], frame: &Pose) -> Vec<Point3> {
    points.iter().map(|p| frame.transform_point(p)).collect()
}

/// Axes exchanged, moved a few metres, turned, and moved to map coordinates.
fn frames(draws: &mut Draws) -> [Pose; 4] {
    let quarter = std::f64::consts::FRAC_PI_2;
    [
        // (x, y, z) to (y, z, x).
        Pose::from_translation_rpy(Vector3::zeros(), [-quarter, -quarter, 0.0]),
        Pose::from_translation(Vector3::new(1.0, 2.0, 3.0)),
        draws.motion(2.0),
        Pose::from_translation(Vector3::new(500_000.0, 5_400_000.0, 300.0)),
    ]
}

#[test]
fn a_choice_among_near_ties_decided() {
    let mut jumps = Vec::new();
    for stream in 0..PAIRS {
        let mut draws = Draws { stream, next: 0 };
        let std = 1e-5 * 1e3_f64.powf(draws.unit());
        let (a, b) = (draws.cloud(std), draws.cloud(std));
        let answer = |frame: &Pose| {
            let [a, b] =
                [&a, &b].map(|points| prepare(moved(points, frame), std, Mode::Calibrated));
            ask(Mode::Calibrated, &a, &b, &Pose::identity()).collision_probability
        };
        let still = answer(&Pose::identity());
        for (which, frame) in frames(&mut draws).iter().enumerate() {
            let elsewhere = answer(frame);
            if (elsewhere - still).abs() > TOLERANCE {
                jumps.push((stream, which, still, elsewhere));
            }
        }
    }
    assert!(jumps.is_empty(), "{} of {PAIRS} pairs: {jumps:?}", jumps.len());
}
