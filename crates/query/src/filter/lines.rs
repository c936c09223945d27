//! Lines of pixels through an image: its rows and columns, and lines aslant.

use cloudtouch_geom::{Point3, PointCloud};

use super::range::is_return_to;

#[derive(Debug, Clone, Copy)]
pub(super) struct Image<'a> {
    pub cloud: &'a PointCloud,
    /// Columns and rows.
    pub size: [usize; 2],
}

/// A line of pixels through one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    /// How many pixels are before it and after it on the line.
    before: usize,
    after: usize,
    /// How far apart two of them are in the list of all.
    apart: isize,
}

impl Image<'_> {
    /// Through a pixel, each so many columns and rows on from the one before, of which one is not zero.
    #[inline]
    pub(super) fn line(&self, index: usize, [columns, rows]: [isize; 2]) -> Line {
        let [width, height] = self.size;
        let places = [(index % width, width, columns), (index / width, height, rows)];
        // So many steps of either sign are within the image.
        let within = |sign: isize| {
            let of = |(place, count, step): (usize, usize, isize)| match sign * step {
                0 => usize::MAX,
                step if step < 0 => place / step.unsigned_abs(),
                step => (count - 1 - place) / step.unsigned_abs(),
            };
            of(places[0]).min(of(places[1]))
        };
        Line { before: within(-1), after: within(1), apart: rows * width as isize + columns }
    }

    /// The return so many pixels on along a line, if there is one.
    #[inline]
    pub(super) fn on(&self, index: usize, line: Line, places: isize) -> Option<&Point3> {
        let (most, far) =
            (if places < 0 { line.before } else { line.after }, places.unsigned_abs());
        let other = index.checked_add_signed(places * line.apart)?;
        let place = self.cloud.points.get(other).filter(|_| far <= most)?;
        is_return_to(&self.cloud.sensor_origin(), place).then_some(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whose points tell their columns and rows.
    fn image(width: usize, height: usize) -> PointCloud {
        let place = |i: usize| Point3::new((i % width) as f64, (i / width) as f64, 1.0);
        let points = (0..width * height).map(place).collect();
        PointCloud { image_size: Some((width, height)), ..PointCloud::from_points(points) }
    }

    #[test]
    fn a_line_ends_at_the_border_it_comes_to() {
        let cloud = image(7, 5);
        let image = Image { cloud: &cloud, size: [7, 5] };
        for step in [[1, 0], [0, 1], [1, 1], [1, -1], [2, 1], [-1, 3], [3, -1]] {
            for index in 0..cloud.len() {
                let line = image.line(index, step);
                let own = [(index % 7) as isize, (index / 7) as isize];
                for places in -8..=8 {
                    let [x, y] = [0, 1].map(|axis| own[axis] + places * step[axis]);
                    let is_within = (0..7).contains(&x) && (0..5).contains(&y);
                    let expected = is_within.then(|| Point3::new(x as f64, y as f64, 1.0));
                    assert_eq!(image.on(index, line, places).copied(), expected, "{step:?}");
                }
            }
        }
    }
}
