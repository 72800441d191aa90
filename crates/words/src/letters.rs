//! Letters and words: what is written, its sums, its symmetry, its cost.

use std::fmt;

use num_traits::{One, Zero};

use super::damping::Damping;
use super::filter::Filter;
use number::{Radical, Rational};

/// The forces that a letter names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Force {
    /// The whole force.
    All,
    /// The force of Λ1.
    First,
    /// The force of Λ2.
    Second,
}

/// One letter, its coefficients in units of the step.
#[derive(Clone, Debug, PartialEq)]
pub enum Letter {
    /// D(c): x += c h v.
    Drift(Radical),
    /// K(c, d, ...): v −= (c F + d F² + ...) g x / h, F = h² Λ, g the filter.
    Kick { force: Force, filter: Filter, powers: Vec<Radical> },
    /// C(c): the implicit midpoint rule over c h.
    Midpoint { force: Force, time: Radical },
    /// R(c): the exact flow of x'' + Λ x = 0 over c h.
    Flow { force: Force, time: Radical },
    /// O(c), F(c), I(c): friction alone over c h.
    Friction { damping: Damping, time: Radical },
}

/// A letter, or a word that is repeated.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    Letter(Letter),
    Repeat(u64, Vec<Item>),
}

/// An integrator as its author writes it; the first letter acts first.
#[derive(Clone, Debug)]
pub struct Word {
    items: Vec<Item>,
}

impl PartialEq for Word {
    /// Equality of what is written: numbers of two fields are different texts.
    fn eq(&self, other: &Word) -> bool {
        self.to_string() == other.to_string()
    }
}

/// Where a word differs from itself read backwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Counted from 1, kicks and drifts that touch being one letter.
    pub letter: usize,
    pub there: String,
    /// The letter as far from the end.
    pub mirrored: String,
}

/// The cost of a step. Kicks without a drift between them share one evaluation and one gradient, those at
/// both ends of the step too.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Evaluations of each force; the whole force is one where the word does not name two.
    pub evaluations: [u64; 2],
    /// Kicks with more than one power of the force: each needs one more evaluation or a product with the
    /// Hessian.
    pub gradients: u64,
    /// Implicit midpoints: each solves one linear system.
    pub solves: u64,
    /// Exact flows.
    pub flows: u64,
}

impl Cost {
    /// Evaluations, gradients, solves and flows, each counted as one.
    pub fn total(&self) -> u64 {
        self.evaluations.iter().sum::<u64>() + self.gradients + self.solves + self.flows
    }
}

impl Letter {
    fn numbers(&mut self) -> &mut [Radical] {
        match self {
            Letter::Drift(time)
            | Letter::Friction { time, .. }
            | Letter::Midpoint { time, .. }
            | Letter::Flow { time, .. } => std::slice::from_mut(time),
            Letter::Kick { powers, .. } => powers,
        }
    }

    /// A time, or the strengths of the force's powers.
    pub fn coefficients(&self) -> &[Radical] {
        match self {
            Letter::Drift(time)
            | Letter::Friction { time, .. }
            | Letter::Midpoint { time, .. }
            | Letter::Flow { time, .. } => std::slice::from_ref(time),
            Letter::Kick { powers, .. } => powers,
        }
    }

    fn is_nothing(&self) -> bool {
        self.coefficients().iter().all(Zero::is_zero)
    }

    pub(super) fn force(&self) -> Option<Force> {
        match self {
            Letter::Drift(_) | Letter::Friction { .. } => None,
            Letter::Kick { force, .. } | Letter::Midpoint { force, .. } | Letter::Flow { force, .. } => {
                Some(*force)
            }
        }
    }

    /// The filter of a kick: kicks of one force with different filters are different kicks.
    fn filter(&self) -> Option<Filter> {
        if let Letter::Kick { filter, .. } = self { Some(*filter) } else { None }
    }

    fn damping(&self) -> Option<Damping> {
        if let Letter::Friction { damping, .. } = self { Some(*damping) } else { None }
    }

    fn moves(&self) -> bool {
        !matches!(self, Letter::Kick { .. } | Letter::Friction { .. })
    }
}

