//! Filters of the slow force: how much of it a mode of the fast force feels.

use std::fmt;

use num_traits::{One, Zero};

use number::Rational;

/// g(x) = cos^i(x/2) sinc^k(x/2), or 0, with x = h √Λ1 and sinc y = sin y / y. MOLLY's φ(F) S φ(F) is g = φ²,
/// a method of Gautschi's kind x₊ − 2 cos(x) x + x₋ = −h² ψ Λ2 φ x has g = ψ φ/sinc x (Hairer, Lubich,
/// Wanner, Geometric Numerical Integration, XIII.2). With the equilibrium filter, 0, a mode that the fast
/// force moves feels nothing of the slow one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Filter {
    pub cos: i32,
    pub sinc: i32,
    /// 0, whatever the powers.
    pub zero: bool,
}

impl Filter {
    /// Whether it is 1.
    pub fn is_one(self) -> bool {
        self == Filter::default()
    }

    /// The first n coefficients in x², exactly.
    pub(super) fn series(self, n: usize) -> Vec<Rational> {
        let mut one = vec![Rational::zero(); n];
        one[0] = Rational::one();
        if self.zero {
            one[0] = Rational::zero();
            return one;
        }
        // cos(x/2) = Σ (−x²/4)^k/(2k)!, sinc(x/2) = Σ (−x²/4)^k/(2k+1)!.
        let function = |from: u64| {
            let next = |term: &mut Rational, k: u64| {
                let value = term.clone();
                let (a, b) = (2 * k + 1 + from, 2 * k + 2 + from);
                *term *= Rational::new((-1).into(), (4 * a * b).into());
                Some(value)
            };
            (0..n as u64).scan(Rational::one(), next).collect::<Vec<_>>()
        };
        let product = |a: &[Rational], b: &[Rational]| -> Vec<Rational> {
            (0..n).map(|k| (0..=k).map(|j| &a[j] * &b[k - j]).sum()).collect()
        };
        let inverse = |a: &[Rational]| {
            let mut values: Vec<Rational> = vec![Rational::one()];
            for k in 1..n {
                values.push(-(0..k).map(|j| &values[j] * &a[k - j]).sum::<Rational>());
            }
            values
        };
        let mut all = one;
        for (power, from) in [(self.cos, 0), (self.sinc, 1)] {
            let own = function(from);
            let values = if power < 0 { inverse(&own) } else { own };
            for _ in 0..power.unsigned_abs() {
                all = product(&all, &values);
            }
        }
        all
    }
}

impl fmt::Display for Filter {
    /// In brackets, as words have it; nothing for 1.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.zero {
            return f.write_str("[0]");
        }
        // cos(x/2) sinc(x/2) = sinc(x).
        let whole = self.cos.min(self.sinc).max(0);
        let factors = [("sinc(x)", whole), ("cos(x/2)", self.cos - whole), ("sinc(x/2)", self.sinc - whole)];
        let of = |sign: i32| {
            let factor = move |&(name, power): &(&str, i32)| match power * sign {
                n if n <= 0 => None,
                1 => Some(name.to_string()),
                n => Some(format!("{name}^{n}")),
            };
            factors.iter().filter_map(factor).collect::<Vec<_>>()
        };
        let (above, below) = (of(1), of(-1));
        if above.is_empty() && below.is_empty() {
            return Ok(());
        }
        let above = if above.is_empty() { "1".into() } else { above.join("*") };
        write!(f, "[{}]", [above].into_iter().chain(below).collect::<Vec<_>>().join("/"))
    }
}
