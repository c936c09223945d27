//! Axes: what they are called, how far they reach, and what stands along them.

use std::ops::Range;

/// One axis.
#[derive(Debug, Clone)]
pub struct Axis {
    /// What it shows, with the unit.
    pub(super) name: String,
    /// What it shows at least; of what is drawn where it is not given.
    range: Option<Range<f64>>,
    scale: Scale,
}

/// What the numbers along an axis are.
#[derive(Debug, Clone)]
enum Scale {
    Linear,
    /// Powers of ten.
    Log,
    /// Names at 0, 1, 2 and so on.
    Names(Vec<String>),
    /// Nothing: the places along it have no value.
    Hidden,
}

impl Axis {
    fn new(name: &str, range: Option<Range<f64>>, scale: Scale) -> Self {
        Self { name: name.to_owned(), range, scale }
    }

    /// Values.
    pub fn linear(name: &str) -> Self {
        Self::new(name, None, Scale::Linear)
    }

    /// Values above 0 by their logarithm; others are left out.
    pub fn log(name: &str) -> Self {
        Self::new(name, None, Scale::Log)
    }

    /// A share or probability.
    pub fn unit(name: &str) -> Self {
        Self::linear(name).range(-0.03..1.03)
    }

    /// Names at 0, 1, 2 and so on.
    pub fn names<T: ToString>(name: &str, names: impl IntoIterator<Item = T>) -> Self {
        let names: Vec<String> = names.into_iter().map(|name| name.to_string()).collect();
        Self::new(name, Some(-0.5..names.len() as f64 - 0.5), Scale::Names(names))
    }

    /// An axis along which places have no value.
    pub fn hidden() -> Self {
        Self::new("", None, Scale::Hidden)
    }

    /// Shows these values, not as far as what is drawn reaches.
    #[must_use]
    pub fn range(self, range: Range<f64>) -> Self {
        Self { range: Some(range), ..self }
    }

    /// Where a value stands along it; not finite where it cannot be shown.
    pub(super) fn place(&self, value: f64) -> f64 {
        if let Scale::Log = self.scale { value.log10() } else { value }
    }

    /// From where to where it reaches when it has to show these values.
    pub(super) fn reach(&self, values: impl Iterator<Item = f64>) -> Range<f64> {
        if let Some(range) = &self.range {
            return self.place(range.start)..self.place(range.end);
        }
        let finite = values.map(|value| self.place(value)).filter(|place| place.is_finite());
        let (low, high) =
            finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        match high - low {
            width if width > 0.0 => low - 0.05 * width..high + 0.05 * width,
            0.0 => low - 0.5..high + 0.5,
            _ => 0.0..1.0,
        }
    }

    /// What stands at a place, of an axis that reaches so far.
    pub(super) fn label(&self, place: f64, reach: &Range<f64>) -> String {
        match &self.scale {
            Scale::Hidden => String::new(),
            Scale::Linear => rounded(place, 0.01 * (reach.end - reach.start)),
            Scale::Log => rounded(10_f64.powf(place), 0.1 * 10_f64.powf(place)),
            Scale::Names(names) => {
                let at = (place - place.round()).abs() < 1e-6 && place > -0.5;
                let name = at.then(|| names.get(place.round() as usize)).flatten();
                name.cloned().unwrap_or_default()
            }
        }
    }

    /// How many labels there may be; few decades are better than their fractions.
    pub(super) fn label_count(&self) -> usize {
        match &self.scale {
            Scale::Linear => 9,
            Scale::Log => 6,
            Scale::Names(names) => names.len() + 1,
            Scale::Hidden => 2,
        }
    }

    /// Pixels that labels beside an upright axis of this reach take.
    pub(super) fn label_width(&self) -> u32 {
        match &self.scale {
            Scale::Names(names) => names.iter().map(|n| text_width(n)).max().unwrap_or(0) + 12,
            Scale::Hidden => 8,
            _ => 44,
        }
    }

    /// Whether lines and numbers are drawn along it.
    pub(super) fn is_shown(&self) -> bool {
        !matches!(self.scale, Scale::Hidden)
    }
}

/// About how many pixels wide a text of 13 pixels height is.
pub(super) fn text_width(text: &str) -> u32 {
    (7.0 * text.chars().count() as f64).ceil() as u32
}

/// A number to within a step, without digits that say nothing.
fn rounded(value: f64, step: f64) -> String {
    let digits = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
    let text = format!("{value:.digits$}");
    let text = match text.split_once('.') {
        Some(_) => text.trim_end_matches('0').trim_end_matches('.'),
        None => &text,
    };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_say_what_stands_there() {
        let axis = Axis::log("time (ms)");
        let labels = [1e-3, 0.1, 0.32, 1.0, 3.2, 10.0, 32.0, 1e6]
            .map(|value| axis.label(axis.place(value), &(-3.0..6.0)));
        assert_eq!(labels, ["0.001", "0.1", "0.32", "1", "3.2", "10", "32", "1000000"]);
        let axis = Axis::unit("share");
        assert_eq!([-1e-17, 0.2, 0.25].map(|v| axis.label(v, &(0.0..1.0))), ["0", "0.2", "0.25"]);
        let axis = Axis::names("", ["far", "near"]);
        let labels = [-1.0, 0.0, 0.5, 1.0, 2.0].map(|v| axis.label(v, &(-0.5..1.5)));
        assert_eq!(labels, ["", "far", "", "near", ""]);
    }

    #[test]
    fn what_cannot_be_shown_does_not_widen_an_axis() {
        let reach = Axis::log("t").reach([0.0, 1.0, 100.0, f64::NAN].into_iter());
        assert_eq!(reach, -0.1..2.1);
        assert_eq!(Axis::linear("x").reach([].into_iter()), 0.0..1.0);
        assert_eq!(Axis::linear("x").reach([3.0].into_iter()), 2.5..3.5);
    }
}
