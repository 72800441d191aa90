//! Potentials: which particles they touch and what force they exert.

use number::{Error, Result, Ring};

/// Adds the force of a potential to the particles that it touches; one degree of freedom each.
pub trait Force<S> {
    /// The particles, by index.
    fn particles(&self) -> &[usize];

    /// `force[k] = −∂V/∂x_k` for the positions `x` of [`Force::particles`], in that order.
    fn force(&self, x: &[S], force: &mut [S]);

    /// V(x).
    fn energy(&self, x: &[S]) -> S;
}

/// V = xᵀ K x/2 over any ring.
#[derive(Clone, Debug)]
pub struct Linear<S> {
    particles: Vec<usize>,
    /// K by rows, end to end.
    entries: Vec<S>,
}

impl<S: Ring> Linear<S> {
    /// The symmetric K among `particles`.
    ///
    /// # Errors
    /// Where K is not square of their number.
    pub fn new(particles: Vec<usize>, rows: Vec<Vec<S>>) -> Result<Self> {
        let n = particles.len();
        if rows.len() != n || rows.iter().any(|row| row.len() != n) {
            return Err(Error::input(
                "stiffness",
                format!("{} rows", rows.len()),
                format!("give {n} x {n} entries"),
            ));
        }
        Ok(Linear { particles, entries: rows.concat() })
    }

    /// A spring to a wall, V = k x²/2.
    pub fn tether(particle: usize, k: S) -> Self {
        Linear { particles: vec![particle], entries: vec![k] }
    }
}

impl<S: Ring> Force<S> for Linear<S> {
    fn particles(&self) -> &[usize] {
        &self.particles
    }

    fn force(&self, x: &[S], force: &mut [S]) {
        for (row, f) in self.entries.chunks_exact(x.len().max(1)).zip(force) {
            *f = S::zero();
            row.iter().zip(x).for_each(|(k, x)| f.sub_product(k, x));
        }
    }

    fn energy(&self, x: &[S]) -> S {
        let mut twice = S::zero();
        for (row, xi) in self.entries.chunks_exact(x.len().max(1)).zip(x) {
            row.iter().zip(x).for_each(|(k, xj)| twice.add_product(&S::product(k, xj), xi));
        }
        let half = number::Rational::new(1.into(), 2.into());
        S::product(&twice, &S::from_rational(&half))
    }
}

/// The named forms, in doubles; r = x_j − x_i is the extension (for Lennard-Jones the distance).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// V = k r²/2.
    Harmonic { k: f64 },
    /// V = k r²/2 + β r⁴/4 (Fermi, Pasta, Ulam).
    Quartic { k: f64, beta: f64 },
    /// V = 4 ε ((σ/r)¹² − (σ/r)⁶), minimum −ε at r = 2^(1/6) σ.
    LennardJones { epsilon: f64, sigma: f64 },
}

impl Form {
    /// c V.
    #[must_use]
    pub fn scaled(self, c: f64) -> Form {
        match self {
            Form::Harmonic { k } => Form::Harmonic { k: c * k },
            Form::Quartic { k, beta } => Form::Quartic { k: c * k, beta: c * beta },
            Form::LennardJones { epsilon, sigma } => Form::LennardJones { epsilon: c * epsilon, sigma },
        }
    }

    /// V(r).
    pub fn energy(self, r: f64) -> f64 {
        match self {
            Form::Harmonic { k } => k * r * r / 2.0,
            Form::Quartic { k, beta } => k * r * r / 2.0 + beta * r.powi(4) / 4.0,
            Form::LennardJones { epsilon, sigma } => {
                let s6 = (sigma / r).powi(6);
                4.0 * epsilon * (s6 * s6 - s6)
            }
        }
    }

    /// V'(r).
    pub fn slope(self, r: f64) -> f64 {
        match self {
            Form::Harmonic { k } => k * r,
            Form::Quartic { k, beta } => k * r + beta * r.powi(3),
            Form::LennardJones { epsilon, sigma } => {
                let s6 = (sigma / r).powi(6);
                -24.0 * epsilon * (2.0 * s6 * s6 - s6) / r
            }
        }
    }

    /// V''(r).
    pub fn curvature(self, r: f64) -> f64 {
        match self {
            Form::Harmonic { k } => k,
            Form::Quartic { k, beta } => k + 3.0 * beta * r * r,
            Form::LennardJones { epsilon, sigma } => {
                let s6 = (sigma / r).powi(6);
                24.0 * epsilon * (26.0 * s6 * s6 - 7.0 * s6) / (r * r)
            }
        }
    }
}

/// A form between two particles, or between one and a wall at 0.
#[derive(Clone, Debug)]
pub struct Bond {
    form: Form,
    particles: Vec<usize>,
}

impl Bond {
    /// Between i and j, r = x_j − x_i.
    pub fn between(i: usize, j: usize, form: Form) -> Self {
        Bond { form, particles: vec![i, j] }
    }

    /// Between a wall at 0 and i, r = x_i.
    pub fn wall(i: usize, form: Form) -> Self {
        Bond { form, particles: vec![i] }
    }

    fn extension(x: &[f64]) -> f64 {
        match x {
            [only] => *only,
            [i, j] => j - i,
            _ => unreachable!("a bond has one or two ends"),
        }
    }

    /// V'' at the positions of its particles: the Hessian is V'' (e eᵀ), e = (−1, 1) or (1).
    pub fn curvature(&self, x: &[f64]) -> f64 {
        self.form.curvature(Bond::extension(x))
    }
}

impl Force<f64> for Bond {
    fn particles(&self) -> &[usize] {
        &self.particles
    }

    fn force(&self, x: &[f64], force: &mut [f64]) {
        let slope = self.form.slope(Bond::extension(x));
        match force {
            [only] => *only = -slope,
            [i, j] => (*i, *j) = (slope, -slope),
            _ => unreachable!("a bond has one or two ends"),
        }
    }

    fn energy(&self, x: &[f64]) -> f64 {
        self.form.energy(Bond::extension(x))
    }
}
