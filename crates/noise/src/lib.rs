//! Sensor noise, discretization and surface posteriors: a measured point in, an uncertain point out.
