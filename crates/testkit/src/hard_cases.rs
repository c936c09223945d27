//! Pairs of clouds that break careless numerics, each with a name and a reason.

use cloudtouch_geom::{Matrix3, Point3, TriangleMesh, Vector3, seed};

use crate::{
    random::normal_vector,
    scene,
    surface::{positions, sample_surface},
};

/// Two clouds in one frame with a covariance per point, raw: it may be what no type lets through.
#[derive(Debug, Clone, PartialEq)]
pub struct HardCase {
    /// A short name, unique in the catalogue.
    pub name: &'static str,
    /// Why it is hard.
    pub reason: &'static str,
    /// Positions, m.
    pub cloud_a: Vec<Point3>,
    /// Positions, m.
    pub cloud_b: Vec<Point3>,
    /// One matrix per point of `cloud_a`, m².
    pub covariance_a: Vec<Matrix3>,
    /// One matrix per point of `cloud_b`, m².
    pub covariance_b: Vec<Matrix3>,
    /// Whether every number is one a caller may pass. Where not, a typed error is the right answer,
    /// or a filter that says what it dropped; never a panic, and never "free" for no reason.
    pub valid: bool,
    /// Whether the surfaces behind the clouds have a point in common, where that is beyond doubt.
    pub collides: Option<bool>,
}

impl HardCase {
    /// A valid case with the same isotropic noise on all points.
    fn new(
        name: &'static str,
        reason: &'static str,
        cloud_a: Vec<Point3>,
        cloud_b: Vec<Point3>,
    ) -> Self {
        let covariance = |cloud: &[Point3]| vec![isotropic(0.002); cloud.len()];
        let (covariance_a, covariance_b) = (covariance(&cloud_a), covariance(&cloud_b));
        Self {
            name,
            reason,
            cloud_a,
            cloud_b,
            covariance_a,
            covariance_b,
            valid: true,
            collides: None,
        }
    }

    fn collides(mut self, collides: bool) -> Self {
        self.collides = Some(collides);
        self
    }

    fn invalid(mut self) -> Self {
        self.valid = false;
        self
    }

    /// The same covariance on every point of both clouds.
    fn with_covariance(mut self, covariance: Matrix3) -> Self {
        self.covariance_a.fill(covariance);
        self.covariance_b.fill(covariance);
        self
    }

    /// Coordinates times `factor`, then moved by `offset`; covariances scale along.
    fn placed(mut self, factor: f64, offset: Vector3) -> Self {
        for p in self.cloud_a.iter_mut().chain(&mut self.cloud_b) {
            *p = Point3::from(p.coords * factor + offset);
        }
        for c in self.covariance_a.iter_mut().chain(&mut self.covariance_b) {
            *c *= factor * factor;
        }
        self
    }
}

/// The whole catalogue, always the same; the largest cloud has 100,000 points.
pub fn hard_cases() -> Vec<HardCase> {
    [few_points(), degenerate_layouts(), scales(), covariances(), not_finite(), shapes()].concat()
}

/// A cloud of `count` points of a square of 0.2 m at height `z`.
fn patch(z: f64, count: usize, seed: u64) -> Vec<Point3> {
    let samples = sample_surface(&scene::plane_patch(0.2), count, seed);
    samples.iter().map(|s| s.position + Vector3::z() * z).collect()
}

/// Two parallel patches 5 cm apart, far beyond their noise of 2 mm: free beyond doubt.
fn apart(name: &'static str, reason: &'static str) -> HardCase {
    HardCase::new(name, reason, patch(0.0, 100, 1), patch(0.05, 100, 2)).collides(false)
}

/// Two patches that cross at a small angle of slope 1/4: in collision beyond doubt.
fn crossing(name: &'static str, reason: &'static str) -> HardCase {
    let tilted = patch(0.0, 400, 4).iter().map(|p| Point3::new(p.x, p.y, 0.25 * p.x)).collect();
    HardCase::new(name, reason, patch(0.0, 400, 3), tilted).collides(true)
}

fn isotropic(std: f64) -> Matrix3 {
    Matrix3::identity() * (std * std)
}