/// All numbers in one field; `None` where no single root generates it.
fn in_one_field(numbers: &mut [&mut Radical]) -> Option<()> {
    // Twice: the largest field is known only after the first pass.
    let mut largest = Radical::zero();
    for _ in 0..2 {
        for number in numbers.iter_mut() {
            let (element, known) = Radical::together(number, &largest)?;
            (**number, largest) = (element, known);
            if largest.field().is_none() {
                largest = number.clone();
            }
        }
    }
    Some(())
}

fn each<'a>(items: &'a mut [Item], all: &mut Vec<&'a mut Radical>) {
    for item in items {
        match item {
            Item::Letter(letter) => all.extend(letter.numbers()),
            Item::Repeat(_, inside) => each(inside, all),
        }
    }
}

impl Word {
    /// A word of these items; `None` where its coefficients do not lie in one field ℚ(c^(1/n)).
    pub fn new(mut items: Vec<Item>) -> Option<Word> {
        let mut numbers = Vec::new();
        each(&mut items, &mut numbers);
        in_one_field(&mut numbers)?;
        Some(Word { items })
    }

    /// The letters and groups as they are written.
    pub fn items(&self) -> &[Item] {
        &self.items
    }

    /// How many letters it has when nothing is abbreviated.
    pub fn len(&self) -> u64 {
        fn len(items: &[Item]) -> u64 {
            let of = |item: &Item| match item {
                Item::Letter(_) => 1,
                Item::Repeat(times, inside) => len(inside).saturating_mul(*times),
            };
            items.iter().map(of).fold(0, u64::saturating_add)
        }
        len(&self.items)
    }

    /// Whether it has no letters at all.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// Whether some letter is of this kind.
    fn any(&self, is: fn(&Letter) -> bool) -> bool {
        fn any(items: &[Item], is: fn(&Letter) -> bool) -> bool {
            items.iter().any(|item| match item {
                Item::Letter(letter) => is(letter),
                Item::Repeat(_, inside) => any(inside, is),
            })
        }
        any(&self.items, is)
    }

    /// Whether it names the forces: K1, K2, C1, C2, R1, R2.
    pub fn names_forces(&self) -> bool {
        self.any(|letter| matches!(letter.force(), Some(Force::First | Force::Second)))
    }

    /// Whether its entries are algebraic in h: it has neither exact flows nor filters. Friction is not
    /// counted: without it O, F and I do nothing.
    pub fn is_algebraic(&self) -> bool {
        !self.any(|letter| match letter {
            Letter::Flow { .. } => true,
            Letter::Kick { filter, .. } => !filter.is_one() && !filter.zero,
            _ => false,
        })
    }

    /// Whether it has letters O, F or I.
    pub fn has_friction(&self) -> bool {
        self.any(|letter| matches!(letter, Letter::Friction { .. }))
    }

    /// Whether its friction is rational in h: it has no letters O.
    pub fn is_damped_rationally(&self) -> bool {
        !self.any(|letter| matches!(letter, Letter::Friction { damping: Damping::Exact, .. }))
    }

    /// Whether positions act on velocities and velocities on positions. Without that the propagator is
    /// triangular, so every step of the word is on an edge of stability.
    pub fn couples(&self) -> bool {
        self.any(Letter::moves) && self.any(|letter| letter.force().is_some())
    }

