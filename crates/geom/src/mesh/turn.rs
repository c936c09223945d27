//! Triangles turned alike, where the edges that they share say how.

use std::collections::HashMap;

use super::TriangleMesh;

/// A triangle at an edge, and whether it runs along it from the smaller index to the larger.
type Side = (u32, bool);

impl TriangleMesh {
    /// The same surface with its triangles turned so that neighbours run along the edge between them in
    /// opposite directions; each connected piece keeps the sense that most of its triangles have.
    ///
    /// Files with single triangles turned round are common, and a side has no meaning at them. Where more or
    /// fewer than two triangles share an edge it says nothing; a piece with one side only (a Möbius strip)
    /// stays as it is. Call it on a [`merged`](Self::merged) mesh.
    #[must_use]
    pub fn turned_alike(&self) -> Self {
        // How many triangles are at an edge, and two of them.
        let mut edges: HashMap<(u32, u32), (u32, [Side; 2])> = HashMap::new();
        for (triangle, &[a, b, c]) in (0..).zip(self.triangles()) {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let (count, sides) = edges.entry((from.min(to), from.max(to))).or_default();
                sides[usize::from(*count > 0)] = (triangle, from < to);
                *count += 1;
            }
        }
        // Of each triangle its neighbours, and whether they are turned alike.
        let mut neighbors = vec![[None; 3]; self.triangles().len()];
        let mut are_alike = true;
        for (_, sides) in edges.values().filter(|(count, _)| *count == 2) {
            let [(one, up), (other, also_up)] = *sides;
            let is_alike = up != also_up;
            are_alike &= is_alike;
            for (from, to) in [(one, other), (other, one)] {
                let free = neighbors[from as usize].iter_mut().find(|slot| slot.is_none());
                free.into_iter().for_each(|slot| *slot = Some((to, is_alike)));
            }
        }
        if are_alike {
            return self.clone();
        }
        let turned = turned(&neighbors);
        let turn = |(&[a, b, c], &is_turned): (&[u32; 3], &bool)| {
            if is_turned { [a, c, b] } else { [a, b, c] }
        };
        let triangles = self.triangles().iter().zip(&turned).map(turn).collect();
        self.with_triangles(triangles)
    }
}

/// Which triangles are to be turned round.
fn turned(neighbors: &[[Option<(u32, bool)>; 3]]) -> Vec<bool> {
    let mut turned: Vec<Option<bool>> = vec![None; neighbors.len()];
    for start in 0..neighbors.len() {
        if turned[start].is_some() {
            continue;
        }
        turned[start] = Some(false);
        let (mut piece, mut next, mut has_two_sides) = (vec![start], 0, true);
        while let Some(&triangle) = piece.get(next) {
            next += 1;
            let is_turned = turned[triangle] == Some(true);
            for &(neighbor, is_alike) in neighbors[triangle].iter().flatten() {
                let neighbor = neighbor as usize;
                let wanted = is_turned == is_alike;
                match turned[neighbor] {
                    None => {
                        turned[neighbor] = Some(wanted);
                        piece.push(neighbor);
                    }
                    Some(known) => has_two_sides &= known == wanted,
                }
            }
        }
        let count = piece.iter().filter(|&&triangle| turned[triangle] == Some(true)).count();
        let turns_most = 2 * count > piece.len();
        for triangle in piece {
            let is_turned = turned[triangle] == Some(true);
            turned[triangle] = Some(has_two_sides && is_turned != turns_most);
        }
    }
    turned.into_iter().map(|turned| turned == Some(true)).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::Point3;

    /// A cube of twelve triangles, its upper half cut off where `is_open`.
    fn cube(is_open: bool) -> TriangleMesh {
        let corner = |i: u32| Point3::new((i & 1).into(), (i >> 1 & 1).into(), (i >> 2).into());
        let quads =
            [[0, 2, 3, 1], [0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6], [4, 5, 7, 6]];
        let kept = if is_open { &quads[..5] } else { &quads[..] };
        let triangles = kept.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        TriangleMesh::new((0..8).map(corner).collect(), triangles).unwrap()
    }

    fn with_turned(mesh: &TriangleMesh, is_turned: impl Fn(usize) -> bool) -> TriangleMesh {
        let triangles = mesh.triangles().iter().enumerate();
        let turn =
            |(k, &[a, b, c]): (usize, &[u32; 3])| if is_turned(k) { [a, c, b] } else { [a, b, c] };
        TriangleMesh::new(mesh.vertices().to_vec(), triangles.map(turn).collect()).unwrap()
    }

    proptest! {
        #[test]
        fn a_few_turned_triangles_are_turned_back(
            turned in prop::collection::btree_set(0_usize..10, 0..5), is_open in any::<bool>(),
        ) {
            let good = cube(is_open);
            let bad = with_turned(&good, |k| turned.contains(&k));
            prop_assert_eq!(bad.turned_alike(), good);
        }
    }

    #[test]
    fn what_is_turned_alike_stays_inside_out_or_not() {
        for is_open in [false, true] {
            let inside_out = with_turned(&cube(is_open), |_| true);
            assert_eq!(inside_out.turned_alike(), inside_out);
        }
    }

    #[test]
    fn a_strip_with_one_side_and_a_sheet_with_its_own_back_stay_as_they_are() {
        let around = |k: u32| {
            let angle = f64::from(k) * std::f64::consts::TAU / 8.0;
            let [up, out] = [(0.5 * angle).cos(), (0.5 * angle).sin()];
            [-0.2, 0.2].map(|w| {
                let r = 1.0 + w * out;
                Point3::new(r * angle.cos(), r * angle.sin(), w * up)
            })
        };
        let vertices: Vec<Point3> = (0..8).flat_map(around).collect();
        let strip = (0..8).flat_map(|k: u32| {
            let (a, b) = (2 * k, 2 * k + 1);
            // The last joins the first upside down.
            let (c, d) = if k == 7 { (1, 0) } else { (a + 2, b + 2) };
            [[a, b, c], [b, d, c]]
        });
        let strip = TriangleMesh::new(vertices, strip.collect()).unwrap();
        assert_eq!(strip.turned_alike(), strip);
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| Point3::new(x, y, 0.0));
        let sheet = TriangleMesh::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 1]]).unwrap();
        assert_eq!(sheet.turned_alike(), sheet);
    }
}
