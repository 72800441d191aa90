//! One closing in a box that is proven to hold it.
//!
//! **Uniqueness**: Krawczyk's operator on F(s, ρ) = (X, Y), X and Y the two entries, maps a box strictly into
//! itself; so the box holds exactly one common zero, and a simple one (Krawczyk 1969, Moore 1977).

use num_traits::{One, Signed};

use super::jet::{Jet, jets};
use crate::propagator::TwoClocks;
use crate::tongue::edge::{Enclosure, Tongues, simplest};
use crate::tongue::string::Entry;
use crate::verdict::Decidable;
use number::parallel::go_on;
use number::{Ball, Error, Ratio, Rational, Result, Sign, rational};

/// A closed tongue, certified: the box s × ρ holds exactly one common zero of the two entries, and it is
/// tongue m's.
#[derive(Clone, Debug, PartialEq)]
pub struct Closing {
    pub ratio: Ratio,
    pub m: u64,
    pub s: Enclosure,
    pub rho: Enclosure,
    /// (s*, ρ*), where both are rational.
    pub exact: Option<(Rational, Rational)>,
    /// Whether s* < 4, the fast clock's Verlet limit.
    pub below_verlet: bool,
}

/// Bits of the first Newton steps and of their box, and the most that are tried.
const BITS: u32 = 512;
const MOST_BITS: u32 = 1 << 14;

/// The box's half width for each [`BITS`] bits: 2^-100 of its centre, while the centre is good to about
/// 2^-400.
const BOX: i64 = -100;

/// Digits of an edge that doubles cannot separate from its neighbour.
const DIGITS: u32 = 60;

/// A bracket of ρ is halved so often before more bits are tried: balls may lose more of them over a period
/// than there are.
const HALVINGS: u32 = 8;

/// Which entry's zero is the lower edge.
#[derive(Clone, Debug)]
pub struct Order {
    pub m: u64,
    pub lower: Entry,
    pub closed: bool,
}

/// Which edge of which tongue is the lower one at ρ: of tongue m, or of all finite ones.
///
/// # Errors
/// As [`Tongues::new`].
pub fn orders(ratio: Ratio, rho: &Rational, m: Option<u64>) -> Result<Vec<Order>> {
    let tongues = Tongues::new(ratio, rho)?;
    let (from, upto) = m.map_or((1, tongues.last() - 1), |m| (m, m));
    if upto < from {
        return Ok(Vec::new());
    }
    let gaps = tongues.gaps(from, upto)?;
    Ok(gaps.iter().map(|gap| Order { m: gap.m, lower: gap.lower.entry, closed: gap.closed }).collect())
}

/// Narrows the bracket of ρ, finds the zero by Newton's method, and proves it.
///
/// # Errors
/// As [`orders`]; a closing that more digits are needed for than are tried.
pub fn certify(ratio: Ratio, m: u64, lo: &Rational, hi: &Rational) -> Result<Closing> {
    let pair = Entry::of_tongue(m % 2 == 1);
    let (mut lo, mut hi) = (lo.clone(), hi.clone());
    for halvings in 1.. {
        go_on()?;
        let bits = BITS << ((halvings - 1) / HALVINGS);
        if bits > MOST_BITS {
            break;
        }
        let start = Start::new(ratio, m, (&lo, &hi), bits)?;
        if let Some(closing) =
            start.newton(pair)?.and_then(|(s, rho)| start.proven(pair, &s, &rho).transpose())
        {
            return closing;
        }
        // Closer still: the middle's order decides which half holds the crossing.
        let two = Rational::from_integer(2.into());
        let middle = (&lo + &hi) / two;
        let (below, at) = (orders(ratio, &lo, Some(m))?, orders(ratio, &middle, Some(m))?);
        match (below[0].lower == at[0].lower, at[0].closed) {
            (_, true) => (lo, hi) = (middle.clone(), middle),
            (true, _) => lo = middle,
            (false, _) => hi = middle,
        }
    }
    let work = format!("the closing of tongue {m} of {ratio} near rho = {}", rational::to_f64(&lo));
    Err(Error::too_much(format!("{work} needs more digits than are tried"), "choose a simpler ratio"))
}

