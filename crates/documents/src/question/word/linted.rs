//! The analysis of a word: its order, its stable and unstable steps, its cost.

use super::asked::Word;
use num_traits::Zero;
use number::{Ball, Error, Laurent, Radical, Rational, Real, Result, Sign, from_f64_exact};
use words::{
    At, Cost, Edge, Enclosed, GeneralOrder, Interval, NoGeneralOrder, Order, Piece, Shape, Stability,
};

/// The bits of what is enclosed.
pub(super) const BITS: u32 = 96;

/// The analysis of a word.
#[derive(Clone, Debug)]
pub struct Linted {
    pub word: words::Word,
    pub sums: Vec<(&'static str, Radical)>,
    pub order: Order,
    /// The orders on all problems, or why there is none.
    pub general: std::result::Result<GeneralOrder, NoGeneralOrder>,
    pub cost: Cost,
    /// Λ2/Λ1; 0 for one force. `None` where the word names forces and the stiffnesses are not given.
    pub rho: Option<Rational>,
    pub stability: Option<Stability>,
    /// The stable and unstable intervals of a word with exact flows, filters or friction: in steps h, within
    /// the range.
    pub pieces: Option<Pieces>,
    /// The range of (h² Λ1) that is asked about, rounded outwards.
    pub range: Option<(Rational, Rational)>,
    pub at: Option<At>,
}

/// The answers at all steps of a range, each end enclosed.
#[derive(Clone, Debug)]
pub struct Pieces {
    pub all: Vec<Piece>,
    /// The range of h.
    pub range: (f64, f64),
    /// √Λ1, 1 where no stiffness is given.
    pub root: Ball,
    /// Whether no step at all is unstable, by theorem ([`Shape::is_free`]).
    pub is_free: bool,
}

/// Without a range √Λ1 h is looked at up to here: two periods of the fast force.
const TURNS: f64 = 4.0 * std::f64::consts::PI;

impl Pieces {
    pub(super) fn of(question: &Word, word: &words::Word, lambda2: &Laurent) -> Result<Pieces> {
        let one = Laurent::from_integer(1);
        let lambda1 = question.lambda1.as_ref().unwrap_or(&one);
        let friction = question.friction.clone().unwrap_or_else(Laurent::zero);
        let root = lambda1.enclosure(BITS).sqrt(BITS).expect("positive");
        let (lo, hi) = match &question.h_range {
            Some((lo, hi)) => {
                (lo.enclosure(BITS).to_f64_enclosure().0.max(0.0), hi.enclosure(BITS).to_f64_enclosure().1)
            }
            None => (0.0, TURNS / root.mid_f64()),
        };
        let shape = Shape::of(word).filter(|_| question.friction.is_none());
        let all = match shape {
            None if !word.couples() => {
                let remedy = "lacks kicks or drifts, so every step is on an edge; add them";
                return Err(Error::input("word", word, remedy));
            }
            Some(shape) => shape.pieces(lambda1, lambda2, lo, hi),
            None => Enclosed::new(word, lambda1, lambda2, &friction).pieces(lo, hi).ok_or_else(|| {
                Error::input(
                    "h-range",
                    format!("{lo}..{hi}"),
                    "too many of its steps are on an edge, or too near to one: choose a shorter range",
                )
            })?,
        };
        let rho = Laurent::ratio(lambda2, lambda1);
        let is_free = shape.zip(rho).is_some_and(|(shape, rho)| shape.is_free(&rho));
        Ok(Pieces { all, range: (lo, hi), root, is_free })
    }

    /// The end of the stable steps that begin with the range at 0, in h; `None` where the next ones are
    /// stable, too, or the range ends.
    fn edge(&self) -> Option<(f64, f64)> {
        let first = self.all.first().filter(|first| first.stable && self.range.0 == 0.0)?;
        self.all.get(1).filter(|next| !next.stable).map(|_| first.upper)
    }

