//! An integrator as its author writes it: what can be said of it exactly.

use std::sync::OnceLock;

use super::asking::{Question, Work, question};
#[cfg(feature = "cli")]
use super::field::flag;
use super::field::{StepRange, notation};
use crate::error::{Error, Result};
use crate::number::rational::from_f64_exact;
use crate::number::{Ball, ExactSign, Laurent, Radical, Rational, Real, Ring, Sign};
use crate::report::decimal;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::table::{Cell, Column, Table};
use crate::word::{
    At, Cost, Edge, Enclosed, Forces, Interval, METHODS, MOST_ORDER, Method, Order, Piece, Shape, Stability,
    at, method,
};
use num_traits::Zero;

notation! {
    crate::word::Word: |_: &str, text: &str| text.parse(), ToString::to_string;
}

question! {
    /// Consistency, symmetry, order, stable steps, cost of an integrator; its verdict at one step.
    args struct Word {
        /// The integrator: kicks K, K1, K2, drifts D, midpoints C, exact flows R, friction O, n*(...), as "K(1/2) D(1) K(1/2)".
        #[arg(value_name = "WORD", value_parser = flag::<crate::word::Word>)]
        word: Option<crate::word::Word>,
        /// One of the catalogue, which --list shows.
        #[arg(long, value_name = "NAME", conflicts_with = "word")]
        method: Option<String>,
        /// The stiffness of K1, or of K where the word names no forces.
        #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
        lambda1: Option<Laurent>,
        /// The stiffness of K2; a rational multiple of lambda1.
        #[arg(long, value_name = "Y", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
        lambda2: Option<Laurent>,
        /// The step of the whole word: the verdict there.
        #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
        h: Option<Laurent>,
        /// Only intervals that meet this closed range of steps.
        #[arg(long, value_name = "LO..HI", allow_hyphen_values = true, value_parser = flag::<StepRange>)]
        h_range: Option<StepRange>,
        /// The friction of letters O, in 1/time; without it they do nothing.
        #[arg(long, value_name = "G", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
        friction: Option<Laurent>,
    }
}

question! {
    /// The catalogue: published integrators, each with its order, cost and stable steps.
    struct Methods {}
}

/// The most kicks of a word unless a budget says otherwise: roots of polynomials of this degree are isolated in some seconds.
const MOST_KICKS: u64 = 100;

/// So many letters cost as much as one power of the force.
const LETTERS: u64 = 1000;

/// The analysis of a word.
#[derive(Clone, Debug)]
pub struct Linted {
    pub word: crate::word::Word,
    pub sums: Vec<(&'static str, Radical)>,
    pub order: Order,
    pub cost: Cost,
    /// Λ2/Λ1; 0 for one force. `None` where the word names forces and the stiffnesses are not given.
    pub rho: Option<Rational>,
    pub stability: Option<Stability>,
    /// The stable and unstable intervals of a word with exact flows, filters or friction: in steps h, within the range.
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
    fn of(question: &Word, word: &crate::word::Word, lambda2: &Laurent) -> Result<Pieces> {
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
            Some(shape) => shape.pieces(lambda1, lambda2, lo, hi),
            None => Enclosed::new(word, lambda1, lambda2, &friction).pieces(lo, hi).ok_or_else(|| {
                Error::input(
                    "h_range",
                    format!("{lo}..{hi}"),
                    "there are too many intervals here: choose a shorter range",
                )
            })?,
        };
        let rho = Laurent::ratio(lambda2, lambda1);
        let is_free = shape.zip(rho).is_some_and(|(shape, rho)| shape.is_free(&rho));
        Ok(Pieces { all, range: (lo, hi), root, is_free })
    }

    /// The end of the stable steps that begin with the range at 0, in h; `None` where the next ones are stable, too, or the range ends.
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

impl Word {
    /// Whether balls answer: the product of the letters is no polynomial.
    fn is_enclosed(&self, word: &crate::word::Word) -> bool {
        !word.is_algebraic() || self.friction.is_some()
    }

