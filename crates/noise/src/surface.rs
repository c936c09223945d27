//! The surface near a point: a robust local fit over a neighbourhood that grows while it explains
//! the residuals.

use cloudtouch_geom::{Matrix3, UnitVector3, Vector3};

use crate::candidates::best_candidate;
use crate::patch::{Patch, Plane};
use crate::smallest_axis::smallest_axis;

/// The neighbourhood sizes that are tried.
const SIZES: [usize; 6] = [8, 12, 18, 27, 40, 60];
/// The most neighbours a fit can use.
pub(crate) const MOST_NEIGHBORS: usize = 60;
/// A plane through fewer neighbours than this explains anything.
const LEAST_NEIGHBORS: usize = 4;
/// Residuals beyond so many standard deviations weigh nothing, pass by pass.
const CUTS: [f64; 4] = [3.5, 3.5, 3.0, 3.0];
/// The cut of the weights an answer is measured with.
const FINAL_CUT: f64 = 3.0;
/// The variance of standard normal residuals weighted by Tukey factors that end at
/// [`FINAL_CUT`]: ∫ t x² φ / ∫ t φ with t = (1 − x²/9)².
const TUKEY_VARIANCE: f64 = 0.632;
/// The largest variance of the normal that still says where the surface faces: about 20°.
const MOST_TILT_VARIANCE: f64 = 0.125;

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
    /// The frame of the fit, in which `coefficients` holds.
    frame: Frame,
    /// Height above the point's tangential position: c₀ + c₁a + c₂b + c₃(a²+b²).
    coefficients: [f64; 4],
}

impl Surface {
    /// The distance of a place from the surface along the normal of the fit, and from the point
    /// across it, both relative to the point, m.
    pub(crate) fn residual_and_reach(&self, offset: &Vector3) -> (f64, f64) {
        let [a, b, z] = self.frame.coordinates(offset);
        let [c0, c1, c2, c3] = self.coefficients;
        let squared = a * a + b * b;
        (z - (c0 + c1 * a + c2 * b + c3 * squared), squared.sqrt())
    }
}

/// Fits the surface near a point.
///
/// From the best supported plane of a few, each neighbourhood size is refined by Tukey weights;
/// the size and the model (plane, or plane with mean curvature) with the least expected squared
/// error s²·leverage + 2τ² are kept, τ² being what noise does not explain of the residuals. What the
/// other sizes say about height and normal comes with it. `None` when no size determines a plane: too
/// few neighbours, or all about one line.
pub(crate) fn fit_surface(patch: &Patch) -> Option<Surface> {
    let available = patch.offsets.len();
    let mut plane = best_candidate(patch)?;
    let mut best: Option<Surface> = None;
    let mut tried = [None; SIZES.len()];
    for (trial, size) in tried.iter_mut().zip(SIZES) {
        let size = size.min(available);
        if size < LEAST_NEIGHBORS {
            break;
        }
        let nearest = patch.nearest(size);
        let cuts = if best.is_none() { &CUTS[..] } else { &CUTS[2..] };
        if let Some(refined) = cuts.iter().try_fold(plane, |p, cut| reweighted(&nearest, &p, *cut))
            && let Some(surface) = measured(&nearest, &refined)
        {
            plane = refined;
            *trial = Some(surface);
            if best.is_none_or(|b| is_better(surface.expected_error, b.expected_error)) {
                best = Some(surface);
            }
        }
        if size == available {
            break;
        }
    }
    let best = best?;
    let (disagreement, tilt) = disagreement(&best, &tried);
    Some(Surface { disagreement, tilt, ..best })
}

/// Less by more than rounding: errors that stand at the variance of the point itself differ by nothing
/// else, and a choice among them would change when the cloud is moved.
fn is_better(error: f64, than: f64) -> bool {
    error < than * (1.0 - 1e-9)
}

/// What the sizes disagree about the height beyond their own errors, m², and about the normal, as the
/// squared sine; both on average.
///
/// Next to a crease each size rounds it off differently and none of the fits notices.
fn disagreement(best: &Surface, tried: &[Option<Surface>]) -> (f64, f64) {
    let normal = best.normal.into_inner();
    let mut count = 0.0;
    let (mut apart, mut tilt) = (0.0, 0.0);
    for other in tried.iter().flatten() {
        let between = other.normal.dot(&normal) * other.height - best.height;
        apart += (between * between - other.expected_error).max(0.0);
        tilt += other.normal.cross(&normal).norm_squared();
        count += 1.0;
    }
    (apart / count, tilt / count)
}