fn few_points() -> Vec<HardCase> {
    let one = |z: f64| vec![Point3::new(0.0, 0.0, z)];
    vec![
        HardCase::new("both-empty", "no points to take a mean of", vec![], vec![]),
        HardCase::new("empty-and-patch", "one class is missing", vec![], patch(0.0, 100, 1)),
        HardCase::new("two-points", "one point a side: no spacing, no normal", one(0.0), one(0.05))
            .collides(false),
        HardCase::new("equal-points", "distance zero, no direction", one(0.0), one(0.0)),
        HardCase::new(
            "point-and-patch",
            "classes of very different size",
            one(0.05),
            patch(0.0, 100, 1),
        )
        .collides(false),
        HardCase::new(
            "point-and-100000",
            "balance of classes, cost of a tree",
            one(0.05),
            patch(0.0, 100_000, 1),
        )
        .collides(false),
    ]
}

fn degenerate_layouts() -> Vec<HardCase> {
    let line =
        |y: f64| (0..50).map(|i| Point3::new(0.004 * f64::from(i), y, 0.0)).collect::<Vec<_>>();
    let grid: Vec<Point3> = (0..4000)
        .map(|i| {
            Point3::new(
                0.01 * f64::from(i % 20),
                0.01 * f64::from(i / 20 % 20),
                0.01 * f64::from(i / 400),
            )
        })
        .collect();
    let above = grid.iter().map(|p| p + Vector3::z() * 0.15).collect();
    let patch_points = patch(0.0, 100, 1);
    let beside = patch_points.iter().map(|p| p + Vector3::x() * 0.25).collect();
    let every_third = patch_points.iter().step_by(3).copied().collect();
    let tenfold = |z: f64| [patch(z, 20, 1).as_slice()].repeat(10).concat();
    vec![
        HardCase::new(
            "all-equal",
            "boxes, spacing and spread are zero; a split never ends",
            vec![Point3::origin(); 50],
            vec![Point3::new(0.0, 0.0, 0.05); 50],
        )
        .collides(false),
        HardCase::new(
            "duplicates",
            "every point ten times: k neighbours at distance zero",
            tenfold(0.0),
            tenfold(0.05),
        )
        .collides(false),
        HardCase::new(
            "collinear",
            "two directions without spread; normals undefined",
            line(0.0),
            line(0.05),
        )
        .collides(false),
        HardCase::new(
            "coplanar",
            "both clouds in one plane, side by side",
            patch_points.clone(),
            beside,
        )
        .collides(false),
        HardCase::new(
            "identical",
            "labels contradict each other at every point",
            patch_points.clone(),
            patch_points.clone(),
        )
        .collides(true),
        HardCase::new(
            "subset",
            "one cloud is every third point of the other",
            patch_points,
            every_third,
        )
        .collides(true),
        HardCase::new(
            "grid-1cm",
            "thousands of points share each coordinate: ties everywhere",
            grid,
            above,
        )
        .collides(false),
    ]
}

fn scales() -> Vec<HardCase> {
    let utm = Vector3::new(512_345.0, 5_012_345.0, 812.0);
    vec![
        apart("utm", "millimetres at 5e6 m: squares of coordinates cancel").placed(1.0, utm),
        crossing("utm-crossing", "as utm, in collision").placed(1.0, utm),
        apart("micro", "the scene at 1e-6: absolute tolerances swallow it")
            .placed(1e-6, Vector3::zeros()),
        apart("mega", "the scene at 1e6: absolute tolerances never hold")
            .placed(1e6, Vector3::zeros()),
        crossing("micro-crossing", "as micro, in collision").placed(1e-6, Vector3::zeros()),
        crossing("mega-crossing", "as mega, in collision").placed(1e6, Vector3::zeros()),
    ]
}