    /// Refuses friction without a letter O, and exact flows of repulsive forces.
    fn check(&self, word: &crate::word::Word) -> Result<()> {
        if let Some(friction) = &self.friction {
            if friction.sign() != Sign::Positive {
                return Err(Error::input(
                    "friction",
                    friction,
                    "the friction must be positive; or leave it out",
                ));
            }
            if !word.has_friction() {
                return Err(Error::input(
                    "friction",
                    friction,
                    "the word has no letter O, so nothing feels it",
                ));
            }
            if self.lambda1.is_none() {
                return Err(Error::missing("lambda1", "friction needs a scale of time: give the stiffness"));
            }
        }
        match &self.lambda2 {
            Some(lambda2) if word.turns_second() && lambda2.sign() != Sign::Positive => {
                Err(Error::input("lambda2", lambda2, "the exact flow R2 or R is of a positive stiffness"))
            }
            Some(lambda2) if !word.is_algebraic() && lambda2.sign() == Sign::Zero => {
                Err(Error::input("lambda2", lambda2, "give a stiffness that is not 0"))
            }
            _ => Ok(()),
        }
    }

    /// The word that is asked about.
    ///
    /// # Errors
    /// None or two of a word and a method.
    pub fn word(&self) -> Result<crate::word::Word> {
        match (&self.word, &self.method) {
            (Some(word), None) => Ok(word.clone()),
            (None, Some(name)) => Ok(method(name)?.word()),
            (None, None) => Err(Error::missing(
                "word",
                "write a word such as \"K(1/2) D(1) K(1/2)\", or --method NAME; --list shows names",
            )),
            (Some(word), Some(_)) => Err(Error::input("word", word, "give a word or a method, not both")),
        }
    }

    /// Λ2/Λ1, where the word's forces are known.
    fn ratio(&self, word: &crate::word::Word) -> Result<Option<Rational>> {
        if let Some(lambda1) = self.lambda1.as_ref().filter(|lambda1| lambda1.sign() != Sign::Positive) {
            return Err(Error::input("lambda1", lambda1, "the stiffness must be positive"));
        }
        match (&self.lambda1, &self.lambda2, word.names_forces()) {
            (_, Some(lambda2), false) => Err(Error::input(
                "lambda2",
                lambda2,
                "the word names no second force: write K1 and K2, or leave it out",
            )),
            (_, None, false) => Ok(Some(Rational::zero())),
            (Some(lambda1), Some(lambda2), true) => match Laurent::ratio(lambda2, lambda1) {
                Some(rho) => Ok(Some(rho)),
                None => Err(Error::input(
                    "lambda2",
                    lambda2,
                    "choose a rational multiple of lambda1: the word's entries are polynomials over Q then",
                )),
            },
            (None, None, true) => Ok(None),
            (None, ..) => Err(Error::missing("lambda1", "the word names two forces: give both stiffnesses")),
            (_, None, _) => {
                Err(Error::missing("lambda2", "the word names two forces: give both stiffnesses"))
            }
        }
    }

    /// h² Λ1, for a step that is given.
    fn s(&self, h: &Laurent, field: &str) -> Result<Laurent> {
        let lambda1 =
            self.lambda1.as_ref().ok_or_else(|| Error::missing("lambda1", "a step needs the stiffness"))?;
        if h.sign() != Sign::Positive {
            return Err(Error::input(field, h, "a step must be positive"));
        }
        Ok(Laurent::product(&Laurent::product(h, h), lambda1))
    }
}

/// Refuses what costs more than the budget allows.
fn affordable(word: &crate::word::Word, work: &Work) -> Result<()> {
    let (needed, most) = (word.degree().max(word.len() / LETTERS), work.budget.unwrap_or(MOST_KICKS));
    if needed > most {
        let cost = format!("the entries of this word are polynomials of degree {needed}");
        return Err(Error::budget(cost, needed).or(format!("write a word of {most} kicks at most")));
    }
    Ok(())
}

impl Question for Word {
    const NAME: &'static str = "word";
    const EXAMPLES: &'static [&'static str] = &[
        "word \"K(1/6) D(1/2) K(2/3, -1/36) D(1/2) K(1/6)\"",
        "word --method pefrl",
        "word --method respa-4 --lambda1 pi^2 --lambda2 pi^2/25 --h 1 --h-range 0..3",
        "word --list",
    ];
    type Answer = Linted;

