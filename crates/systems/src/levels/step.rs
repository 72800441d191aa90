//! One outer step of a method as one matrix, by series and squarings: no eigenvector of the fast stiffness
//! enters, so it can be held against the kernel.

use faer::linalg::solvers::Solve;
use faer::{Mat, Scale};

use super::method::Method;
use super::rigid::Hessians;
use words::Trigonometric;

/// Terms of the series of cos and sin at arguments up to 1: the next is below 10^-18.
const TERMS: u32 = 10;

/// cos(√F t) and sin(√F t)/√F.
struct Turn {
    cos: Mat<f64>,
    sin: Mat<f64>,
}

impl Turn {
    fn new(fast: &Mat<f64>, size: f64, t: f64) -> Turn {
        let squarings = (size.sqrt() * t).log2().ceil().max(0.0) as i32;
        let (one, small) = (Mat::<f64>::identity(fast.nrows(), fast.nrows()), t / 2.0f64.powi(squarings));
        // Horner's rule from the last term on.
        let series = |first: f64| {
            (1..=TERMS).rev().fold(one.clone(), |sum, n| {
                let n = 2.0 * f64::from(n) + first;
                &one - (fast * &sum) * Scale(small * small / (n * (n - 1.0)))
            })
        };
        let start = Turn { cos: series(0.0), sin: series(1.0) * Scale(small) };
        // sin 2x = 2 cos x sin x, cos 2x = 2 cos² x − 1.
        (0..squarings).fold(start, |Turn { cos, sin }, _| {
            let sin = (&cos * sin) * Scale(2.0);
            Turn { cos: (&cos * &cos) * Scale(2.0) - &one, sin }
        })
    }
}

impl Hessians {
    /// max ln |λ|/H over the eigenvalues of one outer step of a method, in doubles.
    pub fn growth_of_step(&self, method: Method, step: f64, inner_steps: u64) -> f64 {
        if method.has_inner_steps() {
            return self.growth_of_period(step, inner_steps);
        }
        let largest = self.step(method, step).eigenvalues();
        largest.map_or(f64::NAN, |all| all.into_iter().map(|x| x.norm()).fold(1.0, f64::max)).ln() / step
    }

    fn step(&self, method: Method, h: f64) -> Mat<f64> {
        let (n, fast) = (self.size(), &self.fast);
        let one = Mat::<f64>::identity(n, n);
        let size = crate::half::norm::frobenius(fast);
        let turn = |t: f64| Turn::new(fast, size, t);
        let sinc = |t: f64| turn(t).sin * Scale(1.0 / t);
        let Method::Trigonometric(trigonometric) = method else {
            // (1 − A/2)⁻¹ (1 + A/2), A = h [[0, 1], [−F, 0]].
            let half = blocks([
                &Mat::zeros(n, n),
                &(&one * Scale(h / 2.0)),
                &(fast * Scale(-h / 2.0)),
                &Mat::zeros(n, n),
            ]);
            let whole = Mat::<f64>::identity(2 * n, 2 * n);
            return self.kicked(h, &self.slow, (&whole - &half).partial_piv_lu().solve(&whole + &half));
        };
        let filter = match trigonometric {
            Trigonometric::Impulse => one.clone(),
            Trigonometric::Gautschi | Trigonometric::Short => sinc(h / 2.0),
            Trigonometric::Linear => sinc(h / 2.0) * sinc(h / 2.0),
            Trigonometric::Long | Trigonometric::HairerLubich => sinc(h),
        };
        let Turn { cos, sin } = turn(h);
        if trigonometric.is_two_step() {
            // ψ = γ², φ = 1.
            let x = cos * Scale(2.0) - &filter * &filter * &self.slow * Scale(h * h);
            return blocks([&x, &(&one * Scale(-1.0)), &one, &Mat::zeros(n, n)]);
        }
        let bent = (fast * &sin) * Scale(-1.0);
        self.kicked(h, &(&filter * &self.slow * &filter), blocks([&cos, &sin, &bent, &cos]))
    }

    /// K G K.
    fn kicked(&self, h: f64, slow: &Mat<f64>, inside: Mat<f64>) -> Mat<f64> {
        let one = Mat::<f64>::identity(slow.nrows(), slow.nrows());
        let kick = blocks([&one, &Mat::zeros(slow.nrows(), slow.nrows()), &(slow * Scale(-h / 2.0)), &one]);
        &kick * inside * &kick
    }
}

fn blocks(all: [&Mat<f64>; 4]) -> Mat<f64> {
    let n = all[0].nrows();
    Mat::from_fn(2 * n, 2 * n, |i, j| all[2 * (i / n) + j / n][(i % n, j % n)])
}

#[cfg(test)]
mod tests {
    use super::super::{Kernel, Outer};
    use super::*;
    use nalgebra::DMatrix;

    #[test]
    fn growth_of_a_step_is_that_of_the_kernel() {
        let fast = DMatrix::from_row_slice(2, 2, &[1.0, 0.3, 0.3, 0.6]);
        let slow = DMatrix::from_row_slice(2, 2, &[0.08, 0.05, 0.05, 0.1]);
        let hessians = Hessians::new(&fast, &slow, 1e-6).unwrap();
        for method in Method::all() {
            let kernel = Kernel::new(&hessians).unwrap().with_method(method);
            let mut grown = 0;
            for k in 1..200 {
                let step = f64::from(k) * 0.04;
                let [own, other] =
                    [hessians.growth_of_step(method, step, 6), kernel.growth(&Outer::new(step, 6).unwrap())];
                // At an edge multipliers are double: right to the root of some 1e-15.
                assert!((own - other).abs() < 1e-5 / step, "{method} {step}: {own} {other}");
                grown += usize::from(own > 1e-3);
            }
            // Where S < F, Hairer and Lubich's filter leaves no step to grow.
            assert_eq!(grown > 0, method.name() != "hairer-lubich", "{method}");
        }
    }
}
