//! On which side of a mesh a place is.

use cloudtouch_geom::{Point3, Vector3};

use super::cells::{Cell, Cells};
use super::prepare::Mesh;
use super::winding::{FarRadii, INSIDE, OUTSIDE};

/// Sums this near to either limit are not relied on: twice their errors.
const COARSE_DOUBT: f64 = 0.1;
const FINE_DOUBT: f64 = 0.02;

/// Where a place lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    Inside,
    Outside,
    /// On the surface, in the opening of an open mesh, or at no place at all (NaN).
    Unknown,
}

impl Side {
    fn of(winding_number: f64) -> Self {
        match winding_number.abs() {
            w if w >= INSIDE => Self::Inside,
            w if w <= OUTSIDE => Self::Outside,
            _ => Self::Unknown,
        }
    }
}

impl Mesh {
    /// How often the surface wraps around a place in the local frame, to within 0.01 off the
    /// surface: a whole number for closed parts, which alone count where there are some.
    pub(crate) fn winding_number(&self, local: &Point3) -> f64 {
        self.winding.fast(local, FarRadii::FINE)
    }

    /// On which side of the mesh a place in the local frame is.
    ///
    /// Overlapping parts are inside, cavities and both sides of a sheet with a back face outside. An
    /// open mesh has sides as far as it surrounds a place: far from its opening.
    pub(crate) fn side(&self, local: &Point3) -> Side {
        match self.cell(local) {
            Some(Cell::Inside) => Side::Inside,
            Some(Cell::Outside(_)) => Side::Outside,
            Some(Cell::Crossed) | None => self.side_by_winding(local),
        }
    }

    /// What is known of the surroundings of a place; `None` where all of the mesh is open.
    pub(super) fn cell(&self, local: &Point3) -> Option<Cell> {
        let beyond = self.distance_to_box(local) > 0.0;
        self.has_solids().then(|| if beyond { Cell::Outside(0) } else { self.cells().at(local) })
    }

    /// Whether a place in the local frame is inside, told at once; no too where it takes a closer look.
    pub(crate) fn is_surely_inside(&self, local: &Point3) -> bool {
        self.cell(local) == Some(Cell::Inside)
    }

    /// The same of outside.
    pub(crate) fn is_surely_outside(&self, local: &Point3) -> bool {
        matches!(self.cell(local), Some(Cell::Outside(_)))
    }

    /// How far (m) everything around a place within the box is outside, for certain; nothing is known of
    /// an open mesh.
    pub(super) fn clear_around(&self, local: &Point3) -> f64 {
        if self.has_solids() { self.cells().clear_around(local) } else { 0.0 }
    }

    fn cells(&self) -> &Cells {
        let is_inside = |place: &Point3| self.side_by_winding(place) == Side::Inside;
        self.cells
            .get_or_init(|| Cells::new(self.winding.triangles(), self.corners_of_box(), is_inside))
    }

    fn side_by_winding(&self, local: &Point3) -> Side {
        let is_near_limit = |number: f64, doubt: f64| {
            [INSIDE, OUTSIDE].iter().any(|limit| (number.abs() - limit).abs() < doubt)
        };
        let mut number = self.winding.fast(local, FarRadii::COARSE);
        if is_near_limit(number, COARSE_DOUBT) {
            number = self.winding_number(local);
        }
        if is_near_limit(number, FINE_DOUBT) {
            number = self.winding.plain(local);
        }
        Side::of(number)
    }