    /// √Λ1 h.
    fn omega_h(&self, (lo, hi): (f64, f64)) -> Ball {
        let ball = |x: f64| Ball::from_rational(&from_f64_exact(x).unwrap_or_default(), BITS);
        ball(lo).union(&ball(hi), BITS).mul(&self.root, BITS)
    }
}

/// Whether an interval meets [lo, hi].
fn meets(interval: &Interval, lo: &Rational, hi: &Rational) -> bool {
    let after = |edge: &Edge, x: &Rational| edge.compare(x) == Sign::Positive;
    interval.lower.as_ref().is_none_or(|lower| !after(lower, hi))
        && interval.upper.as_ref().is_none_or(|upper| after(upper, lo))
}

/// √s as an enclosure: h √Λ1.
pub(super) fn omega_h(edge: &Edge) -> Ball {
    edge.s().sqrt(BITS).expect("s > 0")
}

/// An enclosure, in doubles, of a number that is at least 0.
fn positive(x: &Ball) -> (f64, f64) {
    let (lo, hi) = x.to_f64_enclosure();
    (lo.max(0.0), hi)
}

/// An interval as it is shown.
pub struct Span {
    pub stable: bool,
    /// √Λ1 h at both ends.
    pub ends: [Option<Ball>; 2],
    pub h: [Option<(f64, f64)>; 2],
    /// (√Λ1 h)² where it is rational.
    pub squares: [Option<Rational>; 2],
    /// Whether the answer holds at the ends; `None` where balls cannot decide it.
    pub includes: [Option<bool>; 2],
}

impl Span {
    /// √Λ1 h at both ends, in doubles.
    pub fn enclosed(&self) -> [Option<(f64, f64)>; 2] {
        [self.ends[0].as_ref().map(positive), self.ends[1].as_ref().map(Ball::to_f64_enclosure)]
    }
}

impl Linted {
    /// The end of the stable interval that begins at 0.
    pub fn edge(&self) -> Option<&Edge> {
        self.stability.as_ref()?.first_edge()
    }

    /// √Λ1 h there.
    pub(crate) fn edge_omega_h(&self) -> Option<Ball> {
        let enclosed = || self.pieces.as_ref().and_then(|pieces| Some(pieces.omega_h(pieces.edge()?)));
        self.edge().map(omega_h).or_else(enclosed)
    }

    /// The edge when unstable intervals that are next to nothing do not count.
    pub(crate) fn nominal_edge(&self) -> Option<Ball> {
        match &self.stability {
            Some(stability) => stability.nominal_edge().map(omega_h),
            None => self.edge_omega_h(),
        }
    }

    /// Every interval that is shown.
    pub(crate) fn spans(&self, lambda1: Option<&Laurent>) -> Vec<Span> {
        let root = lambda1.map(|lambda1| lambda1.enclosure(BITS).sqrt(BITS).expect("positive"));
        let over = |x: &Option<Ball>| Some(x.as_ref()?.div(root.as_ref()?, BITS)?.to_f64_enclosure());
        let shown = |interval: &&Interval| self.range.as_ref().is_none_or(|(lo, hi)| meets(interval, lo, hi));
        let exact = |interval: &Interval| {
            let ends = [
                interval.lower.as_ref().map_or(Some(Ball::zero()), |edge| Some(omega_h(edge))),
                interval.upper.as_ref().map(omega_h),
            ];
            let square = |edge: &Option<Edge>| edge.as_ref().and_then(Edge::rational);
            Span {
                stable: interval.stable,
                h: [over(&ends[0]), over(&ends[1])],
                ends,
                squares: [square(&interval.lower), square(&interval.upper)],
                includes: interval.includes.map(Some),
            }
        };
        let enclosed = |(piece, pieces): (&Piece, &Pieces)| {
            let upper = (piece.upper.1 < pieces.range.1).then_some(piece.upper);
            Span {
                stable: piece.stable,
                ends: [Some(pieces.omega_h(piece.lower)), upper.map(|upper| pieces.omega_h(upper))],
                h: lambda1.map_or([None; 2], |_| [Some(piece.lower), upper]),
                squares: [None, None],
                includes: [None; 2],
            }
        };
        let exactly =
            self.stability.iter().flat_map(|stability| &stability.intervals).filter(shown).map(exact);
        let pieces = self.pieces.iter().flat_map(|all| all.all.iter().map(move |piece| (piece, all)));
        exactly.chain(pieces.map(enclosed)).collect()
    }

    /// ω h at the nominal edge an evaluation, gradients and solves counted as one each.
    pub(super) fn efficiency(&self) -> Option<(f64, f64)> {
        let total = Ball::from_integer(&self.cost.total().into());
        self.nominal_edge()?.div(&total, BITS).map(|ball| ball.to_f64_enclosure())
    }

    /// Evaluations per unit of ω h at the nominal edge.
    pub(super) fn per_unit(&self) -> Option<(f64, f64)> {
        let total = Ball::from_integer(&self.cost.total().into());
        total.div(&self.nominal_edge()?, BITS).map(|ball| ball.to_f64_enclosure())
    }

    /// The unit of steps: two forces have frequencies of their own.
    pub(super) fn unit(&self) -> &'static str {
        if self.word.names_forces() { "sqrt(lambda1) h" } else { "omega h" }
    }
}