/// A bracket of ρ, and of s: all edges fall as ρ grows (masses do), so tongue m's edges at its ends bound s*.
struct Start {
    ratio: Ratio,
    m: u64,
    s: (Rational, Rational),
    rho: (Rational, Rational),
    bits: u32,
}

impl Start {
    fn new(ratio: Ratio, m: u64, (lo, hi): (&Rational, &Rational), bits: u32) -> Result<Self> {
        let edges = |rho: &Rational| -> Result<(f64, f64)> {
            let gap = Tongues::new(ratio, rho)?.gap(m)?;
            let upper = gap.upper.expect("a finite tongue");
            Ok((gap.lower.lo.min(upper.lo), gap.lower.hi.max(upper.hi)))
        };
        let exact = |x: f64| rational::from_f64_exact(x).expect("finite");
        let s = (exact(edges(hi)?.0), exact(edges(lo)?.1));
        Ok(Start { ratio, m, s, rho: (lo.clone(), hi.clone()), bits })
    }

    /// Newton's method from the bracket's middle; `None` where it leaves the bracket.
    fn newton(&self, pair: [Entry; 2]) -> Result<Option<(Rational, Rational)>> {
        let bits = self.bits;
        let middle = |(lo, hi): &(Rational, Rational)| {
            Ball::from_rational(&((lo + hi) / Rational::from_integer(2.into())), bits)
        };
        let (mut s, mut rho) = (middle(&self.s), middle(&self.rho));
        // Fourteen squarings of 1/2 pass 2^-MOST_BITS.
        for _ in 0..24 {
            let jets = jets(self.ratio, &point(&s, bits), &point(&rho, bits), pair, bits)?;
            let Some([ds, dr]) = solve(&jets, [&jets[0].0[0], &jets[1].0[0]], bits) else { return Ok(None) };
            (s, rho) = (point(&s.sub(&ds, bits), bits), point(&rho.sub(&dr, bits), bits));
        }
        let (s, rho) = (s.lower(), rho.lower());
        let within = |x: &Rational, (lo, hi): &(Rational, Rational)| {
            let slack = (hi - lo) / Rational::from_integer(1000.into())
                + lo * Rational::new(1.into(), (1u64 << 60).into());
            lo - &slack <= *x && *x <= hi + &slack
        };
        Ok((within(&s, &self.s) && within(&rho, &self.rho)).then_some((s, rho)))
    }

    /// Krawczyk's test on the box about (s, ρ), and that the zero belongs to tongue m.
    fn proven(&self, pair: [Entry; 2], s: &Rational, rho: &Rational) -> Result<Option<Closing>> {
        let (ratio, bits) = (self.ratio, self.bits);
        let centre = [s, rho].map(|x| Ball::from_rational(x, bits));
        let radius = [s, rho].map(|x| x.abs() * rational::scale2(&One::one(), BOX * i64::from(bits / BITS)));
        let sides: [Ball; 2] = std::array::from_fn(|i| {
            let end = |x: Rational| Ball::from_rational(&x, bits);
            end([s, rho][i] - &radius[i]).union(&end([s, rho][i] + &radius[i]), bits)
        });
        let wide: [Ball; 2] = std::array::from_fn(|i| sides[i].sub(&centre[i], bits));
        let at = jets(ratio, &centre[0], &centre[1], pair, bits)?;
        let over = jets(ratio, &sides[0], &sides[1], pair, bits)?;
        // K − centre = −Y F(centre) + (1 − Y F'(box)) (box − centre), Y ≈ F'(centre)⁻¹.
        let Some(inverse) = inverse(&at, bits) else { return Ok(None) };
        let mut image = Vec::new();
        for (i, row) in inverse.iter().enumerate() {
            let mut sum = dot(row, [&at[0].0[0], &at[1].0[0]], bits).neg();
            for (k, wide) in wide.iter().enumerate() {
                let product = dot(row, [&over[0].0[k + 1], &over[1].0[k + 1]], bits);
                let unit = if i == k { Ball::one() } else { Ball::zero() };
                sum = sum.add(&unit.sub(&product, bits).mul(wide, bits), bits);
            }
            image.push(sum);
        }
        let inside = |k: usize| image[k].upper() < radius[k] && image[k].lower() > -radius[k].clone();
        if !(inside(0) && inside(1)) {
            return Ok(None);
        }
        let [s, rho]: [Enclosure; 2] = std::array::from_fn(|k| {
            let centre = [s, rho][k];
            Enclosure { lo: centre + image[k].lower(), hi: centre + image[k].upper() }
        });
        self.belongs(&s, &rho)?.then(|| self.closing(s, rho)).transpose()
    }

