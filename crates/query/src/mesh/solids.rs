//! Which parts of a mesh are closed, and turned so that what they enclose is inside.
//!
//! A floor beside a box has no inside, and takes nothing away from that of the box; a part that was mirrored
//! encloses as much as the others.

use std::collections::{BTreeMap, HashMap};

use cloudtouch_geom::{Point3, TriangleMesh, Vector3};

use super::parts::{encloses, root};
use super::winding::{FarRadii, INSIDE, Winding};

/// The triangles of a mesh by its parts.
pub(super) struct Solids {
    /// All of them, closed parts turned outward but for cavities.
    pub triangles: Vec<[u32; 3]>,
    /// Of each whether its part is closed.
    pub is_solid: Vec<bool>,
    /// Of each whether its part is closed and has an inside, as a sheet with its own back face has not: the normal of
    /// such a triangle leads out of it.
    pub leads_out: Vec<bool>,
}

/// Triangles that are joined by edges.
#[derive(Default)]
struct Piece {
    triangles: Vec<usize>,
    /// Six times what it encloses, m³, where it is closed; negative where it is turned inward.
    volume: f64,
    /// Of its triangles, m².
    area: f64,
}

impl Solids {
    /// Of a merged mesh with its triangles turned alike.
    pub(super) fn of(mesh: &TriangleMesh) -> Self {
        let mut triangles = mesh.triangles().to_vec();
        let mut is_solid = vec![false; triangles.len()];
        let mut leads_out = vec![false; triangles.len()];
        let all = pieces(mesh, 0..triangles.len(), |count| count == 2);
        let (mut closed, open): (Vec<Piece>, Vec<Piece>) =
            all.into_iter().partition(|piece| is_closed(mesh, piece));
        for piece in &closed {
            let has_inside = piece.has_inside();
            for &triangle in &piece.triangles {
                (is_solid[triangle], leads_out[triangle]) = (true, has_inside);
            }
        }
        // Boxes that share a wall, which is there once for each, are closed together. The normals of the wall lead
        // from one into the other.
        let rest = open.into_iter().flat_map(|piece| piece.triangles);
        let together = pieces(mesh, rest, |_| true).into_iter();
        for piece in together.filter(|piece| is_closed(mesh, piece) && piece.has_inside()) {
            piece.triangles.iter().for_each(|&triangle| is_solid[triangle] = true);
            closed.push(piece);
        }
        let (inward, outward): (Vec<Piece>, Vec<Piece>) =
            closed.into_iter().partition(|piece| piece.volume < 0.0);
        if !inward.is_empty() {
            let corners = outward.iter().flat_map(|piece| &piece.triangles);
            let others = Winding::new(corners.map(|&triangle| mesh.corners(triangle)).collect());
            for piece in inward.iter().filter(|piece| !is_within(mesh, piece, &others)) {
                for &triangle in &piece.triangles {
                    triangles[triangle].swap(1, 2);
                }
            }
        }
        Self { triangles, is_solid, leads_out }
    }
}

impl Piece {
    /// False for a sheet with its own back face.
    fn has_inside(&self) -> bool {
        encloses(self.volume / 6.0, self.area)
    }
}

/// Whether all vertices of a part are within others, as those of a cavity are.
fn is_within(mesh: &TriangleMesh, piece: &Piece, others: &Winding) -> bool {
    let mut vertices: Vec<u32> =
        piece.triangles.iter().flat_map(|&t| mesh.triangles()[t]).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let mut places = vertices.into_iter().map(|vertex| mesh.vertices()[vertex as usize]);
    places.all(|place| others.fast(&place, FarRadii::FINE).abs() >= INSIDE)
}

/// Whether the triangles of a part run along each edge equally often in both directions.
fn is_closed(mesh: &TriangleMesh, piece: &Piece) -> bool {
    let mut balance: HashMap<(u32, u32), i32> = HashMap::new();
    for &triangle in &piece.triangles {
        let [a, b, c] = mesh.triangles()[triangle];
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let sum = balance.entry((from.min(to), from.max(to))).or_default();
            *sum += if from < to { 1 } else { -1 };
        }
    }
    balance.values().all(|sum| *sum == 0)
}

/// Of some triangles those that are joined, by edges where so many of them are as is asked for.
fn pieces(
    mesh: &TriangleMesh,
    some: impl IntoIterator<Item = usize>,
    joins: impl Fn(usize) -> bool,
) -> Vec<Piece> {
    let mut some: Vec<usize> = some.into_iter().collect();
    some.sort_unstable();
    let mut at_edge: HashMap<(u32, u32), Vec<usize>> = HashMap::new();
    for &triangle in &some {
        let [a, b, c] = mesh.triangles()[triangle];
        for (from, to) in [(a, b), (b, c), (c, a)] {
            at_edge.entry((from.min(to), from.max(to))).or_default().push(triangle);
        }
    }
    let mut parent: Vec<usize> = (0..mesh.triangles().len()).collect();
    for triangles in at_edge.values().filter(|triangles| joins(triangles.len())) {
        for pair in triangles.windows(2) {
            let [one, other] = [pair[0], pair[1]].map(|triangle| root(&mut parent, triangle));
            parent[one.max(other)] = one.min(other);
        }
    }
    let mut pieces: BTreeMap<usize, Piece> = BTreeMap::new();
    for triangle in some {
        let name = root(&mut parent, triangle);
        let [from, ..] = mesh.corners(name);
        let [a, b, c]: [Vector3; 3] = mesh.corners(triangle).map(|corner: Point3| corner - from);
        let piece = pieces.entry(name).or_default();
        piece.triangles.push(triangle);
        piece.volume += a.dot(&b.cross(&c));
        piece.area += 0.5 * (b - a).cross(&(c - a)).norm();
    }
    pieces.into_values().collect()
}
