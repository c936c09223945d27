//! Polygons of meshes cut into triangles.

use cloudtouch_geom::{Point3, Vector3};

/// Those with more corners stay fans: time grows with the square of their number.
const MOST_CORNERS: usize = 1000;

/// The polygons with more than three corners among triangles, which fan out from their first corner until all
/// vertices are known.
#[derive(Debug, Default)]
pub(crate) struct Polygons {
    /// The first of its triangles, and how many.
    fans: Vec<[usize; 2]>,
}

impl Polygons {
    /// Notes that so many triangles from one on are a polygon's.
    pub(crate) fn push(&mut self, first: usize, count: usize) {
        if (2..=MOST_CORNERS - 2).contains(&count) {
            self.fans.push([first, count]);
        }
    }

    /// Cuts those that are not convex anew, so that none covers what is beside its outline. One that crosses
    /// itself stays as it is.
    pub(crate) fn cut(&self, vertices: &[Point3], triangles: &mut [[u32; 3]]) {
        for &[first, count] in &self.fans {
            let fan = &mut triangles[first..first + count];
            let corners: Vec<u32> =
                fan[0][..2].iter().copied().chain(fan.iter().map(|triangle| triangle[2])).collect();
            let places: Vec<Point3> = corners.iter().map(|&i| vertices[i as usize]).collect();
            if let Some(ears) = ears(&flattened(&places)) {
                for (triangle, ear) in fan.iter_mut().zip(ears) {
                    *triangle = ear.map(|corner| corners[corner]);
                }
            }
        }
    }
}

/// A polygon seen along its normal (Newell), anticlockwise.
fn flattened(places: &[Point3]) -> Vec<[f64; 2]> {
    let from = places[0];
    let mut normal = Vector3::zeros();
    for (k, p) in places.iter().enumerate() {
        normal += (p - from).cross(&(places[(k + 1) % places.len()] - from));
    }
    let axis = normal.iamax();
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let is_turned = normal[axis] < 0.0;
    let flat = |p: &Point3| {
        let [x, y] = [p[u] - from[u], p[v] - from[v]];
        if is_turned { [y, x] } else { [x, y] }
    };
    places.iter().map(flat).collect()
}

/// Twice the area of a triangle, positive where it turns left.
fn area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// A polygon of which ears are cut off.
struct Ring<'a> {
    outline: &'a [[f64; 2]],
    /// The corners that are left.
    left: Vec<usize>,
    /// Whether each of these is an ear.
    are_ears: Vec<bool>,
}

impl<'a> Ring<'a> {
    fn new(outline: &'a [[f64; 2]]) -> Self {
        Self { outline, left: (0..outline.len()).collect(), are_ears: Vec::new() }
    }

    /// A corner between the two beside it.
    fn at(&self, k: usize) -> [usize; 3] {
        let count = self.left.len();
        [self.left[(k + count - 1) % count], self.left[k], self.left[(k + 1) % count]]
    }

    fn turn(&self, of: [usize; 3]) -> f64 {
        area(of.map(|i| self.outline[i]))
    }

    fn is_convex(&self) -> bool {
        (0..self.left.len()).all(|k| self.turn(self.at(k)) >= 0.0)
    }

    fn is_ear(&self, k: usize) -> bool {
        let ear = self.at(k);
        let is_corner = |i: usize| ear.iter().any(|&at| self.outline[at] == self.outline[i]);
        let holds = |i: usize| {
            let [a, b, c] = ear;
            [[a, b, i], [b, c, i], [c, a, i]].into_iter().all(|side| self.turn(side) >= 0.0)
        };
        self.turn(ear) >= 0.0 && !self.left.iter().any(|&i| !is_corner(i) && holds(i))
    }

    fn find_ears(&mut self) -> Option<usize> {
        self.are_ears = (0..self.left.len()).map(|k| self.is_ear(k)).collect();
        self.first_ear()
    }

    fn first_ear(&self) -> Option<usize> {
        self.are_ears.iter().position(|&is_ear| is_ear)
    }

    /// What is left then changes at the two corners beside it.
    fn cut(&mut self, k: usize) -> [usize; 3] {
        let ear = self.at(k);
        self.left.remove(k);
        self.are_ears.remove(k);
        let count = self.left.len();
        for beside in [(k + count - 1) % count, k % count] {
            self.are_ears[beside] = self.is_ear(beside);
        }
        ear
    }
}