fn covariances() -> Vec<HardCase> {
    let flat = Matrix3::from_diagonal(&Vector3::new(4e-6, 4e-6, 0.0));
    let needle = Matrix3::from_diagonal(&Vector3::new(1e-4, 1e-16, 1e-16));
    let mut crooked = isotropic(0.002);
    crooked[(0, 2)] = 1e-6;
    let indefinite = Matrix3::from_diagonal(&Vector3::new(4e-6, -4e-6, 4e-6));
    let mut mixed = apart("exact-and-noisy", "exact points among points with 6 cm of noise");
    mixed.covariance_a.iter_mut().step_by(2).for_each(|c| *c = Matrix3::zeros());
    mixed.covariance_b.iter_mut().step_by(2).for_each(|c| *c = isotropic(0.06));
    vec![
        apart("zero-covariance", "nothing to divide by").with_covariance(Matrix3::zeros()),
        crossing("zero-covariance-crossing", "as zero-covariance, in collision")
            .with_covariance(Matrix3::zeros()),
        apart("singular-covariance", "no inverse: flat ellipsoids").with_covariance(flat),
        apart("needle-covariance", "condition 1e12").with_covariance(needle),
        HardCase {
            collides: None,
            ..apart("huge-covariance", "noise of 10 m on a scene of 0.2 m: nothing is known")
        }
        .with_covariance(isotropic(10.0)),
        HardCase { collides: None, ..mixed },
        apart("unsymmetric-covariance", "not a covariance: mirrored entries differ")
            .with_covariance(crooked)
            .invalid(),
        apart("negative-covariance", "not a covariance: a negative variance")
            .with_covariance(indefinite)
            .invalid(),
        apart(
            "nan-covariance",
            "not a covariance: NaN ends as probability 0 when compared carelessly",
        )
        .with_covariance(Matrix3::repeat(f64::NAN))
        .invalid(),
    ]
}

fn not_finite() -> Vec<HardCase> {
    let spoiled = |name, reason, value: f64| {
        let mut case = crossing(name, reason).invalid();
        case.cloud_a[17].y = value;
        case.cloud_b[5] = Point3::from(Vector3::repeat(value));
        case
    };
    vec![
        spoiled(
            "nan-points",
            "comparisons with NaN are false: sorting and minima go wrong",
            f64::NAN,
        ),
        spoiled("infinite-points", "boxes become infinite, differences NaN", f64::INFINITY),
        HardCase::new(
            "all-nan",
            "nothing is left after filtering: must not read as free",
            vec![Point3::from(Vector3::repeat(f64::NAN)); 20],
            patch(0.0, 100, 1),
        )
        .invalid(),
    ]
}

fn shapes() -> Vec<HardCase> {
    let cloud = |mesh: &TriangleMesh, count: usize, seed: u64| {
        positions(&sample_surface(mesh, count, seed))
    };
    let ring = scene::torus(0.3, 0.06, 48);
    let ring_points = cloud(&ring, 1500, 5);
    // Turned into the xz plane and through the middle of the tube's circle.
    let linked = cloud(&ring, 1500, 6).iter().map(|p| Point3::new(p.x + 0.3, p.z, p.y)).collect();
    let plate = scene::plate_with_hole(0.4, 0.04, 0.10);
    let tip = |sign: f64, seed: u64| {
        let wedge = cloud(&scene::wedge(0.2, 0.2, 0.0001), 399, seed);
        let mut points: Vec<_> = wedge.iter().map(|p| Point3::new(p.x, p.y, sign * p.z)).collect();
        points.push(Point3::origin());
        points
    };
    let blob = |seed: u64, x: f64| {
        let mut rng = seed::generator(seed);
        (0..200)
            .map(|_| Point3::new(x, 0.0, 0.0) + normal_vector(&mut rng) * 0.05)
            .collect::<Vec<_>>()
    };
    vec![
        HardCase::new("linked-tori", "separable by a curved surface only", ring_points, linked)
            .collides(false),
        HardCase::new(
            "peg-in-hole",
            "2 cm of clearance all around: no plane separates them",
            cloud(&plate, 1500, 7),
            cloud(&scene::peg(0.08, 0.3), 1500, 8),
        )
        .collides(false),
        crossing("crossing-sheets", "each leaf sees a cross, not two sides"),
        HardCase::new("touching-tips", "contact in a single point", tip(1.0, 9), tip(-1.0, 10))
            .collides(true),
        HardCase::new(
            "thin-slab",
            "two faces 2 cm apart must not be averaged; the other cloud lies 3 cm above the upper",
            cloud(&scene::thin_slab(0.2), 400, 11),
            patch(0.04, 200, 12),
        )
        .collides(false),
        HardCase::new(
            "blobs",
            "no surface at all, only volume; classes overlap",
            blob(13, 0.0),
            blob(14, 0.05),
        ),
    ]
}