    fn answer(&self, work: &Work) -> Result<Linted> {
        let word = self.word()?;
        affordable(&word, work)?;
        self.check(&word)?;
        let rho = self.ratio(&word)?;
        let range = self.h_range.as_ref().map(|(lo, hi)| {
            let lo = if lo.sign() == Sign::Zero { Ok(Laurent::zero()) } else { self.s(lo, "h_range") };
            Ok::<_, Error>((lo?, self.s(hi, "h_range")?))
        });
        let range =
            range.transpose()?.map(|(lo, hi)| (lo.enclosure(BITS).lower(), hi.enclosure(BITS).upper()));
        let s = self.h.as_ref().map(|h| self.s(h, "h")).transpose()?;
        let (mut stability, mut pieces, mut found) = (None, None, None);
        if rho.is_some() && self.is_enclosed(&word) {
            let lambda2 = self.lambda2.clone().unwrap_or_else(Laurent::zero);
            pieces = Some(Pieces::of(self, &word, &lambda2)?);
            if let (Some(h), Some(lambda1)) = (&self.h, &self.lambda1) {
                let friction = self.friction.clone().unwrap_or_else(Laurent::zero);
                let at = Enclosed::new(&word, lambda1, &lambda2, &friction).at(h);
                found = Some(at.ok_or_else(|| Error::input("h", h, "a filter has a pole at this step"))?);
            }
        } else if let Some(rho) = &rho {
            let product = word.polynomials(&Forces::ratio(rho));
            stability = Some(Stability::of(&product));
            let pole = |h: &Laurent| {
                Error::input("h", h, "a midpoint has no solution at this step: its force is negative")
            };
            found = match (&s, &self.h) {
                (Some(s), Some(h)) => Some(at(&product, s).ok_or_else(|| pole(h))?),
                _ => None,
            };
        } else if s.is_some() || range.is_some() {
            return Err(Error::missing("lambda1", "the word names two forces: give both stiffnesses"));
        }
        let order = word.order();
        let (sums, cost) = (word.sums(), word.cost());
        Ok(Linted { word, sums, order, cost, rho, stability, pieces, range, at: found })
    }

    fn show(&self, answer: &Linted) -> Document {
        let rows = answer.rows(self.lambda1.as_ref());
        let document = record(self).document(Document::new(Self::NAME), answer);
        let mut columns = vec!["stable", "lower", "upper"];
        columns.extend(self.lambda1.iter().flat_map(|_| ["h_lower", "h_upper"]));
        let people = chosen(&rows, &columns);
        document.rows(rows).for_people(people).summary(&answer.lines(self))
    }

    fn command(&self) -> String {
        let words = self.word.iter().map(|word| format!(" \"{word}\""));
        let rest = super::Fields::input(self).into_iter().filter(|(key, _)| *key != "word");
        let flags = rest.map(|(key, value)| {
            let value = value.as_str().unwrap_or_default().to_string();
            format!(" --{} {}", key.replace('_', "-"), crate::report::text::quoted(&value))
        });
        format!("kickdrift word{}", words.chain(flags).collect::<String>())
    }
}

/// The bits of what is enclosed.
const BITS: u32 = 96;

/// Whether an interval meets [lo, hi].
fn meets(own: &Interval, lo: &Rational, hi: &Rational) -> bool {
    let after = |edge: &Edge, x: &Rational| edge.compare(x) == Sign::Positive;
    own.lower.as_ref().is_none_or(|lower| !after(lower, hi))
        && own.upper.as_ref().is_none_or(|upper| after(upper, lo))
}

/// √s as an enclosure: h √Λ1.
fn omega_h(edge: &Edge) -> Ball {
    edge.s().sqrt(BITS).expect("s > 0")
}

/// An enclosure, in doubles, of a number that is at least 0.
fn positive(x: &Ball) -> (f64, f64) {
    let (lo, hi) = x.to_f64_enclosure();
    (lo.max(0.0), hi)
}

/// An interval as it is shown.
struct Span {
    stable: bool,
    /// √Λ1 h at both ends.
    ends: [Option<Ball>; 2],
    h: [Option<(f64, f64)>; 2],
    /// (√Λ1 h)² where it is rational.
    squares: [Option<Rational>; 2],
    /// Whether the answer holds at the ends; `None` where balls cannot decide it.
    includes: [Option<bool>; 2],
}

impl Linted {
    /// The end of the stable interval that begins at 0.
    pub fn edge(&self) -> Option<&Edge> {
        self.stability.as_ref()?.first_edge()
    }

