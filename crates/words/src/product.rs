//! The product of the letters, over any ring that holds the coefficients.

use nalgebra::Matrix2;
use num_traits::{One, Zero, pow};

use super::damping::Damping;
use super::filter::Filter;
use super::letters::{Force, Item, Letter, Word};
use clocks::propagator::methods::respa::power;
use clocks::propagator::{apply_drift, apply_kick};
use number::{Polynomial, Radical, Rational, Ring};

/// An oscillator at a step in a ring, and how a coefficient is embedded there.
pub struct Forces<S> {
    /// h² Λ1 and h² Λ2.
    pub of: [S; 2],
    pub embed: fn(&Radical) -> S,
    /// γ h, of letters F and I; letters O do nothing.
    pub friction: S,
    /// Terms of the series of flows and filters.
    pub terms: usize,
    /// An entry without what is behind so many terms: products of series grow.
    pub trim: fn(S, usize) -> S,
}

/// A product of letters in the coordinates (x, h v): the matrix divided by the denominator and by what
/// implicit friction divides by, q and e. The matrix's determinant is q² e d, d the damping, so the step's is
/// d/e.
#[derive(Clone, Debug, PartialEq)]
pub struct Product<S> {
    pub matrix: Matrix2<S>,
    /// q: 1 without midpoints.
    pub denominator: S,
    /// d: the product of all exp(−γ c h) of letters O and 1 − γ c h of letters F; 1 without friction.
    pub damping: S,
    /// e: the product of all 1 + γ c h of letters I; 1 without friction.
    pub implicit: S,
}

/// The entries as polynomials in s = h² Λ1.
pub type Polynomials = Product<Polynomial<Radical>>;

impl<S: Ring> Forces<S> {
    /// Without friction, and every entry as it comes.
    pub fn new(of: [S; 2], embed: fn(&Radical) -> S) -> Self {
        Forces { of, embed, friction: S::zero(), terms: TERMS, trim: |x, _| x }
    }
}

impl Forces<Polynomial<Radical>> {
    /// Λ2 = 0: the whole force is s.
    pub fn one() -> Self {
        Forces::ratio(&Rational::zero())
    }

    /// Λ2 = ρ Λ1, as polynomials in s.
    pub fn ratio(rho: &Rational) -> Self {
        let s = Polynomial::variable();
        let second = s.scale(&Radical::from_rational(rho));
        Forces::new([s, second], |c| Polynomial::constant(c.clone()))
    }
}

/// The meaning of the letters in a ring.
pub(super) trait Setting<S: Ring> {
    /// F = h² Λ.
    fn force(&self, force: Force) -> S;

    fn embed(&self, c: &Radical) -> S;

    /// cos c x and c sinc c x of the exact flow over c h, x² = F.
    fn flow(&self, force: Force, c: &Radical) -> [S; 2];

    /// g at x = h √Λ1.
    fn filter(&self, filter: Filter) -> S;

    /// exp(−γ c h).
    fn damping(&self, c: &Radical) -> S;

    /// γ c h.
    fn friction(&self, c: &Radical) -> S;

    /// An entry without what is not asked for: products of series grow.
    fn trimmed(&self, x: S) -> S {
        x
    }
}

/// The most terms of the series of flows and filters in [`Forces`]: orders up to twice as many are found.
pub(super) const TERMS: usize = 12;

/// Terms that decide most words: the numbers in a product grow with the square of these.
pub(super) const FEW_TERMS: usize = 4;

/// Σ f_k F^k by Horner's rule.
fn series<S: Ring>(all: &[S], force: &S) -> S {
    all.iter().rev().fold(S::zero(), |sum, f| S::product(&sum, force) + f.clone())
}

/// Exact where the word is algebraic; flows and filters by the first terms of their series in F.
impl<S: Ring> Setting<S> for Forces<S> {
    fn force(&self, force: Force) -> S {
        match force {
            Force::All => self.of[0].clone() + self.of[1].clone(),
            Force::First => self.of[0].clone(),
            Force::Second => self.of[1].clone(),
        }
    }

    fn embed(&self, c: &Radical) -> S {
        (self.embed)(c)
    }

    fn flow(&self, force: Force, c: &Radical) -> [S; 2] {
        let (c, force) = (self.embed(c), self.force(force));
        let x = S::product(&S::product(&c, &c), &force);
        let terms = |from: u64| {
            let next = |term: &mut Rational, k: u64| {
                let number = S::from_rational(term);
                *term /= Rational::from_integer(
                    (-((2 * k + 1 + from) as i128 * (2 * k + 2 + from) as i128)).into(),
                );
                Some(number)
            };
            (0..self.terms as u64).scan(Rational::one(), next).collect::<Vec<_>>()
        };
        [series(&terms(0), &x), S::product(&c, &series(&terms(1), &x))]
    }

    fn filter(&self, filter: Filter) -> S {
        let all: Vec<S> = filter.series(self.terms).iter().map(S::from_rational).collect();
        series(&all, &self.of[0])
    }

    fn damping(&self, _: &Radical) -> S {
        S::one()
    }