    /// Whether the zero in the box is tongue m's edge and no other's: at both ends of the box's ρ the
    /// entries' neighbouring zeros stay away from its s.
    fn belongs(&self, s: &Enclosure, rho: &Enclosure) -> Result<bool> {
        let index = self.m.div_ceil(2) as usize;
        let early = Tongues::new(self.ratio, &rho.lo)?;
        let late = Tongues::new(self.ratio, &rho.hi)?;
        let mut mine = true;
        for entry in Entry::of_tongue(self.m % 2 == 1) {
            // Falling in ρ: the zero below is highest early, the zero above lowest late.
            if index > 1 {
                mine &= is_away(&early, entry, index - 1, |edge| edge.hi < s.lo)?;
            }
            if index < late.zeros(entry) {
                mine &= is_away(&late, entry, index + 1, |edge| edge.lo > s.hi)?;
            }
        }
        Ok(mine)
    }

    fn closing(&self, s: Enclosure, rho: Enclosure) -> Result<Closing> {
        let exact = self.rational(&s, &rho);
        let four = Rational::from_integer(4.into());
        let below_verlet = exact.as_ref().map_or_else(|| s.hi < four, |(s, _)| *s < four);
        let (ratio, m) = (self.ratio, self.m);
        Ok(Closing { ratio, m, s, rho, exact, below_verlet })
    }

    /// The simplest rationals in the box, if they are the closing: the box holds no other.
    fn rational(&self, s: &Enclosure, rho: &Enclosure) -> Option<(Rational, Rational)> {
        let (s, rho) = (simplest(&s.lo, &s.hi), simplest(&rho.lo, &rho.hi));
        // Half the box's own digits: a coincidence of that kind would be a wonder, and is checked all the
        // same.
        let short = s.denom().bits() < 100 && rho.denom().bits() < 100;
        let signs =
            short.then(|| Decidable::half_signs(&TwoClocks::with_rho(self.ratio, s.clone(), rho.clone())))?;
        let closed =
            Entry::of_tongue(self.m % 2 == 1).iter().all(|&entry| signs.all()[entry as usize] == Sign::Zero);
        closed.then_some((s, rho))
    }
}

/// Whether an edge lies on its own side of a box: by doubles, where they decide, else by more digits.
fn is_away(tongues: &Tongues, entry: Entry, index: usize, is: impl Fn(&Enclosure) -> bool) -> Result<bool> {
    let edge = &tongues.edges(entry, index, index)?[0];
    Ok(is(&Enclosure::from(edge)) || is(&tongues.refine(edge, DIGITS)?))
}

/// The ball's midpoint, as an exact ball.
fn point(x: &Ball, bits: u32) -> Ball {
    let middle = (x.lower() + x.upper()) / Rational::from_integer(2.into());
    Ball::from_rational(&Ball::from_rational(&middle, bits).lower(), 2 * bits)
}

fn dot(row: &[Ball; 2], x: [&Ball; 2], bits: u32) -> Ball {
    row[0].mul(x[0], bits).add(&row[1].mul(x[1], bits), bits)
}

/// The inverse Jacobian, enclosed.
fn inverse(jets: &[Jet; 2], bits: u32) -> Option<[[Ball; 2]; 2]> {
    let [Jet([_, a, b]), Jet([_, c, d])] = jets;
    let determinant = a.mul(d, bits).sub(&b.mul(c, bits), bits);
    let entry = |x: &Ball| x.div(&determinant, bits);
    Some([[entry(d)?, entry(&b.neg())?], [entry(&c.neg())?, entry(a)?]])
}

/// F'⁻¹ f.
fn solve(jets: &[Jet; 2], f: [&Ball; 2], bits: u32) -> Option<[Ball; 2]> {
    let inverse = inverse(jets, bits)?;
    Some([dot(&inverse[0], f, bits), dot(&inverse[1], f, bits)])
}