    /// √Λ1 h there.
    fn edge_omega_h(&self) -> Option<Ball> {
        let enclosed = || self.pieces.as_ref().and_then(|own| Some(own.omega_h(own.edge()?)));
        self.edge().map(omega_h).or_else(enclosed)
    }

    /// The edge when unstable intervals that are next to nothing do not count.
    fn nominal_edge(&self) -> Option<Ball> {
        match &self.stability {
            Some(stability) => stability.nominal_edge().map(omega_h),
            None => self.edge_omega_h(),
        }
    }

    /// Every interval that is shown.
    fn spans(&self, lambda1: Option<&Laurent>) -> Vec<Span> {
        let root = lambda1.map(|lambda1| lambda1.enclosure(BITS).sqrt(BITS).expect("positive"));
        let over = |x: &Option<Ball>| Some(x.as_ref()?.div(root.as_ref()?, BITS)?.to_f64_enclosure());
        let shown = |own: &&Interval| self.range.as_ref().is_none_or(|(lo, hi)| meets(own, lo, hi));
        let exact = |own: &Interval| {
            let ends = [
                own.lower.as_ref().map_or(Some(Ball::zero()), |edge| Some(omega_h(edge))),
                own.upper.as_ref().map(omega_h),
            ];
            let square = |edge: &Option<Edge>| edge.as_ref().and_then(Edge::rational);
            Span {
                stable: own.stable,
                h: [over(&ends[0]), over(&ends[1])],
                ends,
                squares: [square(&own.lower), square(&own.upper)],
                includes: own.includes.map(Some),
            }
        };
        let enclosed = |(own, pieces): (&Piece, &Pieces)| {
            let upper = (own.upper.1 < pieces.range.1).then_some(own.upper);
            Span {
                stable: own.stable,
                ends: [Some(pieces.omega_h(own.lower)), upper.map(|own| pieces.omega_h(own))],
                h: lambda1.map_or([None; 2], |_| [Some(own.lower), upper]),
                squares: [None, None],
                includes: [None; 2],
            }
        };
        let exactly = self.stability.iter().flat_map(|own| &own.intervals).filter(shown).map(exact);
        let pieces = self.pieces.iter().flat_map(|all| all.all.iter().map(move |own| (own, all)));
        exactly.chain(pieces.map(enclosed)).collect()
    }

    /// ω h at the nominal edge an evaluation, gradients and solves counted as one each.
    fn efficiency(&self) -> Option<(f64, f64)> {
        let total = Ball::from_integer(&self.cost.total().into());
        self.nominal_edge()?.div(&total, BITS).map(|own| own.to_f64_enclosure())
    }

    /// Evaluations per unit of ω h at the nominal edge.
    fn per_unit(&self) -> Option<(f64, f64)> {
        let total = Ball::from_integer(&self.cost.total().into());
        total.div(&self.nominal_edge()?, BITS).map(|own| own.to_f64_enclosure())
    }

