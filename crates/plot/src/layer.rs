//! The layers of a panel: lines, dots, areas, cells of a grid.

use super::palette::{Colour, INK};

/// The pattern of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dash {
    /// Unbroken.
    Solid,
    /// Round dots.
    Dotted,
    /// Dashes.
    Dashed,
    /// Dashes and dots in turn.
    DashDotted,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Stroke {
    /// Its colour.
    pub colour: Colour,
    /// Its width in points.
    pub width: f64,
    /// Its pattern.
    pub dash: Dash,
}

impl Stroke {
    /// 1.6 pt: what the eye should find first.
    pub const THICK: Stroke = Stroke { colour: INK, width: 1.6, dash: Dash::Solid };
    /// 0.8 pt, unbroken: the usual line.
    pub const LINE: Stroke = Stroke { colour: INK, width: 0.8, dash: Dash::Solid };
    /// 0.4 pt: as thin as print takes.
    pub const THIN: Stroke = Stroke { colour: INK, width: 0.4, dash: Dash::Solid };
    /// 0.6 pt in dashes.
    pub const DASHED: Stroke = Stroke { colour: INK, width: 0.6, dash: Dash::Dashed };
    /// 0.7 pt in dots.
    pub const DOTTED: Stroke = Stroke { colour: INK, width: 0.7, dash: Dash::Dotted };

    /// Changes its colour.
    pub const fn in_colour(mut self, colour: Colour) -> Self {
        self.colour = colour;
        self
    }

    /// Changes its width, in points.
    pub const fn wide(mut self, width: f64) -> Self {
        self.width = width;
        self
    }
}

/// The shape of a dot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A disc.
    Disc,
    /// An upright square.
    Square,
    /// A square on its corner.
    Diamond,
    /// A triangle pointing up.
    Triangle,
    /// A ring, the paper showing through.
    Ring,
    /// Two crossed strokes.
    Cross,
}

/// Strokes over what is filled, for those who see no colours. They run across the page, whatever the axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Hatch {
    /// From the lower left to the upper right.
    Rising,
    /// From the upper left to the lower right.
    Falling,
    /// Horizontal.
    Level,
    /// Vertical.
    Upright,
    /// Rising and falling.
    Crossed,
    /// Horizontal and vertical.
    Chequered,
    /// Rising, twice as dense.
    Dense,
}

impl Hatch {
    /// A pattern of its own for each of eight families that have no order; the first is plain.
    pub fn of_family(index: usize) -> Option<Hatch> {
        // Along rows and columns of cells run dark strokes only: light ones would make thin rows vanish.
        const CHOSEN: [Option<Hatch>; 8] = [
            None,
            Some(Hatch::Rising),
            Some(Hatch::Falling),
            Some(Hatch::Crossed),
            Some(Hatch::Upright),
            Some(Hatch::Level),
            Some(Hatch::Dense),
            Some(Hatch::Chequered),
        ];
        CHOSEN[index % CHOSEN.len()]
    }
}

/// A layer's content, in data units.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Mark {
    Lines { lines: Vec<Vec<[f64; 2]>>, stroke: Stroke, marks: Option<(Shape, f64)> },
    Dots { points: Vec<[f64; 2]>, shape: Shape, size: f64, colour: Colour },
    Area { outlines: Vec<Vec<[f64; 2]>>, colour: Colour, opacity: f64 },
    Cells(Cells),
}

/// One layer of a panel; later layers cover earlier ones.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Layer {
    pub(crate) mark: Mark,
    pub(crate) label: Option<String>,
    pub(crate) hatch: Option<Hatch>,
}

impl Layer {
    /// Polylines in one stroke; a point that is not finite breaks its line. Two points make a segment.
    pub fn lines(lines: Vec<Vec<[f64; 2]>>, stroke: Stroke) -> Self {
        Mark::Lines { lines, stroke, marks: None }.into()
    }

    /// Dots of one shape, colour and size (in points).
    pub fn dots(points: Vec<[f64; 2]>, shape: Shape, size: f64, colour: Colour) -> Self {
        Mark::Dots { points, shape, size, colour }.into()
    }

