//! Vectors, matrices and affine maps, row by row as V-Ray writes them.

/// Three numbers of a point, a direction or a colour.
pub type Vector = [f32; 3];

/// Three vectors as they are written: where the matrix takes the x, y and z axis.
pub type Matrix = [Vector; 3];

/// An affine map: the matrix, then the offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// Linear part of the transform.
    pub matrix: Matrix,
    /// Image of the origin, asset units.
    pub offset: [f64; 3],
}
