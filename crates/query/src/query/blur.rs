//! How blurred the samples of two bodies are: what their judge goes by.

use crate::body::BodyRef;

/// Noise over spacing, both in the median of a body, of two bodies together. One number of a pair, so that
/// it adds no jump along a path, and a cloud of which a part is denser is judged as a whole.
pub(crate) fn noise_over_spacing((a, b): (BodyRef<'_>, BodyRef<'_>)) -> f64 {
    of(a).hypot(of(b))
}

/// None of a mesh, and of what has no neighbours.
fn of(body: BodyRef<'_>) -> f64 {
    match body {
        BodyRef::Mesh(_) => 0.0,
        BodyRef::Cloud(cloud) => {
            let makeup = cloud.prepared().makeup();
            if makeup.spacing > 0.0 { makeup.std / makeup.spacing } else { 0.0 }
        }
    }
}
