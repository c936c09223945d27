//! Probabilistic collision detection between noisy point clouds by robust classification.
