//! How clearly a piece of one surface is on either side of the other, in standard deviations.

use crate::search::wrench::Height;

/// Between its samples a surface may be so many spacings off the straight pieces that stand for it: it
/// bends, and it ends.
const BEND_SPACINGS: f64 = 0.25;
/// No crossing is clearer than this many standard deviations.
pub(in crate::search) const CLEAREST: f64 = 6.0;

/// How well the height of an end is known, m, given its standard deviation and the spacing there.
pub(in crate::search) fn known_to(std: f64, spacing: f64) -> f64 {
    std.hypot(BEND_SPACINGS * spacing).max(f64::MIN_POSITIVE)
}

/// How clearly something known so well is at a height, in deviations.
pub(super) fn clearness(height: &Height, known: f64) -> Height {
    let Height { value, by_pose } = height;
    Height { value: value.abs() / known, by_pose: by_pose * (value.signum() / known) }
}

/// That of the less clear of two sides, each as clear as its end or the surface past that: which is asked
/// about only where it decides.
pub(super) fn less_clear(
    mut ends: [Height; 2],
    onward: impl Fn(usize) -> Option<Height>,
) -> Height {
    let first = usize::from(ends[1].value < ends[0].value);
    for k in [first, 1 - first] {
        if ends[k].value > ends[1 - k].value || ends[k].value >= CLEAREST {
            break;
        }
        if let Some(past) = onward(k).filter(|past| past.value > ends[k].value) {
            ends[k] = past;
        }
    }
    ends[usize::from(ends[1].value < ends[0].value)]
}

/// How well the height of a place past an end is known above a disc, m: what stands for the surface about a
/// sample says little of it farther away. Only where noise hides more than bends do it tells more than an
/// end; without any it tells nothing, and this is infinite.
pub(in crate::search) fn known_past_to(std: f64, spacing: f64) -> f64 {
    let known = known_to(std, spacing);
    known * (known / std).powi(2)
}

/// How clearly the surface past the end of an edge is on the side of that end.
pub(super) fn past(end: f64, height: Height, known: f64) -> Option<Height> {
    (end * height.value > 0.0).then(|| clearness(&height, known))
}
