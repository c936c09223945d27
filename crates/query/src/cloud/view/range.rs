//! How far the returns of a scan were kept: beyond, nothing is known, whatever was there.

use cloudtouch_geom::Point3;

use super::seen::Sight;

/// Up to where a scan without image layout tells, in the frame of its file: a depth image tells itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range {
    /// Where the sensor stood, m.
    pub sensor_origin: Point3,
    /// m; infinite where all returns were kept.
    pub most: f64,
}

impl Range {
    fn holds(&self, place: &Point3) -> bool {
        (place - self.sensor_origin).norm() <= self.most
    }
}

/// What scans know of a place in the frame of their file.
pub(in crate::cloud) fn sight(scans: &[Range], place: &Point3) -> Sight {
    if scans.iter().any(|scan| scan.holds(place)) { Sight::Seen } else { Sight::OutOfRange }
}

/// Adds one, unless another says as much; beside one that tells of any place no other is kept, however many come.
pub(in crate::cloud) fn add(scans: &mut Vec<Range>, other: Range) {
    let is_whole = |range: &Range| range.most.is_infinite();
    if scans.contains(&other) || scans.iter().any(is_whole) {
        return;
    }
    if is_whole(&other) {
        scans.clear();
    }
    scans.push(other);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scans_of_a_sensor_that_moves_are_kept_only_where_they_end() {
        let kept = |most: [f64; 4]| {
            let mut scans = Vec::new();
            for (x, most) in (0..).zip(most) {
                add(&mut scans, Range { sensor_origin: Point3::new(f64::from(x), 0.0, 0.0), most });
            }
            scans.len()
        };
        let all = f64::INFINITY;
        assert_eq!([kept([all; 4]), kept([2.0, 2.0, all, 2.0]), kept([2.0; 4])], [1, 1, 4]);
    }
}
