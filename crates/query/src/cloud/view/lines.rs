//! How far a panorama saw between its lines.
//!
//! Lines of a turning scanner may be far apart: on a floor that is seen aslant, decimetres. What lies between two of
//! them is taken for straight where the surface of either goes on as far as the other, as on a floor, or where both
//! meet behind, as a floor and a wall do. Between others, as a riser and the tread above it, a rim may stand out, and
//! the nearer of the two tells.

/// The returns of a line differ by less than this part of what parts lines in the mean; of some scanners those in the
/// middle are a quarter of it apart.
const ONE_LINE: f64 = 0.1;

/// A plane through two lines goes on to a third that is no farther off it than this part of what is clearly so.
const GOES_ON: f32 = 2.0 / 3.0;

/// What is known of a line in a cell: its elevation, rad, the range, m, clearly behind its farthest return, and how much
/// farther than that return this is, m.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Met {
    elevation: f32,
    behind: f32,
    clear: f32,
}

/// What two lines have between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Between {
    /// The range clearly behind it, m.
    pub behind: f64,
    /// How far apart the lines are, rad.
    pub apart: f64,
}

/// The lowest and the highest line in each cell of a raster.
#[derive(Debug)]
pub(super) struct Lines {
    cells: Vec<Option<[Met; 2]>>,
    /// How far apart lines are, rad.
    step: f64,
}

impl Lines {
    pub(super) fn new(cells: usize, step: f64) -> Self {
        Self { cells: vec![None; cells], step }
    }

    /// Takes a return into a cell.
    pub(super) fn add(&mut self, cell: usize, elevation: f64, [behind, clear]: [f64; 2]) {
        let [elevation, behind, clear] = [elevation, behind, clear].map(|value| value as f32);
        let met = Met { elevation, behind, clear };
        let Some([low, high]) = &mut self.cells[cell] else {
            self.cells[cell] = Some([met; 2]);
            return;
        };
        let is_of =
            |line: &Met| f64::from((met.elevation - line.elevation).abs()) < ONE_LINE * self.step;
        let is_low = is_of(low);
        for line in [&mut *low, &mut *high] {
            if is_of(line) && met.behind > line.behind {
                *line = Met { elevation: line.elevation, ..met };
            }
        }
        if !is_low && met.elevation < low.elevation {
            *low = met;
        }
        if met.elevation > high.elevation && !is_of(high) {
            *high = met;
        }
    }

    /// What the lines next below and above an elevation have there, in these cells, from its own on; `None` where one of
    /// the two is not in them.
    pub(super) fn between(
        &self,
        elevation: f64,
        down: impl Iterator<Item = usize>,
        up: impl Iterator<Item = usize>,
    ) -> Option<Between> {
        let at = elevation as f32;
        let met = |cell: usize| self.cells[cell].into_iter().flatten();
        let mut down = down.flat_map(|cell| met(cell).rev());
        let mut up = up.flat_map(met);
        let below = down.find(|met| met.elevation <= at)?;
        let above = up.find(|met| met.elevation > at)?;
        let line = (ONE_LINE * self.step) as f32;
        let lower = down.find(|met| met.elevation < below.elevation - line);
        let higher = up.find(|met| met.elevation > above.elevation + line);
        let apart = above.elevation - below.elevation;
        let is_straight = is_straight([lower, Some(below), Some(above), higher]);
        let behind = if is_straight {
            let part = (at - below.elevation) / apart;
            ((1.0 - part) / below.behind + part / above.behind).recip()
        } else {
            below.behind.min(above.behind)
        };
        Some(Between { behind: behind.into(), apart: apart.into() })
    }
}

/// Whether nothing stands out between the middle ones of four lines, as far as the surfaces of each with the one beyond
/// it tell.
fn is_straight([lower, below, above, higher]: [Option<Met>; 4]) -> bool {
    let beyond = |before: Option<Met>, last: Option<Met>, next: Option<Met>| {
        Some(next?.beyond(before?, last?))
    };
    let told = [beyond(lower, below, above), beyond(higher, above, below)];
    let told = || told.iter().flatten();
    let stands_out = told().any(|beyond| *beyond < -1.0);
    let goes_on = told().any(|beyond| beyond.abs() <= GOES_ON);
    let meets_behind = told().next().is_some() && told().all(|beyond| *beyond > GOES_ON);
    !stands_out && (goes_on || meets_behind)
}

