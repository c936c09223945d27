//! Oriented bounding box trees over uncertain points: build, refit, coverage, certified pair traversal.