    /// The unit of steps: two forces have frequencies of their own.
    fn unit(&self) -> &'static str {
        if self.word.names_forces() { "sqrt(lambda1) h" } else { "omega h" }
    }

    /// Every interval with one answer.
    fn rows(&self, lambda1: Option<&Laurent>) -> Table {
        type Of<'a> = &'a Span;
        let exact = |square: &Option<Rational>| square.as_ref().map_or(Cell::Missing, Cell::exact);
        let record = Record::new()
            .field(Column::new("stable").left(), |of: Of| of.stable.into())
            .field(
                Column::new("lower")
                    .titled(
                        &format!("{} from", self.unit()),
                        if self.word.names_forces() {
                            "$\\sqrt{\\Lambda_1}\\,h$ from"
                        } else {
                            "$\\omega h$ from"
                        },
                    )
                    .enclosure(),
                |of| of.ends[0].as_ref().map(positive).into(),
            )
            .field(Column::new("upper").titled("to", "to").enclosure(), |of| {
                of.ends[1].as_ref().map(Ball::to_f64_enclosure).into()
            })
            .field(Column::new("lower_s").in_words("lower (omega h)^2 exactly").aside(), move |of| {
                exact(&of.squares[0])
            })
            .field(Column::new("upper_s").in_words("upper (omega h)^2 exactly").aside(), move |of| {
                exact(&of.squares[1])
            })
            .field(Column::new("lower_included").in_words("with lower end").aside(), |of| {
                of.includes[0].into()
            })
            .field(Column::new("upper_included").in_words("with upper end").aside(), |of| {
                of.includes[1].into()
            })
            .field(Column::new("h_lower").titled("h from", "$h$ from").enclosure(), |of| of.h[0].into())
            .field(Column::new("h_upper").titled("h to", "$h$ to").enclosure(), |of| of.h[1].into());
        record.table("intervals", "Stable and unstable steps of the word", &self.spans(lambda1))
    }

    /// For people.
    fn lines(&self, question: &Word) -> Vec<String> {
        let mut lines = vec![self.word.to_string()];
        let unit = self.unit();
        let mut line = |name: &str, text: String| lines.push(format!("  {name:<12} {text}"));
        let sums: Vec<String> =
            self.sums.iter().map(|(name, sum)| format!("{name} {}", shown(sum))).collect();
        let consistent = if self.word.is_consistent() { "yes" } else { "no" };
        line("consistent", format!("{consistent}: the coefficients sum to {}", sums.join(", ")));
        line(
            "palindrome",
            match self.word.asymmetry() {
                None => "yes".into(),
                Some(place) => {
                    format!(
                        "no: letter {} is {}, its mirror image {}",
                        place.letter, place.there, place.mirrored
                    )
                }
            },
        );
        let rounded = if self.order.nominal > self.order.order {
            format!("; {} but for errors below 1e-9, as rounded coefficients have them", self.order.nominal)
        } else {
            String::new()
        };
        let least =
            if self.order.order >= MOST_ORDER && !self.word.is_algebraic() { "at least " } else { "" };
        let friction = if self.word.has_friction() { ", friction aside" } else { "" };
        line("order", format!("{least}{} on oscillators{friction}{rounded}", self.order.order));
        for (name, term) in [("frequency", &self.order.frequency), ("impedance", &self.order.impedance)] {
            if let Some((k, c)) = term {
                let text = shown(c);
                let term =
                    text.strip_prefix('-').map_or_else(|| format!("+ {text}"), |rest| format!("- {rest}"));
                let sum = text.contains(' ');
                line(
                    name,
                    format!(
                        "omega (1 {} (omega h)^{k} + ...)",
                        if sum { format!("+ ({text})") } else { term }
                    ),
                );
            }
        }
        if let Some(stability) = &self.stability {
            line(
                "stable",
                match (stability.first_edge(), stability.begins_stable()) {
                    (Some(edge), _) => {
                        let exact = edge.rational().map_or(String::new(), |s| format!(" = sqrt({s})"));
                        let end = if edge.coexistence { "<=" } else { "<" };
                        let ends = omega_h(edge).to_f64_enclosure();
                        let nominal =
                            self.nominal_edge().map(|own| own.to_f64_enclosure()).filter(|own| *own != ends);
                        let nominal = nominal.map_or(String::new(), |own| {
                        format!("; {} but for unstable intervals below 1e-9, as rounded coefficients open them", enclosed(own))
                    });
                        format!("0 < {unit} {end} {}{exact}{nominal}", enclosed(ends))
                    }
                    (None, true) => "at every step".into(),
                    (None, false) => "not at small steps".into(),
                },
            );
        }
        if let Some(pieces) = &self.pieces {
            let upto = format!("looked at up to h = {}", decimal::enclosure(pieces.range.1, pieces.range.1));
            let upto = if question.lambda1.is_some() { upto } else { upto.replace(" h ", " omega h ") };
            let begins = pieces.all.first().is_some_and(|first| first.stable);
            line(
                "stable",
                match (self.edge_omega_h().filter(|_| begins), pieces.is_free) {
                    (_, true) => "at every step, by theorem: no resonance".into(),
                    (Some(edge), _) => format!("0 < {unit} < {}; {upto}", enclosed(edge.to_f64_enclosure())),
                    _ => format!("see the intervals; {upto}"),
                },
            );
        }
        if self.word.has_friction() {
            line(
                "friction",
                match &question.friction {
                    Some(friction) => format!("{friction}: stable steps draw every start to 0, noise aside"),
                    None => "not given: O does nothing, and the results are of the word without it".into(),
                },
            );
        }
        let cost = self.cost;
        let counts = match (self.word.names_forces(), cost.evaluations) {
            (false, [all, _]) => counted(all, "evaluation"),
            (true, [fast, slow]) => format!("{} of force 1, {slow} of force 2", counted(fast, "evaluation")),
        };
        let more = [(cost.gradients, "gradient"), (cost.solves, "linear solve"), (cost.flows, "exact flow")];
        let more: String =
            more.iter().filter(|(n, _)| *n > 0).map(|(n, of)| format!(", {}", counted(*n, of))).collect();
        line("cost", format!("{counts}{more} a step"));
        if let Some((most, least)) = self.efficiency().zip(self.per_unit()) {
            let text = format!(
                "{unit} = {} for each of them at most, {} of them per unit",
                enclosed(most),
                enclosed(least)
            );
            line("efficiency", text);
        }
        if let (Some(found), Some(h)) = (&self.at, &question.h) {
            let stable = match (found.kind, found.is_stable()) {
                ("edge", _) => "on an edge or nearer to one than balls can decide",
                (_, true) => "stable",
                (_, false) => "unstable",
            };
            line(
                "verdict",
                format!(
                    "{stable} at h = {h}: {}, trace {}",
                    found.kind,
                    enclosed(found.trace.to_f64_enclosure())
                ),
            );
            if let Some(rate) = rate(&found.ln_multiplier, h) {
                line("growth rate", format!("{} per unit time", enclosed(rate)));
            }
            if let Some(omega) = rate(&found.angle, h) {
                line("frequency", format!("{} at this step", enclosed(omega)));
            }
            if let Some(z) = rate(&found.impedance, h) {
                line("impedance", format!("{} at this step", enclosed(z)));
            }
        }
        lines
    }
}

