//! Growth rates of systems against Gelfand's formula: ln ρ(Q) = lim ln ‖Q^m‖/m over powers of the exact full
//! period, squared a hundred times in integers of many bits. No eigenvalue, no half period, no polynomial is
//! asked.

use kickdrift::number::Rational;
use kickdrift::number::rational::{ratio, to_f64};
use kickdrift::system::{Limits, Potential, Symmetric, System, decide_system, full_period};
use kickdrift::verdict::Kind;
use nalgebra::DMatrix;
use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive, Zero};

/// Numbers that repeat.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, n: u64) -> i64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n) as i64
    }

    /// Stiffnesses on two or three clocks, each a multiple of Z Zᵀ, in a quarter of the systems not quite
    /// definite.
    fn system(&mut self, n: usize) -> System {
        let steps: &[(i64, i64)] = match self.below(4) {
            0 => &[(1, 1), (2, 1)],
            1 => &[(1, 1), (3, 2)],
            2 => &[(1, 1), (2, 1), (3, 1)],
            _ => &[(1, 1), (5, 1)],
        };
        let is_indefinite = self.below(4) == 0;
        let potentials = steps.iter().map(|&(p, q)| {
            let z: Vec<Vec<i64>> = (0..n).map(|_| (0..n).map(|_| self.below(7) - 3).collect()).collect();
            let entry = |i: usize, j: usize| (0..n).map(|k| z[i][k] * z[j][k]).sum::<i64>();
            let mut stiffness = Symmetric::zero(n);
            for i in 0..n {
                for j in 0..=i {
                    let more = if is_indefinite { self.below(9) - 4 } else { 0 };
                    stiffness.add(i, j, &ratio(entry(i, j) + more, 32 * p * p * n as i64));
                }
            }
            Potential::new(stiffness, ratio(p, q))
        });
        let potentials = potentials.collect();
        System::new(Symmetric::diagonal(&vec![ratio(1, 1); n]), potentials).unwrap()
    }
}

/// All stiffnesses times a factor.
fn scaled(system: &System, factor: &Rational) -> System {
    let potential = |own: &Potential| Potential { stiffness: own.stiffness.scaled(factor), ..own.clone() };
    System::new(system.mass().clone(), system.potentials().iter().map(potential).collect()).unwrap()
}

const BITS: i64 = 640;
const SQUARINGS: u32 = 100;

/// ln ρ(Q) of one period. ‖Q^m‖ is ρ^m but for a factor that is polynomial in m at most: at m = 2^100 its
/// logarithm moves ln ρ by some 10^-28; each squaring doubles the relative error, so that of 640 bits 500 are
/// left.
fn ln_radius(system: &System) -> f64 {
    let exact: DMatrix<Rational> = full_period(system);
    let fixed = |x: &Rational| ((x.numer() << BITS) / x.denom(), BITS);
    let mut m = exact.map(|x| fixed(&x).0);
    // Q^(2^k) = m 2^power.
    let mut power = BigInt::from(-BITS);
    for _ in 0..SQUARINGS {
        let n = m.nrows();
        let square = DMatrix::from_fn(n, n, |i, j| (0..n).map(|k| &m[(i, k)] * &m[(k, j)]).sum::<BigInt>());
        power *= 2;
        let longest = square.iter().map(BigInt::bits).max().unwrap() as i64;
        let shift = longest - BITS;
        m = square.map(|x| if shift >= 0 { x >> shift } else { x << -shift });
        power += shift;
    }
    let largest = m.iter().map(Signed::abs).max().unwrap();
    assert!(!largest.is_zero());
    // The exponent has some hundred bits, of which a double keeps its share.
    let whole = power + BigInt::from(largest.bits());
    whole.to_f64().unwrap() * std::f64::consts::LN_2 / 2f64.powi(SQUARINGS as i32)
}

/// Below this over a period Gelfand's formula at this power does not tell growth from none.
const NONE: f64 = 1e-25;

fn check(system: &System) -> Option<f64> {
    let analysis = decide_system(system, &Limits::default()).unwrap();
    let kind = analysis.kind.expect("small systems are decided");
    let (lo, hi) = analysis.growth_rate().expect("and their rates enclosed");
    let (found, period) = (ln_radius(system), to_f64(&system.period()));
    if kind != Kind::Hyperbolic {
        assert!((lo, hi) == (0.0, 0.0) && found.abs() < NONE, "{found} {system:?}");
        return None;
    }
    let found = found / period;
    // The roundings of a logarithm, a quotient and the exponent.
    let off = 1e-14 * found + NONE;
    assert!(0.0 < lo && lo <= found + off && found - off <= hi, "{lo} {hi} {found} {system:?}");
    assert!(hi - lo <= 1e-8 * hi, "{lo} {hi} {system:?}");
    Some(found)
}