    /// Distance of a place in the local frame to the box around the mesh, m; 0 within.
    pub(super) fn distance_to_box(&self, local: &Point3) -> f64 {
        let aabb = self.surface().local_aabb();
        let beyond = |p: f64, low: f64, high: f64| (low - p).max(p - high).max(0.0);
        let (low, high) = (aabb.mins, aabb.maxs);
        Vector3::new(
            beyond(local.x, low.x, high.x),
            beyond(local.y, low.y, high.y),
            beyond(local.z, low.z, high.z),
        )
        .norm()
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::TriangleMesh;
    use cloudtouch_testkit::scene;

    use super::*;

    fn shell(size: f64, center: [f64; 3], inward: bool) -> TriangleMesh {
        let [x, y, z] = center;
        let pose = cloudtouch_geom::Pose::from_translation(Vector3::new(x, y, z));
        let shell = scene::moved(&scene::cuboid([size; 3]), &pose);
        if !inward {
            return shell;
        }
        let turned = shell.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
        TriangleMesh::new(shell.vertices().to_vec(), turned).unwrap()
    }

    /// Winding number and side at a place in the file frame.
    fn at(mesh: &TriangleMesh, place: [f64; 3]) -> (f64, Side) {
        let mesh = Mesh::prepare(mesh).unwrap();
        let local = Point3::from(place) - mesh.origin();
        (mesh.winding_number(&local), mesh.side(&local))
    }

    fn assert_at(mesh: &TriangleMesh, place: [f64; 3], expected: (f64, Side)) {
        let (number, side) = at(mesh, place);
        assert!((number - expected.0).abs() < 1e-2, "{number} at {place:?}");
        assert_eq!(side, expected.1, "{number} at {place:?}");
    }

    #[test]
    fn shells_add_up_and_cavities_take_off() {
        let overlapping =
            scene::assemble([shell(1.0, [0.0; 3], false), shell(1.0, [0.4; 3], false)]);
        assert_at(&overlapping, [0.2; 3], (2.0, Side::Inside));
        assert_at(&overlapping, [-0.2; 3], (1.0, Side::Inside));
        assert_at(&overlapping, [-0.3, 0.7, 0.0], (0.0, Side::Outside));
        let hollow = scene::assemble([shell(1.0, [0.0; 3], false), shell(0.5, [0.0; 3], true)]);
        assert_at(&hollow, [0.0; 3], (0.0, Side::Outside));
        assert_at(&hollow, [0.4; 3], (1.0, Side::Inside));
        let turned = scene::assemble([shell(1.0, [0.0; 3], false), shell(0.5, [2.0; 3], true)]);
        // By itself it is no cavity.
        assert_at(&turned, [2.0; 3], (1.0, Side::Inside));
    }

    #[test]
    fn both_sides_of_a_sheet_with_a_back_face_are_outside() {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let vertices = corners.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec();
        let faces = vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
        let sheet = TriangleMesh::new(vertices, faces).unwrap();
        for z in [-1.0, -1e-6, 1e-6, 1.0] {
            assert_at(&sheet, [0.1, 0.2, z], (0.0, Side::Outside));
        }
    }

    /// A box of ten triangles: one sixth of what surrounds its middle is open.
    #[test]
    fn a_place_in_the_opening_of_an_open_mesh_is_on_no_side() {
        let whole = scene::cuboid([1.0; 3]);
        let open =
            TriangleMesh::new(whole.vertices().to_vec(), whole.triangles()[..10].to_vec()).unwrap();
        let gone = TriangleMesh::new(whole.vertices().to_vec(), whole.triangles()[10..].into());
        let outward = gone.unwrap().corners(0).map(|p| p.coords).iter().sum::<Vector3>();
        let toward: Vector3 = outward.map(|v| if v.abs() > 1.4 { v.signum() } else { 0.0 });
        let place = |share: f64| <[f64; 3]>::from(0.5 * share * toward);
        assert_at(&open, place(0.0), (5.0 / 6.0, Side::Inside));
        assert_eq!(at(&open, place(0.9)).1, Side::Unknown);
        assert_eq!(at(&open, place(1.0)).1, Side::Unknown);
        assert_eq!(at(&open, place(3.0)).1, Side::Outside);
        assert_eq!(at(&open, [f64::NAN; 3]).1, Side::Unknown);
    }
}