/// `1 evaluation`, `2 evaluations`.
fn counted(n: u64, of: &str) -> String {
    format!("{n} {of}{}", if n == 1 { "" } else { "s" })
}

/// x/h as an enclosure.
fn rate(x: &Option<Ball>, h: &Laurent) -> Option<(f64, f64)> {
    Some(x.as_ref()?.div(&h.enclosure(BITS), BITS)?.to_f64_enclosure())
}

/// An enclosure as the digits that are certain.
fn enclosed((lo, hi): (f64, f64)) -> String {
    decimal::enclosure(lo, hi).to_string()
}

/// Some columns of a table, for people.
fn chosen(table: &Table, columns: &[&str]) -> Table {
    let columns: Vec<String> = columns.iter().map(ToString::to_string).collect();
    table.choose(&columns).expect("columns of the table")
}

/// An exact number where it is short, else its first digits.
fn shown(x: &Radical) -> String {
    const SHORT: usize = 24;
    let text = x.text(ToString::to_string);
    if text.len() <= SHORT { text } else { format!("{:.6e}", x.enclosure(64).mid_f64()) }
}

/// The entries of a word's document.
fn record(question: &Word) -> Record<'_, Linted> {
    type Of<'a> = &'a Linted;
    let text = |x: &Radical| Cell::Text(x.text(ToString::to_string));
    let in_rho = |f: &crate::number::Polynomial<Radical>| {
        let term = |(k, c): (usize, &Radical)| match k {
            0 => c.text(ToString::to_string),
            k => format!("({})*rho^{k}", c.text(ToString::to_string)),
        };
        let terms = f.coefficients().iter().enumerate().filter(|(_, c)| !c.is_zero()).map(term);
        let terms: Vec<String> = terms.collect();
        Cell::Text(if terms.is_empty() { "0".into() } else { terms.join(" + ") })
    };
    let term = |of: &Option<(u64, Radical)>, power: bool| match of {
        None => Cell::Missing,
        Some((k, _)) if power => (*k).into(),
        Some((_, c)) => Cell::Text(c.text(ToString::to_string)),
    };
    let sum = move |of: Of, name: &str| {
        of.sums.iter().find(|(own, _)| *own == name).map_or(Cell::Missing, |(_, sum)| text(sum))
    };
    let at = |of: Of, which: fn(&At) -> &Option<Ball>| -> Cell {
        of.at.as_ref().zip(question.h.as_ref()).and_then(|(found, h)| rate(which(found), h)).into()
    };
    let mut record = Record::new()
        .json("word", |of: Of| Cell::exact(&of.word))
        .json("consistent", |of| of.word.is_consistent().into());
    for name in ["D", "K", "K1", "K2", "O"] {
        record = record.json(format!("sums.{name}"), move |of| sum(of, name));
    }
    record = record
        .json("palindrome", |of| of.word.asymmetry().is_none().into())
        .json("differs.letter", |of| of.word.asymmetry().map(|place| place.letter as u64).into())
        .json("differs.there", |of| {
            of.word.asymmetry().map_or(Cell::Missing, |place| Cell::Text(place.there))
        })
        .json("differs.mirrored", |of| {
            of.word.asymmetry().map_or(Cell::Missing, |place| Cell::Text(place.mirrored))
        })
        .json("order", |of| of.order.order.into())
        .json("nominal_order", |of| of.order.nominal.into());
    for (i, name) in ["A", "B", "C", "D"].into_iter().enumerate() {
        record = record.json(format!("error.{name}"), move |of| in_rho(&of.order.error[i]));
    }
    record
        .json("frequency.power", move |of| term(&of.order.frequency, true))
        .json("frequency.coefficient", move |of| term(&of.order.frequency, false))
        .json("impedance.power", move |of| term(&of.order.impedance, true))
        .json("impedance.coefficient", move |of| term(&of.order.impedance, false))
        .json("edge.omega_h", |of| of.edge_omega_h().map(|edge| edge.to_f64_enclosure()).into())
        .json("edge.s", |of| {
            of.edge_omega_h()
                .map(|edge| of.edge().map_or_else(|| edge.square(BITS), Edge::s).to_f64_enclosure())
                .into()
        })
        .json("edge.exact", |of| of.edge().and_then(Edge::rational).map_or(Cell::Missing, Cell::exact))
        .json("edge.side", |of| of.edge().map(|edge| i64::from(edge.side)).into())
        .json("edge.polynomial", |of| of.edge().map_or(Cell::Missing, |edge| Cell::Text(polynomial(edge))))
        .json("free", |of| of.pieces.as_ref().map(|own| own.is_free).into())
        .json("nominal_edge", |of| of.nominal_edge().map(|own| own.to_f64_enclosure()).into())
        .json("evaluations.first", |of| of.cost.evaluations[0].into())
        .json("evaluations.second", |of| of.cost.evaluations[1].into())
        .json("evaluations.gradients", |of| of.cost.gradients.into())
        .json("evaluations.solves", |of| of.cost.solves.into())
        .json("evaluations.flows", |of| of.cost.flows.into())
        .json("per_unit", |of| of.per_unit().into())
        .json("efficiency", |of| of.efficiency().into())
        .json("verdict.kind", |of| of.at.as_ref().map(|found| found.kind).into())
        .json("verdict.stable", |of| {
            of.at.as_ref().filter(|own| own.kind != "edge").map(At::is_stable).into()
        })
        .json("verdict.side", |of| of.at.as_ref().map(|found| i64::from(found.side)).into())
        .json("verdict.trace", |of| of.at.as_ref().map(|found| found.trace.to_f64_enclosure()).into())
        .json("verdict.growth_rate", move |of| at(of, |found| &found.ln_multiplier))
        .json("verdict.frequency", move |of| at(of, |found| &found.angle))
        .json("verdict.impedance", move |of| at(of, |found| &found.impedance))
}

