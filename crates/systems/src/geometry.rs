//! Where degrees of freedom are in space.

/// Points in space, what joins them, and which degree of freedom moves which.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry {
    /// In the file's unit of length.
    pub points: Vec<[f64; 3]>,
    /// The name of each point: an element's symbol, X where none is known.
    pub symbols: Vec<String>,
    /// Pairs of bonded atoms; of a mesh the nodes of each element.
    pub cells: Vec<Vec<usize>>,
    /// The point and the axis of each degree of freedom.
    pub moved: Vec<(usize, usize)>,
}