    /// Filled outlines; `opacity` from 0 to 1.
    pub fn areas(outlines: Vec<Vec<[f64; 2]>>, colour: Colour, opacity: f64) -> Self {
        Mark::Area { outlines, colour, opacity }.into()
    }

    /// The marked cells of a grid.
    pub fn cells(cells: Cells) -> Self {
        Mark::Cells(cells).into()
    }

    /// Puts a mark of so many points at each point of its lines; a layer without lines stays as it is.
    pub fn marked(mut self, shape: Shape, size: f64) -> Self {
        if let Mark::Lines { marks, .. } = &mut self.mark {
            *marks = Some((shape, size));
        }
        self
    }

    /// Draws strokes over its areas or cells, white on dark colours and dark on light ones.
    pub fn hatched(mut self, hatch: Option<Hatch>) -> Self {
        self.hatch = hatch;
        self
    }

    /// Gives it an entry in the legend.
    pub fn labelled(mut self, label: &str) -> Self {
        self.label = Some(label.into());
        self
    }
}

impl From<Mark> for Layer {
    fn from(mark: Mark) -> Self {
        Layer { mark, label: None, hatch: None }
    }
}

/// Marked cells of a regular grid, each in one of a few colours; made for hundreds of thousands of them.
///
/// Cell (i, j) is centred at (x0 + i dx, y0 + j dy). Neighbours in one row or column that are pushed one
/// after the other share a run, and a run is all that is kept. Where two colours meet, the edge is that of
/// the later one.
#[derive(Clone, Debug, PartialEq)]
pub struct Cells {
    pub(crate) origin: [f64; 2],
    pub(crate) step: [f64; 2],
    pub(crate) colours: Vec<Colour>,
    /// In points: no cell is drawn smaller, or the lonely ones would vanish in print.
    pub(crate) least: f64,
    pub(crate) runs: Vec<Run>,
}

/// `across` by `up` cells from (i, j) on; one of the two is 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    pub i: u32,
    pub j: u32,
    pub across: u32,
    pub up: u32,
    pub class: u16,
}

impl Cells {
    /// An empty grid with cell (0, 0) centred at `origin`, and the colours that cells may have.
    pub fn new(origin: [f64; 2], step: [f64; 2], colours: Vec<Colour>) -> Self {
        Cells { origin, step, colours, least: 0.35, runs: Vec::new() }
    }

    /// Draws no cell smaller than this many points.
    #[must_use]
    pub fn at_least(mut self, points: f64) -> Self {
        self.least = points;
        self
    }

    /// Marks cell (i, j) with a colour, given by its index.
    ///
    /// # Panics
    /// If there is no such colour.
    pub fn push(&mut self, i: u32, j: u32, class: u16) {
        assert!(usize::from(class) < self.colours.len(), "colour {class} of {}", self.colours.len());
        if let Some(last) = self.runs.last_mut().filter(|last| last.class == class) {
            if last.up == 1 && j == last.j && i == last.i + last.across {
                last.across += 1;
                return;
            }
            if last.across == 1 && i == last.i && j == last.j + last.up {
                last.up += 1;
                return;
            }
        }
        self.runs.push(Run { i, j, across: 1, up: 1, class });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_share_a_run_in_either_direction() {
        let mut cells = Cells::new([0.0; 2], [1.0; 2], vec![INK, INK]);
        for (i, j, class) in
            [(0, 0, 0), (1, 0, 0), (2, 0, 0), (2, 1, 0), (2, 2, 0), (2, 3, 1), (3, 3, 1), (3, 4, 1)]
        {
            cells.push(i, j, class);
        }
        let run = |i, j, across, up, class| Run { i, j, across, up, class };
        let expected = [run(0, 0, 3, 1, 0), run(2, 1, 1, 2, 0), run(2, 3, 2, 1, 1), run(3, 4, 1, 1, 1)];
        assert_eq!(cells.runs, expected);
    }
}