/// The polynomial of an edge, its coefficients exact.
fn polynomial(edge: &Edge) -> String {
    if let Some(f) = edge.polynomial.rational() {
        return f.primitive().text(&["s"]);
    }
    let term = |(k, c): (usize, &Radical)| format!("({})*s^{k}", c.text(ToString::to_string));
    let terms = edge.polynomial.coefficients().iter().enumerate().filter(|(_, c)| !c.is_zero()).map(term);
    terms.collect::<Vec<_>>().join(" + ")
}

impl Question for Methods {
    const NAME: &'static str = "methods";
    type Answer = &'static [Listed];

    fn answer(&self, work: &Work) -> Result<Self::Answer> {
        // It is the same whenever it is asked for.
        static KNOWN: OnceLock<Vec<Listed>> = OnceLock::new();
        if let Some(known) = KNOWN.get() {
            return Ok(known);
        }
        let lint = |method: &'static Method| {
            let none = Word {
                word: None,
                method: Some(method.name.into()),
                lambda1: None,
                lambda2: None,
                h: None,
                h_range: None,
                friction: None,
            };
            let linted = none.answer(work)?;
            let two = || Word {
                lambda1: Some(16.into()),
                lambda2: Some(1.into()),
                h_range: Some(slow_range()),
                ..none
            };
            let two = if linted.word.names_forces() { Some(two().answer(work)?) } else { None };
            Ok(Listed { method, linted, two })
        };
        let all = METHODS.iter().map(lint).collect::<Result<Vec<_>>>()?;
        Ok(KNOWN.get_or_init(|| all))
    }

    fn show(&self, all: &Self::Answer) -> Document {
        type Of<'a> = &'a Listed;
        let exact = |of: Of| of.linted.edge().and_then(Edge::rational).map_or(Cell::Missing, Cell::exact);
        let of = |edge: Option<Ball>| -> Cell { edge.map(|own| own.to_f64_enclosure()).into() };
        let engines = |of: Of| match of.method.engines {
            [] => Cell::Missing,
            all => Cell::Text(all.join("; ")),
        };
        let table = Record::new()
            .field(Column::new("name").left(), |of: Of| of.method.name.into())
            .field(Column::new("order"), |of| of.linted.order.nominal.into())
            .field(Column::new("evaluations").in_words("cost"), |of| of.linted.cost.total().into())
            .field(Column::new("palindrome").left(), |of| of.linted.word.asymmetry().is_none().into())
            .field(Column::new("edge").titled("omega h below", "$\\omega h$ below").enclosure(), move |own| {
                of(own.linted.edge_omega_h())
            })
            .field(Column::new("nominal_edge").in_words("nominally").enclosure(), move |own| {
                of(own.linted.nominal_edge())
            })
            .field(Column::new("edge_s").in_words("(omega h)^2").aside(), exact)
            .field(Column::new("efficiency").enclosure(), |of| of.linted.efficiency().into())
            .field(
                Column::new("coupled_edge").titled("omega1 h below", "$\\omega_1 h$ below").enclosure(),
                move |own| of(own.two.as_ref().and_then(Linted::edge_omega_h)),
            )
            .field(Column::new("free").titled("free", "free").left(), |of| of.is_free().into())
            .field(Column::new("engines").left(), engines)
            .field(Column::new("word").left().aside(), |of| Cell::exact(&of.linted.word))
            .field(Column::new("source").left().aside(), |of| of.method.source.into())
            .table(
                "methods",
                "Published integrators: order on oscillators, cost a step, stable steps, efficiency, engines",
                all.iter(),
            );
        let lines = [
            format!("{} integrators; kickdrift word --method NAME shows one in full", all.len()),
            "two forces: omega1 h below which they are stable at lambda2/lambda1 = 1/16 (periods 1:4)".into(),
            "free: no unstable step there before the slow force's own limit omega2 h = 2".into(),
        ];
        let people = chosen(
            &table,
            &[
                "name",
                "order",
                "evaluations",
                "palindrome",
                "edge",
                "nominal_edge",
                "efficiency",
                "coupled_edge",
                "free",
                "engines",
            ],
        );
        Document::new(Self::NAME).rows(table).for_people(people).summary(&lines)
    }
}

