//! Places that stand for the whole surface of a mesh, each for the same area.

use cloudtouch_geom::Point3;

use super::prepare::Mesh;

/// The first two of the generalised golden ratios: no two places of a triangle coincide, and any
/// number of them is spread evenly.
const STRIDES: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_2];

impl Mesh {
    /// How far apart the coordinates of its file are, m, where these are in single precision far from the origin
    /// and the mesh is no larger than some thousand of these steps: a ground of a few triangles may be.
    pub(crate) fn rounded_to(&self) -> Option<f64> {
        const STEPS: f64 = 1e4;
        self.step.filter(|step| self.size() < STEPS * step)
    }

    /// Whether any triangle is more than a line.
    pub(crate) fn has_area(&self) -> bool {
        let normal = |[a, b, c]: [Point3; 3]| (b - a).cross(&(c - a));
        // The nearest to a line that single precision tells from one.
        let is_thin = |corners: [Point3; 3]| {
            let [a, b, c] = corners;
            let longest = (b - a).norm_squared().max((c - a).norm_squared());
            normal(corners).norm() <= 1e-7 * longest
        };
        (0..self.triangle_count()).any(|t| !is_thin(self.corners(t)))
    }

    /// So many places on the surface, in the local frame, m; always the same.
    pub(super) fn spread(&self, count: usize) -> Vec<Point3> {
        let areas: Vec<f64> = (0..self.triangle_count())
            .map(|t| {
                let [a, b, c] = self.corners(t);
                0.5 * (b - a).cross(&(c - a)).norm()
            })
            .collect();
        let each = areas.iter().sum::<f64>() / count as f64;
        if each == 0.0 {
            return (0..self.triangle_count()).flat_map(|t| self.corners(t)).take(count).collect();
        }
        let mut places = Vec::with_capacity(count);
        let mut covered = 0.0;
        for (triangle, area) in areas.iter().enumerate() {
            covered += area;
            while places.len() < count && covered > (places.len() as f64 + 0.5) * each {
                places.push(self.place_on(triangle, places.len()));
            }
        }
        places
    }

    fn place_on(&self, triangle: usize, index: usize) -> Point3 {
        let [mut u, mut v] = STRIDES.map(|stride| (stride * (index as f64 + 1.0)).fract());
        if u + v > 1.0 {
            [u, v] = [1.0 - u, 1.0 - v];
        }
        let [a, b, c] = self.corners(triangle);
        a + u * (b - a) + v * (c - a)
    }
}