/// One pass of Tukey weights: the plane through the neighbours weighted by how well they agree
/// with the last one.
fn reweighted(patch: &Patch, plane: &Plane, cut: f64) -> Option<Plane> {
    let mut total = 0.0;
    let mut first = Vector3::zeros();
    let [mut xx, mut xy, mut xz, mut yy, mut yz, mut zz] = [0.0; 6];
    let inverse_cut = 1.0 / (cut * cut);
    for (offset, variance) in patch.with_variances(&plane.normal) {
        let precision = 1.0 / variance;
        let residual = plane.normal.dot(offset) - plane.height;
        let weight = tukey(residual * residual * precision * inverse_cut) * precision;
        let weighted = offset * weight;
        total += weight;
        first += weighted;
        xx += weighted.x * offset.x;
        xy += weighted.x * offset.y;
        xz += weighted.x * offset.z;
        yy += weighted.y * offset.y;
        yz += weighted.y * offset.z;
        zz += weighted.z * offset.z;
    }
    let second = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let centre = first / total;
    // Nobody agreeing makes this NaN, which has no smallest axis.
    let normal = smallest_axis(&(second / total - centre * centre.transpose()))?;
    Some(Plane { normal, height: normal.dot(&centre) })
}

/// The Tukey factor of a squared residual in units of the squared cut.
fn tukey(ratio: f64) -> f64 {
    let rest = (1.0 - ratio).max(0.0);
    rest * rest
}

/// Two tangents and a normal.
#[derive(Debug, Clone, Copy)]
struct Frame {
    tangents: [Vector3; 2],
    normal: Vector3,
}

impl Frame {
    fn new(normal: Vector3) -> Self {
        // The axis least along the normal gives the best conditioned tangent.
        let axis = Vector3::ith(normal.iamin(), 1.0);
        let first = normal.cross(&axis).normalize();
        Self { tangents: [first, normal.cross(&first)], normal }
    }

    /// Two coordinates across the normal and the height along it.
    fn coordinates(&self, offset: &Vector3) -> [f64; 3] {
        [self.tangents[0].dot(offset), self.tangents[1].dot(offset), self.normal.dot(offset)]
    }
}

/// Weighted sums over the neighbours of 1, a, b, q = a²+b², z and their products.
#[derive(Debug, Default)]
struct Moments {
    /// Σw, with w relative to the point's own precision, so that leverage is in units of s².
    weight: f64,
    /// Weighted means of a, b, q and z.
    mean: [f64; 4],
    /// Weighted sums of products about these means; only the upper triangle.
    product: [[f64; 4]; 4],
    /// Σt of the Tukey factors alone, and Σt².
    agreement: f64,
    agreement_squared: f64,
}

impl Moments {
    /// Weighs the neighbours by their agreement with a surface of these coefficients.
    fn of(patch: &Patch, frame: &Frame, coefficients: &[f64; 4], cut: f64) -> Self {
        let mut m = Self::default();
        let own = patch.own_variance(&frame.normal);
        let [c0, c1, c2, c3] = coefficients;
        let inverse_cut = 1.0 / (cut * cut);
        for (offset, variance) in patch.with_variances(&frame.normal) {
            let precision = 1.0 / variance;
            let [a, b, z] = frame.coordinates(offset);
            let q = a * a + b * b;
            let residual = z - (c0 + c1 * a + c2 * b + c3 * q);
            let agreement = tukey(residual * residual * precision * inverse_cut);
            let weight = agreement * own * precision;
            m.weight += weight;
            m.agreement += agreement;
            m.agreement_squared += agreement * agreement;
            let values = [a, b, q, z];
            for r in 0..4 {
                m.mean[r] += weight * values[r];
                for c in r..4 {
                    m.product[r][c] += weight * values[r] * values[c];
                }
            }
        }
        for r in 0..4 {
            m.mean[r] /= m.weight;
        }
        for r in 0..4 {
            for c in r..4 {
                m.product[r][c] -= m.weight * m.mean[r] * m.mean[c];
            }
        }
        m
    }

