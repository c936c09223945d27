//! The settings of a build and of a traversal, with their checks.

use crate::TreeError;

/// When a node is split and how its children overlap.
///
/// The defaults are a starting point: 40 points a leaf is what the classifier likes, the others
/// follow the ranges of section 5 of the paper.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct TreeSettings {
    /// A node with more primitives than this is split (n_max); at least 1. No leaf ever exceeds it.
    pub max_leaf_points: usize,
    /// A node of at least twice this many primitives is also split when its variation is too high,
    /// so that a split for that reason leaves no fewer in either half; from 1 to `max_leaf_points`.
    pub min_leaf_points: usize,
    /// The highest variation of a leaf (σ_max), in \[0, 1/3\].
    ///
    /// The variation σ₁/(σ₁+σ₂+σ₃) takes the *smallest* eigenvalue σ₁ of the covariance of the
    /// positions: 0 when they lie on a plane, 1/3 when they spread evenly, so high means not flat.
    /// 1/3 switches this rule off.
    pub max_variation: f64,
    /// How far the boxes of two siblings reach into one another (ε), as a part of the extent of
    /// their parent along the split axis; in \[0, 0.5\], 0 to leave them as they fit, apart or not. The
    /// paper uses 1-5 %.
    pub sibling_overlap: f64,
    /// Where a node is split.
    pub split: Split,
}

/// Where along its longest axis a node is split.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Split {
    /// At the median of the positions: halves, whatever is in them.
    #[default]
    Median,
    /// Where the boxes of both parts have little surface for how many primitives are in them (the surface area
    /// heuristic), each part having at least a tenth; nodes of at most twice
    /// [`max_leaf_points`](TreeSettings::max_leaf_points) at the median. A search comes by fewer nodes.
    SurfaceArea,
}

impl Default for TreeSettings {
    fn default() -> Self {
        Self {
            max_leaf_points: 40,
            min_leaf_points: 10,
            max_variation: 0.1,
            sibling_overlap: 0.02,
            split: Split::Median,
        }
    }
}

impl TreeSettings {
    /// Checks every field.
    ///
    /// # Errors
    /// [`TreeError::Setting`] with the first field that is out of its documented range.
    pub fn validate(&self) -> Result<(), TreeError> {
        let at_least_one = "at least 1";
        in_range("max_leaf_points", self.max_leaf_points as f64, 1.0, f64::MAX, at_least_one)?;
        in_range(
            "min_leaf_points",
            self.min_leaf_points as f64,
            1.0,
            self.max_leaf_points as f64,
            "from 1 to max_leaf_points",
        )?;
        in_range("max_variation", self.max_variation, 0.0, 1.0 / 3.0, "from 0 to 1/3")?;
        in_range("sibling_overlap", self.sibling_overlap, 0.0, 0.5, "from 0 to 0.5")
    }
}

impl TreeSettings {
    /// Whether a node of so many primitives with this variation is to be split.
    pub(crate) fn asks_to_split(&self, count: usize, variation: f64) -> bool {
        count > self.max_leaf_points
            || (count / 2 >= self.min_leaf_points && variation > self.max_variation)
    }

    /// No tree over so many primitives has more nodes, where none is set apart for being far.
    pub(crate) fn most_nodes(&self, count: usize) -> usize {
        let least_leaf = self.min_leaf_points.min(self.max_leaf_points.div_ceil(2));
        2 * (count / least_leaf).max(1)
    }
}

/// Which node pairs with disjoint boxes are still descended.
///
/// Overlapping boxes always are. In all three the outcome bounds what was culled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Traversal {
    /// As printed (section 5): with probability 1 − P_cov(1) P_cov(2), however far apart they are.
    Paper,
    /// With the probability that a point leaks out of its box far enough to cross the gap.
    ///
    /// Per node `leak(δ) = (1 − P_cov) · 2Φ(−δ/σ)` with δ the gap and σ the largest standard
    /// deviation of its points along the gap; the pair is descended with probability
    /// 1 − (1 − leak₁)(1 − leak₂). At δ = 0 that is the rule of the paper; it falls off like the
    /// tail of the noise. The excess of a normal variable over a face it has passed is at most as
    /// heavy as that of a point on the face, hence 2Φ(−δ/σ); so the average chance that a point
    /// of the node crosses is at most `leak` when the gap is normal to a face, and three times
    /// that in other directions.
    GapAware,
    /// Unless the mid-plane of the gap proves that no point of either node has a probability above
    /// [`TraversalSettings::cull_deviations`]. Draws nothing.
    #[default]
    Certified,
}

/// How two trees are traversed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TraversalSettings {
    /// Which pairs with disjoint boxes are descended.
    pub kind: Traversal,
    /// [`Traversal::Certified`] culls pairs with at least so many standard deviations from the points
    /// to the middle of the gap: none of these has a higher probability than Φ(−`cull_deviations`).
    /// Zero or more; the others do not use it.
    pub cull_deviations: f64,
}

impl Default for TraversalSettings {
    fn default() -> Self {
        Self {
            kind: Traversal::default(),
            // Below one in a million.
            cull_deviations: 4.76,
        }
    }
}

impl TraversalSettings {
    /// Checks every field.
    ///
    /// # Errors
    /// [`TreeError::Setting`] with the first field that is out of its documented range.
    pub fn validate(&self) -> Result<(), TreeError> {
        in_range("cull_deviations", self.cull_deviations, 0.0, f64::INFINITY, "at least 0")
    }
}

fn in_range(
    name: &'static str,
    value: f64,
    lowest: f64,
    highest: f64,
    expected: &'static str,
) -> Result<(), TreeError> {
    if (lowest..=highest).contains(&value) {
        Ok(())
    } else {
        Err(TreeError::Setting { name, value, expected })
    }
}
