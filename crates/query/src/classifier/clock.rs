//! The time a query has.

use std::time::{Duration, Instant};

/// When a query has to answer with what it knows.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock {
    /// `None` without a limit, or where it is beyond all time.
    until: Option<Instant>,
}

impl Clock {
    pub(crate) fn new(start: Instant, limit: Option<Duration>) -> Self {
        Self { until: limit.and_then(|limit| start.checked_add(limit)) }
    }

    pub(crate) fn is_over(&self) -> bool {
        self.until.is_some_and(|until| Instant::now() >= until)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_over_when_it_has_passed_and_none_never_is() {
        let start = Instant::now();
        assert!(Clock::new(start, Some(Duration::ZERO)).is_over());
        assert!(!Clock::new(start, None).is_over());
        assert!(!Clock::new(start, Some(Duration::MAX)).is_over());
    }
}