/// An entry of the catalogue.
#[derive(Clone, Debug)]
pub struct Listed {
    pub method: &'static Method,
    pub linted: Linted,
    /// The answer for Λ1 = 16, Λ2 = 1, where the word names forces.
    pub two: Option<Linted>,
}

/// Steps up to √Λ2 h = 2, at which the slow force alone has its edge: √Λ1 h = 8.
fn slow_range() -> StepRange {
    (Laurent::zero(), Laurent::from_integer(2))
}

impl Listed {
    /// Whether no step below √Λ2 h = 2 is unstable at Λ2/Λ1 = 1/16: that is free of resonance. `None` for one force, and where edges that touch are
    /// not separated.
    pub fn is_free(&self) -> Option<bool> {
        let two = self.two.as_ref()?;
        let limit = Rational::from_integer(64.into());
        match (&two.stability, &two.pieces) {
            (Some(own), _) => Some(match own.first_edge() {
                Some(edge) => edge.compare(&limit) != Sign::Negative,
                None => own.begins_stable(),
            }),
            (_, Some(own)) if own.is_free => Some(true),
            (_, Some(own)) if own.all.iter().any(|piece| !piece.stable) => Some(false),
            (_, Some(own)) => (own.all.len() == 1).then_some(true),
            _ => None,
        }
    }
}