    /// The letters one by one. Its length is [`Word::len`]: to be known before.
    pub fn letters(&self) -> Vec<&Letter> {
        fn add<'a>(items: &'a [Item], all: &mut Vec<&'a Letter>) {
            for item in items {
                match item {
                    Item::Letter(letter) => all.push(letter),
                    Item::Repeat(times, inside) => (0..*times).for_each(|_| add(inside, all)),
                }
            }
        }
        let mut all = Vec::new();
        add(&self.items, &mut all);
        all
    }

    /// The letters with those that touch joined and those that do nothing left out: a drift, then the kicks
    /// at one place by their forces, and so on. A kick by the whole force is one by each where the word names
    /// two.
    pub(super) fn joined(&self) -> Vec<Letter> {
        let named = self.names_forces();
        let mut all: Vec<Letter> = Vec::new();
        for letter in self.letters() {
            let parts = match letter {
                Letter::Kick { force: Force::All, filter, powers } if named && powers.len() == 1 => {
                    [Force::First, Force::Second]
                        .map(|force| Letter::Kick { force, filter: *filter, powers: powers.clone() })
                        .to_vec()
                }
                other => vec![other.clone()],
            };
            parts.into_iter().for_each(|part| join(&mut all, part));
        }
        all
    }

    /// Σ of the drifts, of the kicks of each force that the word names (midpoints and flows are both; a kick
    /// whose filter is 0 is none), and of O, F and I together where there are some; consistent iff each is 1.
    pub fn sums(&self) -> Vec<(&'static str, Radical)> {
        let names = if self.names_forces() { &["D", "K1", "K2"][..] } else { &["D", "K"] };
        let friction = self.has_friction().then_some("O");
        let mut sums: Vec<(&'static str, Radical)> =
            names.iter().copied().chain(friction).map(|name| (name, Radical::zero())).collect();
        for letter in self.letters() {
            let (drift, force, c) = match letter {
                Letter::Drift(time) => (true, None, time),
                Letter::Friction { time, .. } => (false, None, time),
                Letter::Kick { filter, .. } if filter.zero => continue,
                Letter::Kick { force, powers, .. } => (false, Some(*force), &powers[0]),
                Letter::Midpoint { force, time } | Letter::Flow { force, time } => (true, Some(*force), time),
            };
            for (name, sum) in &mut sums {
                let kicked = match force {
                    None => *name == "O" && !drift,
                    Some(Force::All) => name.starts_with('K'),
                    Some(Force::First) => *name == "K1",
                    Some(Force::Second) => *name == "K2",
                };
                if kicked || drift && *name == "D" {
                    *sum += c.clone();
                }
            }
        }
        sums
    }

    /// Whether every sum is 1.
    pub fn is_consistent(&self) -> bool {
        self.sums().iter().all(|(_, sum)| sum.is_one())
    }

    /// The first place at which the word differs from itself read backwards; `None` for a palindrome, which
    /// is a method that is symmetric in time.
    pub fn asymmetry(&self) -> Option<Place> {
        let all = self.joined();
        // Kicks at one place commute, and stand in one order whichever way they are read.
        let mut backwards: Vec<Letter> = Vec::new();
        all.iter().rev().for_each(|letter| join(&mut backwards, letter.clone()));
        let differs = all.iter().zip(&backwards).position(|(one, other)| one != other)?;
        let text = |letter: &Letter| letter.to_string();
        Some(Place { letter: differs + 1, there: text(&all[differs]), mirrored: text(&backwards[differs]) })
    }

    /// The cost of a step.
    pub fn cost(&self) -> Cost {
        let (all, mut cost) = (self.joined(), Cost::default());
        // What is evaluated at the end of a step is known at the beginning of the next one.
        let mut known = Known::at_end(&all, self.names_forces());
        for letter in &all {
            match letter {
                Letter::Midpoint { .. } => cost.solves += 1,
                Letter::Flow { .. } => cost.flows += 1,
                _ => (),
            }
            if letter.moves() {
                known = Known::default();
            }
            let [first, second, gradients] = known.kicked(letter, self.names_forces());
            cost.evaluations = [cost.evaluations[0] + first, cost.evaluations[1] + second];
            cost.gradients += gradients;
        }
        cost
    }
}

/// The forces that a kick evaluates.
fn indices(force: Force, named: bool) -> std::ops::Range<usize> {
    match force {
        Force::All if named => 0..2,
        Force::All | Force::First => 0..1,
        Force::Second => 1..2,
    }
}

/// The forces and the gradients that were evaluated since x moved.
#[derive(Default)]
struct Known {
    forces: [bool; 2],
    gradients: Vec<(Force, Filter)>,
}

impl Known {
    /// Those at the end of a step; none where x never moves.
    fn at_end(all: &[Letter], named: bool) -> Known {
        let mut known = Known::default();
        if all.iter().any(Letter::moves) {
            let since = all.iter().rev().take_while(|letter| !letter.moves());
            since.for_each(|letter| {
                known.kicked(letter, named);
            });
        }
        known
    }

    /// Evaluations of either force and gradients that a letter asks for beyond what is known, which is known
    /// from then on.
    fn kicked(&mut self, letter: &Letter, named: bool) -> [u64; 3] {
        let (Letter::Kick { force, filter, powers }, mut new) = (letter, [0; 3]) else { return [0; 3] };
        if filter.zero {
            return new;
        }
        for i in indices(*force, named) {
            new[i] = u64::from(!std::mem::replace(&mut self.forces[i], true));
        }
        let key = (*force, *filter);
        if powers.iter().skip(1).any(|c| !c.is_zero()) && !self.gradients.contains(&key) {
            self.gradients.push(key);
            new[2] = 1;
        }
        new
    }
}

