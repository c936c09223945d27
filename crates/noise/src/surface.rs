//! A surface fitted to the neighbours of a point, and what is known of its error.

use cloudtouch_geom::UnitVector3;

use crate::lanes::{Lanes, Machine};
use crate::patch::{Patch, Plane};
use crate::regression::{Coefficients, Frame, regress, residuals};

/// The surface near a point, in coordinates relative to it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Surface {
    /// Normal of the surface nearest the point, of either sign.
    pub(crate) normal: UnitVector3,
    /// Height of the surface above the point along the normal, m.
    pub(crate) height: f64,
    /// What noise and misfit were expected to leave of error when the neighbourhood was chosen, m².
    pub(crate) expected_error: f64,
    /// The variance that the noise of the neighbours gives that height, m².
    pub(crate) leverage: f64,
    /// The variance of a misfit that residuals may hide, m².
    pub(crate) hidden: f64,
    /// The squared difference in height of a curved surface through the same neighbours, m².
    pub(crate) bend: f64,
    /// What the noise does not explain of the variance of the residuals, m².
    pub(crate) misfit: f64,
    /// How far the heights of fits to other neighbourhoods differ beyond their errors, squared, m².
    pub(crate) disagreement: f64,
    /// The mean squared sine between the normals of these fits and this one.
    pub(crate) tilt: f64,
    /// What the residuals of a neighbourhood no smaller vary by beyond noise and chance, at most, m².
    pub(crate) suspected: f64,
    /// What neighbours beside the surface but not on it show, m²; see [`aside`].
    pub(crate) aside: f64,
    /// How many neighbours it was fitted to.
    pub(crate) size: usize,
    /// What residuals vary by beyond noise and chance, m².
    pub(crate) excess: f64,
    /// The frame of the fit, in which `coefficients` holds.
    frame: Frame,
    /// Height above the point's tangential position: c₀ + c₁a + c₂b + c₃(a²+b²).
    coefficients: Coefficients,
}

impl Surface {
    /// The squared distances of places from the surface along the normal of the fit, and from the
    /// point across it, m²; the places are relative to the point.
    #[inline(always)]
    pub(crate) fn squared_residual_and_reach<S: Machine>(
        &self,
        machine: S,
        offsets: [Lanes<S>; 3],
    ) -> [Lanes<S>; 2] {
        let coordinates = self.frame.coordinates(offsets);
        let [a, b, _] = coordinates;
        let reach = a * a + b * b;
        let residual = residuals(machine, coordinates, reach, &self.coefficients);
        [residual * residual, reach]
    }
}

/// Less by more than rounding: errors that stand at the variance of the point itself differ by nothing
/// else, and a choice among them would change when the cloud is moved.
#[inline(always)]
pub(crate) fn is_better(error: f64, than: f64) -> bool {
    error < than * (1.0 - 1e-9)
}

/// Height and expected squared error of the surface at the point.
#[inline(always)]
pub(crate) fn measured<S: Machine>(machine: S, patch: &Patch, plane: &Plane) -> Option<Surface> {
    let frame = Frame::new(plane.normal);
    let first = regress(machine, patch, &frame, &[plane.height, 0.0, 0.0, 0.0])?;
    // Weights about the plane drop what curves away from it, so the curved surface gets its own.
    let second = regress(machine, patch, &frame, &first.curved);
    let mut best = (first.flat, first.flat_error);
    if let Some(second) = second
        && let Some(error) = second.curved_error
        && is_better(error.expected(), best.1.expected())
    {
        best = (second.curved, error);
    }
    let (coefficients, error) = best;
    let [height, on_a, on_b, _] = coefficients;
    let across = frame.normal - frame.tangents[0] * on_a - frame.tangents[1] * on_b;
    let normal = UnitVector3::new_normalize(across);
    Some(Surface {
        normal,
        height: height * normal.dot(&frame.normal),
        expected_error: error.expected(),
        leverage: error.leverage,
        hidden: error.chance,
        bend: error.bend,
        misfit: error.beyond.max(0.0),
        disagreement: 0.0,
        tilt: 0.0,
        suspected: 0.0,
        aside: 0.0,
        size: patch.len(),
        excess: (error.beyond - error.chance).max(0.0),
        frame,
        coefficients,
    })
}