/// Triangles by cutting off ears; `None` for a convex polygon, and where there is no ear left.
fn ears(outline: &[[f64; 2]]) -> Option<Vec<[usize; 3]>> {
    /// Corners in one line, or one on another, may hide an ear, which looking at all anew finds: so often.
    const MOST_LOOKS: usize = 8;
    let mut ring = Ring::new(outline);
    if ring.is_convex() {
        return None;
    }
    let mut found = Vec::with_capacity(outline.len() - 2);
    let mut looks = 0;
    while ring.left.len() > 3 {
        let ear = ring.first_ear().or_else(|| {
            looks += 1;
            (looks <= MOST_LOOKS).then(|| ring.find_ears()).flatten()
        })?;
        found.push(ring.cut(ear));
    }
    found.push([ring.left[0], ring.left[1], ring.left[2]]);
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The triangles of a polygon in the plane z = x, which begins at each of its corners in turn.
    fn areas(outline: &[[f64; 2]]) -> Vec<f64> {
        let count = outline.len();
        let of_first = |first: usize| {
            let places: Vec<Point3> = (0..count)
                .map(|k| outline[(first + k) % count])
                .map(|[x, y]| Point3::new(x, y, x))
                .collect();
            let mut triangles: Vec<[u32; 3]> =
                (1..count as u32 - 1).map(|k| [0, k, k + 1]).collect();
            let mut polygons = Polygons::default();
            polygons.push(0, triangles.len());
            polygons.cut(&places, &mut triangles);
            let area = |corners: &[u32; 3]| {
                let [a, b, c] = corners.map(|i| places[i as usize]);
                0.5 * (b - a).cross(&(c - a)).norm() / std::f64::consts::SQRT_2
            };
            triangles.iter().map(area).sum::<f64>()
        };
        (0..count).map(of_first).collect()
    }

    #[test]
    fn polygons_with_notches_cover_no_more_than_they_hold() {
        let ell = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        let u = [
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 3.0],
            [2.0, 3.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [0.0, 3.0],
        ];
        let turned = |outline: &[[f64; 2]]| outline.iter().rev().copied().collect::<Vec<_>>();
        for (outline, expected) in
            [(&ell[..], 5.0), (&turned(&ell), 5.0), (&u[..], 7.0), (&turned(&u), 7.0)]
        {
            for area in areas(outline) {
                assert!((area - expected).abs() < 1e-12, "{area}");
            }
        }
        let gear: Vec<[f64; 2]> = (0..48)
            .map(|k| {
                let (radius, angle) = (
                    if k / 2 % 2 == 0 { 1.0 } else { 0.7 },
                    f64::from(k) * std::f64::consts::TAU / 48.0,
                );
                [radius * angle.cos(), radius * angle.sin()]
            })
            .collect();
        let expected = shoelace(&gear);
        assert!(areas(&gear).iter().all(|area| (area - expected).abs() < 1e-12));
    }

    fn shoelace(outline: &[[f64; 2]]) -> f64 {
        let ends = outline.iter().zip(outline.iter().cycle().skip(1));
        ends.map(|([x, y], [to_x, to_y])| 0.5 * (x * to_y - to_x * y)).sum()
    }

    /// Most of its corners are no ears for long: looking for one from the first corner on took the cube of their number.
    #[test]
    fn a_long_spiral_is_cut_by_few_looks_at_all_of_it() {
        let arm = |k: u32, width: f64| {
            let angle = 0.1 * f64::from(k);
            let radius = 1.0 + 0.2 * angle + width;
            [radius * angle.cos(), radius * angle.sin()]
        };
        let out = (0..499).map(|k| arm(k, 0.5));
        let spiral: Vec<[f64; 2]> = out.chain((0..499).rev().map(|k| arm(k, 0.0))).collect();
        let found = ears(&spiral).expect("it is not convex");
        let turn = |ear: &[usize; 3]| 0.5 * area(ear.map(|i| spiral[i]));
        let covered: f64 = found.iter().map(turn).sum();
        assert!(found.iter().all(|ear| turn(ear) >= 0.0));
        assert!((covered - shoelace(&spiral).abs()).abs() < 1e-9, "{covered}");
    }

    #[test]
    fn a_convex_polygon_keeps_its_fan_and_one_that_crosses_itself_does_no_harm() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert!(ears(&square).is_none());
        let bow = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        assert!(areas(&bow).iter().all(|area| area.is_finite()));
        assert!(areas(&[[0.0, 0.0]; 5]).iter().all(|area| *area == 0.0));
    }
}