/// Adds a letter at the end, joined to what it touches.
fn join(all: &mut Vec<Letter>, letter: Letter) {
    if letter.is_nothing() {
        return;
    }
    let place =
        all.iter().rposition(|letter| !matches!(letter, Letter::Kick { .. })).map_or(0, |last| last + 1);
    match &letter {
        // Two steps of them are none over the sum of both.
        Letter::Midpoint { .. } | Letter::Friction { damping: Damping::Explicit | Damping::Implicit, .. } => {
            all.push(letter);
        }
        Letter::Drift(time) | Letter::Friction { time, .. } | Letter::Flow { time, .. } => {
            // Flows of one force over two times are one over their sum.
            let last = all.last_mut().filter(|own| {
                std::mem::discriminant(*own) == std::mem::discriminant(&letter)
                    && own.force() == letter.force()
                    && own.damping() == letter.damping()
            });
            let Some(element) = last.and_then(|letter| letter.numbers().first_mut()) else {
                return all.push(letter);
            };
            *element += time.clone();
            if element.is_zero() {
                all.pop();
            }
        }
        Letter::Kick { force, filter, powers } => {
            let key = (Some(*force), Some(*filter));
            let of = |letter: &Letter| (letter.force(), letter.filter());
            let same = all[place..].iter().position(|letter| of(letter) == key);
            let Some(same) = same.map(|same| place + same) else {
                let at = all[place..].iter().position(|letter| of(letter) > key);
                return all.insert(at.map_or(all.len(), |at| place + at), letter);
            };
            if let Letter::Kick { powers: elements, .. } = &mut all[same] {
                elements.resize(elements.len().max(powers.len()), Radical::zero());
                elements.iter_mut().zip(powers).for_each(|(element, c)| *element += c.clone());
                while elements.len() > 1 && elements.last().is_some_and(Zero::is_zero) {
                    elements.pop();
                }
            }
            if all[same].is_nothing() {
                all.remove(same);
            }
        }
    }
}

/// A rational number, as a decimal where that is shorter for the eye: 0.1931833275037836.
fn text(x: &Rational) -> String {
    const SHORT: u64 = 14;
    if x.denom().bits() <= SHORT {
        return x.to_string();
    }
    let mut places = 0u32;
    let mut scaled = x.clone();
    while !scaled.is_integer() && places <= 40 {
        scaled *= Rational::from_integer(10.into());
        places += 1;
    }
    if !scaled.is_integer() {
        return x.to_string();
    }
    let digits = format!("{:0>width$}", scaled.numer().magnitude().to_string(), width = places as usize + 1);
    let (whole, fraction) = digits.split_at(digits.len() - places as usize);
    let sign = if scaled < Rational::zero() { "-" } else { "" };
    format!("{sign}{whole}.{fraction}")
}

impl fmt::Display for Letter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self.force() {
            None | Some(Force::All) => "",
            Some(Force::First) => "1",
            Some(Force::Second) => "2",
        };
        let number = |x: &Radical| x.text(text);
        match self {
            Letter::Drift(time) => write!(f, "D({})", number(time)),
            Letter::Friction { damping, time } => write!(f, "{}({})", damping.letter(), number(time)),
            Letter::Midpoint { time, .. } => write!(f, "C{name}({})", number(time)),
            Letter::Flow { time, .. } => write!(f, "R{name}({})", number(time)),
            Letter::Kick { powers, filter, .. } => {
                let powers: Vec<String> = powers.iter().map(number).collect();
                write!(f, "K{name}{filter}({})", powers.join(", "))
            }
        }
    }
}

fn written(items: &[Item]) -> String {
    let one = |item: &Item| match item {
        Item::Letter(letter) => letter.to_string(),
        Item::Repeat(times, inside) => format!("{times}*({})", written(inside)),
    };
    items.iter().map(one).collect::<Vec<_>>().join(" ")
}

impl fmt::Display for Word {
    /// The word in the notation that is read, its coefficients exact.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&written(&self.items))
    }
}
