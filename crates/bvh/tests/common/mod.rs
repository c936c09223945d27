//! Clouds and references shared by the tests.

use cloudtouch_bvh::{Primitive, Tree, TreeSettings};
use cloudtouch_geom::{Covariance, Point3, UncertainPoint, Vector3, normal, seed};

/// A point with the same noise (standard deviation, m) in every direction.
pub(crate) fn noisy(mean: Point3, std: f64) -> Primitive {
    let covariance = Covariance::isotropic(std * std);
    Primitive::Point {
        point: UncertainPoint { mean, covariance },
        weight: 0.5 + mean.x.fract().abs(),
    }
}

/// Random points on a bumpy sheet of 1 m around `offset`, with 2 mm to 6 mm of noise.
pub(crate) fn bumpy_sheet(stream: u64, count: usize, offset: Vector3) -> Vec<Primitive> {
    (0..count as u64)
        .map(|i| {
            let draw = |k| seed::unit(seed::derive(stream, i, k));
            let (x, y) = (draw(0) - 0.5, draw(1) - 0.5);
            let z = 0.1 * (7.0 * x).sin() * (5.0 * y).cos() + 0.003 * draw(2);
            noisy(Point3::new(x, y, z) + offset, 0.002 + 0.004 * draw(3))
        })
        .collect()
}

/// Every primitive moved by `offset`.
pub(crate) fn moved(primitives: &[Primitive], offset: &Vector3) -> Vec<Primitive> {
    let mut all = primitives.to_vec();
    for primitive in &mut all {
        match primitive {
            Primitive::Point { point, .. } => point.mean += offset,
            Primitive::Triangle(corners) => {
                for corner in corners {
                    *corner += offset;
                }
            }
        }
    }
    all
}

/// Named clouds that break careless builders.
pub(crate) fn degenerate_clouds() -> Vec<(&'static str, Vec<Primitive>)> {
    let at = |x, y, z| noisy(Point3::new(x, y, z), 0.003);
    let grid = |i: usize| at((i % 30) as f64 * 0.01, (i / 30 % 30) as f64 * 0.01, 0.0);
    let utm = Vector3::new(5e6, 4e5, 312.5);
    let exact = |p| Primitive::point(UncertainPoint::exact(p));
    let triangle =
        |p: [f64; 3], q: [f64; 3], r: [f64; 3]| Primitive::Triangle([p.into(), q.into(), r.into()]);
    let flat = Covariance::diagonal([1e-4, 1e-4, 0.0]);
    let mut fan: Vec<_> = (0..90)
        .map(|i| {
            let angle = i as f64 * 0.07;
            let p = [angle.cos(), angle.sin(), 0.01 * i as f64];
            triangle([0.0; 3], p, [p[0] * 1.1, p[1], p[2]])
        })
        .collect();
    fan.extend([triangle([0.1; 3], [0.1; 3], [0.1; 3]), triangle([0.0; 3], [1.0; 3], [2.0; 3])]);
    let singular = |i: usize| {
        let mean = Point3::new(i as f64 * 0.01, (i * i % 17) as f64 * 0.02, 0.0);
        Primitive::point(UncertainPoint { mean, covariance: flat })
    };
    vec![
        ("empty", vec![]),
        ("one point", vec![at(1.0, 2.0, 3.0)]),
        ("two equal points", vec![at(1.0, 2.0, 3.0); 2]),
        ("all points equal", vec![at(0.1, 0.2, 0.3); 257]),
        ("all points equal, far away", vec![moved(&[at(0.1, 0.2, 0.3)], &utm)[0]; 100]),
        ("collinear", (0..300).map(|i| at(i as f64 * 0.01, i as f64 * 0.02, -1.0)).collect()),
        ("coplanar grid", (0..900).map(grid).collect()),
        ("grid with every point three times", (0..2700).map(|i| grid(i % 900)).collect()),
        ("grid far away", moved(&(0..900).map(grid).collect::<Vec<_>>(), &utm)),
        ("sheet far away", bumpy_sheet(4, 500, utm)),
        ("two clumps", (0..200).map(|i| at((i % 2) as f64 * 1e3, 0.0, 0.0)).collect()),
        (
            "ever further out",
            (0..120).map(|i| exact(Point3::new(1.5_f64.powi(i), 0.0, 0.0))).collect(),
        ),
        ("exact points", (0..100).map(|i| exact(Point3::new(0.1, i as f64, 0.0))).collect()),
        ("singular covariances", (0..200).map(singular).collect()),
        (
            "covariance larger than the cloud",
            (0..100).map(|i| noisy(Point3::new(1e-3 * i as f64, 0.0, 0.0), 50.0)).collect(),
        ),
        ("tiny", moved_scale(&bumpy_sheet(9, 300, Vector3::zeros()), 1e-6)),
        ("huge", moved_scale(&bumpy_sheet(9, 300, Vector3::zeros()), 1e6)),
        ("triangles, some degenerate", fan.clone()),
        (
            "triangles and points",
            fan.into_iter().chain(bumpy_sheet(1, 100, Vector3::zeros())).collect(),
        ),
        (
            "zero weights",
            bumpy_sheet(2, 90, Vector3::zeros()).into_iter().map(weightless).collect(),
        ),
    ]
}

fn weightless(primitive: Primitive) -> Primitive {
    match primitive {
        Primitive::Point { point, .. } => Primitive::Point { point, weight: 0.0 },
        triangle => triangle,
    }
}

fn moved_scale(primitives: &[Primitive], factor: f64) -> Vec<Primitive> {
    primitives
        .iter()
        .map(|primitive| match primitive {
            Primitive::Point { point, .. } => {
                let mean = point.mean * factor;
                Primitive::point(UncertainPoint {
                    mean,
                    covariance: point.covariance.scaled(factor),
                })
            }
            Primitive::Triangle(corners) => Primitive::Triangle(corners.map(|c| c * factor)),
        })
        .collect()
}

/// A tree with small leaves, so that small clouds have many.
pub(crate) fn small_leaves(primitives: Vec<Primitive>) -> Tree {
    let settings = TreeSettings { max_leaf_points: 12, min_leaf_points: 4, ..Default::default() };
    Tree::build(primitives, &settings).expect("a usable cloud")
}

/// The probability a plane half way between two points leaves to the less certain one.
pub(crate) fn pair_probability(p: &Primitive, q: &Primitive) -> f64 {
    let direction = q.centroid() - p.centroid();
    let distance = direction.norm();
    if distance == 0.0 {
        return 0.5;
    }
    let along = direction / distance;
    normal::below_zero(0.5 * distance, p.std_along(&along).max(q.std_along(&along)))
}

/// Whether a bound is kept as stated, but that it is rounded up to single precision.
pub(crate) fn is_kept(bound: f64, stated: f64) -> bool {
    bound >= stated && bound <= stated * (1.0 + f64::from(f32::EPSILON))
}

/// The largest [`pair_probability`] over two lists of primitives.
pub(crate) fn flat_answer<'a>(
    a: impl IntoIterator<Item = &'a Primitive>,
    b: impl IntoIterator<Item = &'a Primitive> + Clone,
) -> f64 {
    a.into_iter()
        .flat_map(|p| b.clone().into_iter().map(move |q| pair_probability(p, q)))
        .fold(0.0, f64::max)
}

/// The primitives of a leaf.
pub(crate) fn held(tree: &Tree, leaf: cloudtouch_bvh::NodeId) -> Vec<Primitive> {
    let indices = tree.leaf(leaf).expect("a leaf").primitive_indices();
    indices.iter().filter_map(|&i| tree.primitive(i as usize)).collect()
}