/// The unstable neighbour of an edge between two factors of all stiffnesses, so many halvings near; `None`
/// where both are of one kind.
fn beside_an_edge(system: &System, halvings: u32) -> Option<System> {
    let grows = |factor: &Rational| {
        let analysis = decide_system(&scaled(system, factor), &Limits::default()).unwrap();
        analysis.kind == Some(Kind::Hyperbolic)
    };
    let (mut still, mut growing) = (ratio(1, 64), ratio(64, 1));
    if grows(&still) || !grows(&growing) {
        return None;
    }
    for _ in 0..halvings {
        let middle = (&still + &growing) / ratio(2, 1);
        let end = if grows(&middle) { &mut growing } else { &mut still };
        *end = middle;
    }
    Some(scaled(system, &growing))
}

/// How many grow, how many of these slower than 10^-6, of `count` systems at random and as many beside edges.
fn agreed(count: usize, largest: u64, seed: u64) -> [usize; 3] {
    let (mut numbers, mut seen) = (Numbers(seed), [0; 3]);
    for trial in 0..count {
        let n = 1 + numbers.below(largest) as usize;
        let system = scaled(&numbers.system(n), &ratio(1 + numbers.below(24), 1));
        let beside = beside_an_edge(&system, 10 + 6 * (trial % 8) as u32);
        for own in [Some(system), beside].into_iter().flatten() {
            seen[0] += 1;
            if let Some(rate) = check(&own) {
                seen[1] += 1;
                seen[2] += usize::from(rate < 1e-6);
            }
        }
    }
    seen
}

// Ledger: growth; 120 random systems, seed 1; powers of the exact period
#[test]
fn growth_rates_are_those_of_the_powers_of_the_exact_period() {
    let [all, growing, slow] = agreed(120, 4, 1);
    println!("{all} systems, {growing} grow, {slow} of these slower than 1e-6");
    assert!(all > 120 && growing > 10 && slow > 0, "{all} {growing} {slow}");
}

/// A test for each seed: 1,000 systems, some minutes.
macro_rules! pieces {
    ($($name:ident: $seed:literal),*) => {$(
        #[test]
        #[ignore = "minutes"]
        fn $name() {
            println!("systems, growing, slower than 1e-6: {:?}", agreed(500, 8, $seed));
        }
    )*};
}

/// Growth rates of 10,000 systems are those of the powers of the exact period.
mod ten_thousand {
    use super::agreed;
    pieces! {
        piece_0: 2, piece_1: 3, piece_2: 4, piece_3: 5, piece_4: 6,
        piece_5: 7, piece_6: 8, piece_7: 9, piece_8: 10, piece_9: 11
    }
}

#[test]
fn rates_beside_edges_have_all_their_digits() {
    // Verlet's h² k = 4 + e: λ + 1/λ = −2 − e, ln |λ| = 2 asinh (√e/2).
    for places in [6, 14, 20, 30] {
        let e = Rational::new(1.into(), num_traits::pow(BigInt::from(10), places));
        // Two modes (4 + e and 1) turned by (3, 4, 5): one matrix without a zero.
        let turn = [[ratio(3, 5), ratio(4, 5)], [ratio(-4, 5), ratio(3, 5)]].map(|row| row.to_vec());
        let stiffness = Symmetric::diagonal(&[ratio(4, 1) + &e, ratio(1, 1)]).congruent(&turn);
        let mut coupling = Symmetric::zero(2);
        coupling.add(0, 0, &ratio(1, 1_000_000));
        // Alone it splits into modes; beside a second clock's potential it does not.
        for second in [None, Some(coupling)] {
            let is_alone = second.is_none();
            let mut potentials = vec![Potential::new(stiffness.clone(), ratio(1, 1))];
            potentials.extend(second.map(|own| Potential::new(own, ratio(2, 1))));
            let system = System::new(Symmetric::diagonal(&[ratio(1, 1), ratio(1, 1)]), potentials).unwrap();
            let analysis = decide_system(&system, &Limits::default()).unwrap();
            let (lo, hi) = analysis.growth_rate().unwrap();
            if is_alone {
                let want = 2.0 * (to_f64(&e).sqrt() / 2.0).asinh();
                assert!(lo <= want * (1.0 + 1e-15) && want * (1.0 - 1e-15) <= hi, "{lo} {hi} {want}");
            }
            assert!(analysis.kind != Some(Kind::Hyperbolic) || lo > 0.0 && hi - lo < 1e-9 * hi, "{lo} {hi}");
            check(&system);
        }
    }
}
