//! The parts of a run.

use anyhow::Result;
use clap::ValueEnum;

use super::{Run, Section, batch, first_query, growth, room, solvers, stream};

/// A part of a run that can be measured alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Part {
    /// Prepared queries of the piano in the room, beside the peers.
    Room,
    /// The first query of two fresh clouds.
    FirstQuery,
    /// Depth frames with a gripper.
    Stream,
    /// Leaf problems, beside other solvers.
    Solvers,
    /// Larger and larger scenes.
    Growth,
    /// Many poses on two threads.
    Batch,
}

impl Part {
    /// In the order of the document.
    pub(super) const ALL: [Self; 6] =
        [Self::Room, Self::FirstQuery, Self::Stream, Self::Solvers, Self::Growth, Self::Batch];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Room => "room",
            Self::FirstQuery => "first-query",
            Self::Stream => "stream",
            Self::Solvers => "solvers",
            Self::Growth => "growth",
            Self::Batch => "batch",
        }
    }

    pub(super) fn measure(self, run: &Run<'_>) -> Result<Section> {
        match self {
            Self::Room => room::measure(run),
            Self::FirstQuery => first_query::measure(run),
            Self::Stream => stream::measure(run),
            Self::Solvers => solvers::measure(run),
            Self::Growth => growth::measure(run),
            Self::Batch => batch::measure(run),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_named_as_the_command_line_names_them() {
        for part in Part::ALL {
            assert_eq!(Part::from_str(part.name(), false), Ok(part));
        }
        assert_eq!(Part::value_variants(), Part::ALL);
    }
}
