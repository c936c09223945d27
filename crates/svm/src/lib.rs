//! Robust kernel classification of uncertain points: SMO on faer, a linear certificate, Clarabel as fallback.