    /// Regression of the height on a, b and 1, and on q after these; `s2` is the point's own
    /// variance. `None` when the neighbours do not determine a plane.
    fn regress(&self, s2: f64) -> Option<Regression> {
        let [a, b, q, z] = self.mean;
        let [[aa, ab, aq, az], [_, bb, bq, bz], [_, _, qq, qz], [_, _, _, zz]] = self.product;
        // Smallest eigenvalue of the tangential scatter: where it is no more than noise, the
        // neighbours lie about one line and any plane through it would do.
        let determinant = aa * bb - ab * ab;
        let half_trace = 0.5 * (aa + bb);
        let least = determinant / (half_trace + (half_trace.powi(2) - determinant).max(0.0).sqrt());
        let degrees = self.agreement.powi(2) / self.agreement_squared - 3.0;
        // Written so that NaN, which a patch without any weight gives, counts as undetermined.
        if !(least * MOST_TILT_VARIANCE > s2 && degrees > 0.5) {
            return None;
        }
        let solve = |on_a: f64, on_b: f64| {
            [(bb * on_a - ab * on_b) / determinant, (aa * on_b - ab * on_a) / determinant]
        };
        let slope = solve(az, bz);
        let centre = solve(a, b);
        let bend = solve(aq, bq);
        let curve_squares = qq - bend[0] * aq - bend[1] * bq;
        // Samples all at one distance cannot tell curvature from height.
        let determined = curve_squares > 1e-9 * qq;
        let curve_product = qz - bend[0] * az - bend[1] * bz;
        let curve_here = bend[0] * a + bend[1] * b - q;
        let curvature = if determined { curve_product / curve_squares } else { 0.0 };
        let flat_height = z - slope[0] * a - slope[1] * b;
        let flat_squares = (zz - slope[0] * az - slope[1] * bz).max(0.0);
        // What the residuals vary by beyond the noise, and how far that is by chance.
        let beyond = |squares: f64| squares / (TUKEY_VARIANCE * self.agreement) - s2;
        let chance = s2 * (2.0 / degrees).sqrt();
        let leverage = 1.0 / self.weight + centre[0] * a + centre[1] * b;
        let curved_squares = (flat_squares - curvature * curve_product).max(0.0);
        Some(Regression {
            flat: [flat_height, slope[0], slope[1], 0.0],
            curved: [
                flat_height + curvature * curve_here,
                slope[0] - curvature * bend[0],
                slope[1] - curvature * bend[1],
                curvature,
            ],
            flat_error: HeightError {
                leverage: s2 * leverage.min(1.0),
                bend: (curvature * curve_here).powi(2),
                beyond: beyond(flat_squares),
                chance,
            },
            curved_error: determined.then(|| HeightError {
                leverage: s2 * (leverage + curve_here.powi(2) / curve_squares).min(1.0),
                bend: 0.0,
                beyond: beyond(curved_squares),
                chance,
            }),
        })
    }
}

/// Two surfaces through the same neighbours, and what is known of the errors of their heights at the
/// point.
struct Regression {
    flat: [f64; 4],
    curved: [f64; 4],
    flat_error: HeightError,
    curved_error: Option<HeightError>,
}

/// What the error of a height is made of, m².
#[derive(Clone, Copy)]
struct HeightError {
    leverage: f64,
    bend: f64,
    /// What the residuals vary by beyond the noise; less than nothing by chance.
    beyond: f64,
    /// The standard deviation of that.
    chance: f64,
}

impl HeightError {
    /// The error to be expected, by which neighbourhoods and models are chosen.
    fn expected(&self) -> f64 {
        self.leverage + self.bend + 2.0 * (self.beyond - self.chance).max(0.0)
    }
}

/// Height and expected squared error of the surface at the point.
fn measured(patch: &Patch, plane: &Plane) -> Option<Surface> {
    let frame = Frame::new(plane.normal);
    let s2 = patch.own_variance(&plane.normal);
    let first =
        Moments::of(patch, &frame, &[plane.height, 0.0, 0.0, 0.0], FINAL_CUT).regress(s2)?;
    // Weights about the plane drop what curves away from it, so the curved surface gets its own.
    let second = Moments::of(patch, &frame, &first.curved, FINAL_CUT).regress(s2);
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
        frame,
        coefficients,
    })
}
