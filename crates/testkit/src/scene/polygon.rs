//! Triangulation of a simple polygon by ear clipping.

/// Triangles (indices into `outline`, anticlockwise) that fill a simple anticlockwise polygon.
///
/// # Panics
/// When the outline is clockwise or crosses itself.
pub(super) fn triangulate(outline: &[[f64; 2]]) -> Vec<[u32; 3]> {
    let mut left: Vec<u32> = (0..outline.len() as u32).collect();
    let mut triangles = Vec::new();
    while left.len() > 3 {
        let n = left.len();
        let ear = (0..n)
            .find(|&i| {
                let corner = [left[(i + n - 1) % n], left[i], left[(i + 1) % n]];
                is_ear(outline, &left, corner)
            })
            .expect("a simple anticlockwise polygon has an ear");
        triangles.push([left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]]);
        left.remove(ear);
    }
    triangles.push([left[0], left[1], left[2]]);
    triangles
}

/// Whether cutting off this convex corner leaves every other vertex outside of the cut triangle.
fn is_ear(outline: &[[f64; 2]], left: &[u32], corner: [u32; 3]) -> bool {
    let [a, b, c] = corner.map(|i| outline[i as usize]);
    turn(a, b, c) > 0.0
        && left.iter().filter(|i| !corner.contains(i)).all(|&i| {
            let p = outline[i as usize];
            turn(a, b, p) < 0.0 || turn(b, c, p) < 0.0 || turn(c, a, p) < 0.0
        })
}

/// Twice the signed area of a triangle: positive when a, b, c turn left.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_notched_outline_keeps_its_area() {
        let outline = [
            [0.0, 0.0],
            [1.0, 0.0],
            [1.0, 2.0],
            [2.0, 2.0],
            [2.0, 0.0],
            [3.0, 0.0],
            [3.0, 3.0],
            [0.0, 3.0],
        ];
        let triangles = triangulate(&outline);
        let area: f64 = triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| outline[i as usize]);
                0.5 * turn(a, b, c)
            })
            .sum();
        assert_eq!((triangles.len(), area), (6, 7.0));
    }
}
