//! Seeded clouds sampled from known surfaces.

pub(crate) mod sigma;
use cloudtouch_geom::{Covariance, Point3, Vector3, seed};
use cloudtouch_noise::{
    Combination, Discretization, Neighborhoods, NoiseModel, NoiseSettings, Refined, SensorNoise,
};

/// A number in [0, 1) that depends on `stream` and `index` alone.
pub(crate) fn uniform(stream: u64, index: usize) -> f64 {
    seed::unit(seed::derive(stream, index as u64, 0))
}

/// Three independent standard normal numbers (Box and Muller).
pub(crate) fn gaussian(stream: u64, index: usize) -> Vector3 {
    Vector3::from_fn(|axis, _| {
        let draw = |k| seed::unit(seed::derive(stream, index as u64, 2 * axis as u64 + k));
        (-2.0 * (1.0 - draw(0)).ln()).sqrt() * (std::f64::consts::TAU * draw(1)).cos()
    })
}

/// Samples of a surface with the outward normals there.
pub(crate) struct Surface {
    pub(crate) points: Vec<Point3>,
    pub(crate) normals: Vec<Vector3>,
}

/// A square of side `side` in the plane z = 0, one jittered sample in each square of side
/// `spacing`.
pub(crate) fn plane(side: f64, spacing: f64, stream: u64) -> Surface {
    let count = (side / spacing).round() as usize;
    let points = (0..count * count)
        .map(|i| {
            let place =
                |cell: usize, s| (cell as f64 + uniform(stream + s, i)) * spacing - 0.5 * side;
            Point3::new(place(i % count, 0), place(i / count, 1), 0.0)
        })
        .collect::<Vec<_>>();
    let normals = vec![Vector3::z(); points.len()];
    Surface { points, normals }
}

/// A sphere about the origin with one sample for each area `spacing`², at random.
pub(crate) fn sphere(radius: f64, spacing: f64, stream: u64) -> Surface {
    let count = (4.0 * std::f64::consts::PI * (radius / spacing).powi(2)).round() as usize;
    let normals: Vec<Vector3> = (0..count).map(|i| gaussian(stream, i).normalize()).collect();
    let points = normals.iter().map(|n| Point3::from(n * radius)).collect();
    Surface { points, normals }
}

/// The points with isotropic noise.
pub(crate) fn noisy(points: &[Point3], std: f64, stream: u64) -> Vec<Point3> {
    points.iter().enumerate().map(|(i, p)| p + gaussian(stream, i) * std).collect()
}

pub(crate) fn model(combination: Combination) -> NoiseModel {
    // Without a cap on Ψ there is no bound to test.
    let discretization = Discretization { is_capped: true, ..Discretization::default() };
    let settings = NoiseSettings { combination, discretization, ..NoiseSettings::default() };
    NoiseModel::new(settings).expect("valid")
}

/// The same noise in every direction at every point.
pub(crate) fn isotropic(std: f64, points: &[Point3]) -> SensorNoise {
    SensorNoise::uniform(Covariance::isotropic(std * std), points.len())
}

/// Every point refined, without a cap.
pub(crate) fn refine_all(
    model: &NoiseModel,
    points: &[Point3],
    sensor: &SensorNoise,
) -> Vec<Refined> {
    let index = Neighborhoods::new(points.to_vec()).expect("an index");
    model.refine_all(&index, sensor, f64::INFINITY)
}

pub(crate) fn root_mean_square(values: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) = values.into_iter().fold((0.0, 0), |(s, n), v| (s + v * v, n + 1));
    (sum / f64::from(count.max(1))).sqrt()
}

/// The faces of a box about the origin with these edge lengths, as [`plane`] samples them.
pub(crate) fn cuboid(edges: [f64; 3], spacing: f64, stream: u64) -> Surface {
    let mut surface = Surface { points: Vec::new(), normals: Vec::new() };
    for face in 0..6 {
        let axis = face / 2;
        let sign = if face % 2 == 0 { 1.0 } else { -1.0 };
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let across = [u, v].map(|a| (edges[a] / spacing).round().max(1.0) as usize);
        for cell in 0..across[0] * across[1] {
            let place = |steps: usize, count: usize, edge: f64, draw: u64| {
                let jitter = uniform(stream + 10 * face as u64 + draw, cell);
                ((steps as f64 + jitter) / count as f64 - 0.5) * edge
            };
            let mut point = Point3::origin();
            point[axis] = 0.5 * sign * edges[axis];
            point[u] = place(cell % across[0], across[0], edges[u], 0);
            point[v] = place(cell / across[0], across[1], edges[v], 1);
            surface.points.push(point);
            surface.normals.push(Vector3::ith(axis, sign));
        }
    }
    surface
}

/// Distance of a place from the surface of a box about the origin.
pub(crate) fn distance_to_cuboid(place: &Point3, edges: [f64; 3]) -> f64 {
    let beyond = Vector3::from_fn(|a, _| place[a].abs() - 0.5 * edges[a]);
    let outside = beyond.map(|v| v.max(0.0)).norm();
    if outside > 0.0 { outside } else { -beyond.max() }
}
