//! Figures of the sweep.