impl Met {
    /// How much farther away a plane through two other lines is in its direction, in one over the range and as a part of
    /// what is clearly so.
    ///
    /// On a plane one over the range goes as a cos e + b sin e with the elevation e.
    fn beyond(&self, before: Self, last: Self) -> f32 {
        let sine = |from: Self| (self.elevation - from.elevation).sin();
        let between = (last.elevation - before.elevation).sin();
        let weights = [-sine(last) / between, sine(before) / between];
        let inverse = |met: Self| (met.behind - met.clear).recip();
        let clear = |met: Self| met.clear * inverse(met).powi(2);
        let predicted = weights[0] * inverse(before) + weights[1] * inverse(last);
        let known =
            (weights[0] * clear(before)).hypot(weights[1] * clear(last)).hypot(clear(*self));
        (inverse(*self) - predicted) / known.max(f32::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLEAR: f64 = 0.01;

    /// A cell for each line that meets something so far away.
    fn lines(elevations: &[f64], range: impl Fn(f64) -> f64) -> Lines {
        let mut lines = Lines::new(elevations.len(), 0.03);
        for (cell, &elevation) in elevations.iter().enumerate() {
            lines.add(cell, elevation, [range(elevation) + CLEAR, CLEAR]);
            // Beside it, a little lower and not as far.
            lines.add(cell, elevation - 0.001, [0.5 * range(elevation), CLEAR]);
        }
        lines
    }

    /// How far away what is before a place is told to be, by lines at these elevations and by the chord of the two next to it.
    fn told(elevations: &[f64], at: f64, range: impl Fn(f64) -> f64 + Copy) -> Option<[f64; 2]> {
        let own = elevations.iter().take_while(|&&elevation| elevation <= at).count();
        let lines = lines(elevations, range);
        let found = lines.between(at, (0..own).rev(), own..elevations.len())?;
        let [low, high] = [elevations[own - 1], elevations[own]];
        assert!((found.apart - (high - low)).abs() < 1e-6);
        let part = (at - low) / (high - low);
        let chord = ((1.0 - part) / (range(low) + CLEAR) + part / (range(high) + CLEAR)).recip();
        Some([found.behind, chord])
    }

    const EVEN: [f64; 4] = [-0.28, -0.25, -0.22, -0.19];

    fn floor(elevation: f64) -> f64 {
        1.5 / (-elevation).sin()
    }

    #[test]
    fn between_two_lines_on_a_floor_is_the_floor() {
        for at in [-0.27, -0.26, -0.245, -0.23, -0.2] {
            let [behind, chord] = told(&EVEN, at, floor).unwrap();
            assert!((behind - chord).abs() < 1e-5, "{at}: {behind} for {chord}");
            assert!((behind / floor(at) - 1.0).abs() < 0.005, "{at}: {behind}");
        }
        assert_eq!(told(&EVEN, -0.29, floor), None);
        assert_eq!(told(&EVEN, -0.18, floor), None);
        // What a scanner saw of other lines alone tells nothing between them.
        assert_eq!(lines(&EVEN, floor).between(-0.23, std::iter::empty(), 3..4), None);
    }

    #[test]
    fn between_a_floor_and_a_wall_that_meet_behind_is_what_both_let_be_there() {
        let corner = |elevation: f64| floor(elevation).min(6.5 / elevation.cos());
        let [behind, chord] = told(&EVEN, -0.23, corner).unwrap();
        assert!((behind - chord).abs() < 1e-5 && behind < corner(-0.23), "{behind} for {chord}");
    }

    /// Feet 25 mm deep in a tread read free where a line met the riser and the next one the tread.
    #[test]
    fn between_a_riser_and_its_tread_the_rim_may_stand_out() {
        let step = |elevation: f64| (6.0 / elevation.cos()).max(floor(elevation));
        let [behind, chord] = told(&EVEN, -0.23, step).unwrap();
        assert!(behind < chord - 0.1, "{behind} for {chord}");
        assert!((behind - (step(-0.25) + CLEAR)).abs() < 1e-5, "{behind}");
    }
}
