//! What cannot be a mesh.

use crate::message::number;

/// Why vertices and triangles are not a mesh.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// A vertex of a triangle has a coordinate that is NaN or infinite.
    #[error(
        "vertex {vertex} has the coordinate {}: every coordinate must be finite",
        number(*value)
    )]
    NotFinite {
        /// Which vertex, from 0.
        vertex: usize,
        /// What was found.
        value: f64,
    },
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} names vertex {index}, but there are only {vertices}")]
    MissingVertex {
        /// Which triangle, from 0.
        triangle: usize,
        /// The index it names, from 0.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// There are no triangles.
    #[error("the mesh has no triangles")]
    Empty,
}