    fn friction(&self, c: &Radical) -> S {
        S::product(&self.embed(c), &self.friction)
    }

    fn trimmed(&self, x: S) -> S {
        (self.trim)(x, self.terms)
    }
}

impl<S: Ring> Product<S> {
    fn identity() -> Self {
        let unit = Matrix2::new(S::one(), S::zero(), S::zero(), S::one());
        Product { matrix: unit, denominator: S::one(), damping: S::one(), implicit: S::one() }
    }

    fn times(&mut self, letter: &Letter, setting: &impl Setting<S>) {
        match letter {
            Letter::Drift(time) => apply_drift(&mut self.matrix, &setting.embed(time)),
            Letter::Friction { damping, time } => {
                let (row, factor) = match damping {
                    Damping::Exact => (1, setting.damping(time)),
                    Damping::Explicit => (1, S::one() + -setting.friction(time)),
                    // Positions by it, and all over it.
                    Damping::Implicit => (0, S::one() + setting.friction(time)),
                };
                for column in 0..2 {
                    self.matrix[(row, column)] *= factor.clone();
                }
                *(if row == 1 { &mut self.damping } else { &mut self.implicit }) *= factor;
            }
            Letter::Kick { force, filter, powers } => {
                let force = setting.force(*force);
                // (c + d F + ...) F by Horner's rule.
                let mut strength = powers
                    .iter()
                    .rev()
                    .fold(S::zero(), |sum, c| S::product(&(sum + setting.embed(c)), &force));
                if !filter.is_one() {
                    strength *= setting.filter(*filter);
                }
                apply_kick(&mut self.matrix, &strength);
            }
            Letter::Flow { force, time } => {
                let [cos, sinc] = setting.flow(*force, time);
                let back = -S::product(&setting.force(*force), &sinc);
                self.matrix = Matrix2::new(cos.clone(), sinc, back, cos) * &self.matrix;
                self.matrix = self.matrix.map(|entry| setting.trimmed(entry));
            }
            Letter::Midpoint { force, time } => {
                let (force, time) = (setting.force(*force), setting.embed(time));
                let kick = S::product(&time, &force);
                let quarter = S::from_rational(&Rational::new(1.into(), 4.into()));
                let part = S::product(&S::product(&kick, &time), &quarter);
                let (mut below, mut above) = (S::one(), S::one());
                below += part.clone();
                above -= part;
                let cayley = Matrix2::new(above.clone(), time, -kick, above);
                self.matrix = cayley * &self.matrix;
                self.denominator *= below;
            }
        }
    }

    fn items(items: &[Item], setting: &impl Setting<S>) -> Self {
        let mut product = Product::identity();
        for item in items {
            match item {
                Item::Letter(letter) => product.times(letter, setting),
                Item::Repeat(times, inside) => {
                    let Product { matrix, denominator, damping, implicit } = Product::items(inside, setting);
                    product.matrix = power(matrix, *times) * &product.matrix;
                    let raised = |x: S| pow(x, *times as usize);
                    product.denominator *= raised(denominator);
                    product.damping *= raised(damping);
                    product.implicit *= raised(implicit);
                }
            }
        }
        product
    }

    /// The trace times q e.
    pub fn trace(&self) -> S {
        self.matrix[(0, 0)].clone() + self.matrix[(1, 1)].clone()
    }

    /// q (e + d) − T and q (e + d) + T, T the trace times q e.
    pub(super) fn margins(&self) -> [S; 2] {
        let sum = S::product(&self.denominator, &(self.implicit.clone() + self.damping.clone()));
        let trace = self.trace();
        [sum.clone() + -trace.clone(), sum + trace]
    }
}

impl Word {
    /// The product of all letters.
    pub(super) fn product<S: Ring>(&self, setting: &impl Setting<S>) -> Product<S> {
        Product::items(self.items(), setting)
    }

    /// The product with entries in ℚ(c^(1/n))\[s\]: exact where the word [is algebraic](Word::is_algebraic),
    /// else up to s^12.
    pub fn polynomials(&self, forces: &Forces<Polynomial<Radical>>) -> Polynomials {
        self.product(forces)
    }

    /// Kicks and midpoints when nothing is abbreviated, each counted by its powers of the force, and the
    /// terms of flows: the degree of the entries in s.
    pub fn degree(&self) -> u64 {
        force_powers(self.items(), TERMS as u64)
    }

    /// The same with the terms of flows that decide most orders: a measure of what the word costs.
    pub fn effort(&self) -> u64 {
        force_powers(self.items(), FEW_TERMS as u64)
    }
}

/// Powers of the force, a flow having so many.
fn force_powers(items: &[Item], flow: u64) -> u64 {
    let one = |item: &Item| match item {
        Item::Letter(Letter::Drift(_) | Letter::Friction { .. }) => 0,
        Item::Letter(Letter::Flow { .. }) => flow,
        Item::Letter(Letter::Kick { powers, .. }) => powers.len() as u64,
        Item::Letter(Letter::Midpoint { .. }) => 1,
        Item::Repeat(times, inside) => force_powers(inside, flow).saturating_mul(*times),
    };
    items.iter().map(one).fold(0, u64::saturating_add)
}
