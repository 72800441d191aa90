//! Small systems and the truth about them: the period as a product of rational matrices, substep by substep;
//! its characteristic polynomial, Sturm's chain, and whether the squarefree part annihilates it. Nothing of
//! the library but its rationals.

use kickdrift::number::Rational;
use kickdrift::number::rational::ratio;
use nalgebra::DMatrix;
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, Zero};

type Matrix = DMatrix<Rational>;

/// A linear congruence.
pub struct Numbers(pub u64);

impl Numbers {
    pub fn below(&mut self, n: u64) -> i64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n) as i64
    }
}

/// How a system is integrated.
#[derive(Clone, Debug)]
pub enum Step {
    Clocks,
    Midpoint,
    /// Fine degrees of freedom and their substeps, the coarsest level first.
    Local(Vec<(Vec<usize>, u32)>),
    /// Clocks, in doubles.
    Dense {
        accuracy: f64,
        keeps: bool,
    },
}

#[derive(Clone, Debug)]
pub struct Given {
    pub masses: Vec<Rational>,
    /// Each with its step.
    pub potentials: Vec<(Rational, Matrix)>,
    /// For each potential 0, or 1/2: kicks at (n + phase) step.
    pub phases: Vec<Rational>,
    /// Where the atoms are, of which there is one for each three degrees of freedom.
    pub positions: Option<Vec<[i64; 3]>>,
    pub step: Step,
}

impl Given {
    /// Stiffnesses that share a few directions, of which some are held by none, some fall, and along some
    /// potentials cancel.
    pub fn random(numbers: &mut Numbers, seed: u64) -> Given {
        if seed % 24 == 5 {
            return Given::molecule(numbers);
        }
        let n = 1 + numbers.below(4) as usize;
        let step = match seed % 6 {
            0 | 1 => Step::Clocks,
            2 => Step::Midpoint,
            3 => Step::Local(levels(numbers, n)),
            _ => Step::Dense {
                accuracy: [1e-6, 1e-9][numbers.below(2) as usize],
                keeps: numbers.below(4) == 0,
            },
        };
        let whole = |x: i64| ratio(x, 1);
        let masses: Vec<Rational> = (0..n).map(|_| whole([1, 1, 2, 4][numbers.below(4) as usize])).collect();
        let steps = steps(numbers, &step);
        let count = if numbers.below(3) == 0 { n.max(2) - 1 } else { n };
        let directions: Vec<Vec<i64>> = (0..count).map(|_| direction(numbers, n)).collect();
        let is_tiny =
            matches!(&step, Step::Dense { accuracy, .. } if *accuracy < 1e-8) && numbers.below(4) == 0;
        let falls = numbers.below(4) == 0;
        let mut weights: Vec<Vec<Rational>> = steps
            .iter()
            .enumerate()
            .map(|(k, h)| {
                let weight = |_| {
                    let sign = if falls && numbers.below(4) == 0 { -1 } else { 1 };
                    let size = [0, 1, 2, 3, 4, 6][numbers.below(6) as usize];
                    // The slower, the softer.
                    ratio(sign * size, if k == 0 { 4 } else { 16 }) / (h * h).max(ratio(1, 4))
                };
                directions.iter().map(weight).collect()
            })
            .collect();
        if is_tiny {
            weights[0][0] = ratio(1 - 2 * numbers.below(2), 4096);
        }
        if steps.len() > 1 && numbers.below(3) == 0 {
            let along = numbers.below(count as u64) as usize;
            weights[1][along] = -weights[0][along].clone();
        }
        let stiffness = |weights: &Vec<Rational>| {
            DMatrix::from_fn(n, n, |i, j| {
                let part = |(c, u): (&Rational, &Vec<i64>)| c * whole(u[i] * u[j]);
                weights.iter().zip(&directions).map(part).fold(Rational::zero(), |sum, x| sum + x)
            })
        };
        let mut potentials: Vec<_> = steps.iter().cloned().zip(weights.iter().map(stiffness)).collect();
        if let Step::Local(levels) = &step
            && numbers.below(2) == 0
        {
            full_turn(&mut potentials[0], levels, &masses);
        }
        let has_phases = seed % 6 == 1;
        let phase = |_| if has_phases { ratio(numbers.below(2), 2) } else { Rational::zero() };
        let phases = potentials.iter().map(phase).collect();
        Given { masses, potentials, phases, positions: None, step }
    }

    /// Two atoms or three, bonds between them along which they stand, and sometimes what ties one of them to
    /// its place.
    fn molecule(numbers: &mut Numbers) -> Given {
        let step = Step::Dense { accuracy: 1e-6, keeps: numbers.below(6) == 0 };
        let atoms = if numbers.below(20) == 0 { 3 } else { 2 };
        let place = |numbers: &mut Numbers, k: i64| [k, numbers.below(3), numbers.below(3)];
        let positions: Vec<[i64; 3]> = (0..atoms as i64).map(|k| place(numbers, k)).collect();
        let n = 3 * atoms;
        let mass = [0; 3].map(|_| [1, 2, 4][numbers.below(3) as usize]);
        let mut potentials = Vec::new();
        let all = steps(numbers, &step);
        for (k, h) in all.iter().enumerate() {
            let hardness = ratio(1, if k == 0 { 4 } else { 16 }) / (h * h).max(ratio(1, 4));
            let mut stiffness = Matrix::zeros(n, n);
            for (i, j) in [(0, 1), (0, 2), (1, 2)].into_iter().filter(|(_, j)| *j < atoms) {
                let apart = [0, 1, 2].map(|a| positions[j][a] - positions[i][a]);
                let square: i64 = apart.iter().map(|x| x * x).sum();
                let sign = if numbers.below(8) == 0 { -1 } else { 1 };
                let weight = &hardness * ratio(sign * numbers.below(5), square);
                for (p, a) in (0..n).map(|p| (p, p % 3)).filter(|(p, _)| [i, j].contains(&(p / 3))) {
                    for (q, b) in (0..n).map(|q| (q, q % 3)).filter(|(q, _)| [i, j].contains(&(q / 3))) {
                        let sign = if p / 3 == q / 3 { 1 } else { -1 };
                        stiffness[(p, q)] += &weight * ratio(sign * apart[a] * apart[b], 1);
                    }
                }
            }
            if numbers.below(6) == 0 {
                let held = numbers.below(n as u64) as usize;
                stiffness[(held, held)] += hardness;
            }
            potentials.push((h.clone(), stiffness));
        }
        let (masses, phases) =
            ((0..n).map(|i| ratio(mass[i / 3], 1)).collect(), vec![ratio(0, 1); all.len()]);
        Given { masses, potentials, phases, positions: Some(positions), step }
    }

    /// With all steps so many times as long.
    pub fn slowed(&self, factor: &Rational) -> Given {
        let potentials = self.potentials.iter().map(|(h, k)| (h * factor, k.clone())).collect();
        Given { potentials, ..self.clone() }
    }

    /// With every stiffness so many times as large.
    pub fn scaled(&self, factor: &Rational) -> Given {
        let potentials = self.potentials.iter().map(|(h, k)| (h.clone(), k * factor.clone())).collect();
        Given { potentials, ..self.clone() }
    }

    /// With a spring more at the i-th degree of freedom, in each potential so many times its largest diagonal
    /// entry over the mass, which its norm is not below.
    pub fn sprung(&self, i: usize, part: &Rational) -> Given {
        let other = |(h, k): &(Rational, Matrix)| {
            let least = (0..self.size()).map(|j| k[(j, j)].abs() / &self.masses[j]).max().expect("one");
            let mut k = k.clone();
            k[(i, i)] += part * least * &self.masses[i];
            (h.clone(), k)
        };
        Given { potentials: self.potentials.iter().map(other).collect(), ..self.clone() }
    }

    pub fn outer(&self) -> &Rational {
        self.potentials.iter().map(|(h, _)| h).max().expect("a step")
    }

    pub fn size(&self) -> usize {
        self.masses.len()
    }

    /// A basis of what no potential holds.
    pub fn rigid(&self) -> Vec<Vec<Rational>> {
        let rows = self.potentials.iter().flat_map(|(_, k)| {
            (0..self.size())
                .map(|i| (0..self.size()).map(|j| k[(i, j)].clone()).collect())
                .collect::<Vec<_>>()
        });
        null_space(rows.collect(), self.size())
    }

    /// Whether powers of the period stay bounded, with or without what no potential holds.
    pub fn is_stable(&self, without_rigid: bool) -> bool {
        let n = self.size();
        let q = self.period();
        let rigid = if without_rigid { self.rigid() } else { Vec::new() };
        let left = n - rigid.len();
        if left == 0 {
            return true;
        }
        // Modulo the rigid motions: unit vectors beside them.
        let mut columns = rigid;
        for i in 0..n {
            let own = (0..n).map(|j| ratio(i64::from(i == j), 1)).collect::<Vec<_>>();
            let with: Vec<Vec<Rational>> = columns.iter().cloned().chain([own]).collect();
            if rank(with.clone()) == with.len() {
                columns = with;
            }
        }
        let basis = DMatrix::from_fn(2 * n, 2 * n, |i, j| {
            if i / n == j / n { columns[j % n][i % n].clone() } else { Rational::zero() }
        });
        let q = inverse(&basis).expect("a basis") * q * basis;
        let kept: Vec<usize> = (n - left..n).chain(2 * n - left..2 * n).collect();
        is_bounded(&DMatrix::from_fn(2 * left, 2 * left, |i, j| q[(kept[i], kept[j])].clone()))
    }

    /// M⁻¹ K of each potential.
    fn pulls(&self) -> Vec<Matrix> {
        let n = self.size();
        let pull = |k: &Matrix| DMatrix::from_fn(n, n, |i, j| &k[(i, j)] / &self.masses[i]);
        self.potentials.iter().map(|(_, k)| pull(k)).collect()
    }

    fn period(&self) -> Matrix {
        let (n, pulls) = (self.size(), self.pulls());
        match &self.step {
            Step::Clocks | Step::Dense { .. } => self.clocks(&pulls),
            Step::Midpoint => {
                let fast = usize::from(self.potentials[1].0 < self.potentials[0].0);
                let (h, four) = (&self.potentials[1 - fast].0, ratio(4, 1));
                let (one, zero) = (Matrix::identity(n, n), Matrix::zeros(n, n));
                let quarter = &pulls[fast] * (h * h / four);
                let solve = inverse(&(&one + &quarter)).expect("a positive matrix");
                let (from_x, from_v) = (&solve * (&one - &quarter), &solve * h.clone());
                // v' = 2 (x' - x)/h - v.
                let factor = ratio(2, 1) / h;
                let (down, across) = ((&from_x - &one) * factor.clone(), &from_v * factor - &one);
                let middle = blocks([&from_x, &from_v, &down, &across]);
                let kick = blocks([&one, &zero, &(&pulls[1 - fast] * (-h / ratio(2, 1))), &one]);
                &kick * middle * &kick
            }
            Step::Local(levels) => {
                let all = pulls.iter().fold(Matrix::zeros(n, n), |sum, own| sum + own);
                let one = Matrix::identity(n, n);
                let pulled = substepped(&all, levels, &self.potentials[0].0);
                blocks([&(&one * ratio(2, 1) - pulled), &(-&one), &one, &Matrix::zeros(n, n)])
            }
        }
    }

    /// Kick by kick.
    fn clocks(&self, pulls: &[Matrix]) -> Matrix {
        let n = self.size();
        let lcm =
            |a: Rational, b: &Rational| Rational::new(a.numer().lcm(b.numer()), a.denom().gcd(b.denom()));
        let steps: Vec<&Rational> = self.potentials.iter().map(|own| &own.0).collect();
        let period = steps[1..].iter().fold(steps[0].clone(), |t, h| lcm(t, h));
        let mut q = Matrix::identity(2 * n, 2 * n);
        let mut now = Rational::zero();
        let since = |now: &Rational, k: usize| now / steps[k] - &self.phases[k];
        while now < period {
            for (k, pull) in pulls.iter().enumerate().filter(|(k, _)| since(&now, *k).is_integer()) {
                let change = pull * q.rows(0, n) * steps[k].clone();
                let mut v = q.rows_mut(n, n);
                v -= change;
            }
            let next = |k: usize| (since(&now, k).floor() + Rational::one() + &self.phases[k]) * steps[k];
            let next = (0..steps.len()).map(next).chain([period.clone()]).min().expect("a clock");
            let moved = q.rows(n, n) * (&next - &now);
            let mut x = q.rows_mut(0, n);
            x += moved;
            now = next;
        }
        q
    }
}

/// G of x₊ − 2 x + x₋ = −G x over a step, run substep by substep from rest: forces on what is not fine stand
/// still.
fn substepped(pull: &Matrix, levels: &[(Vec<usize>, u32)], step: &Rational) -> Matrix {
    let Some(((fine, substeps), finer)) = levels.split_first() else { return pull * (step * step) };
    let n = pull.nrows();
    let two = ratio(2, 1);
    let inner = substepped(pull, finer, &(step / ratio(i64::from(*substeps), 1)));
    let one = Matrix::identity(n, n);
    let (mut before, mut now) = (one.clone(), &one - &inner / two.clone());
    for _ in 1..*substeps {
        let seen =
            DMatrix::from_fn(
                n,
                n,
                |i, j| {
                    if fine.contains(&i) { now[(i, j)].clone() } else { one[(i, j)].clone() }
                },
            );
        let next = &now * two.clone() - &before - &inner * seen;
        (before, now) = (now, next);
    }
    (one - now) * two
}

fn blocks([a, b, c, d]: [&Matrix; 4]) -> Matrix {
    let n = a.nrows();
    DMatrix::from_fn(2 * n, 2 * n, |i, j| [[a, b], [c, d]][i / n][j / n][(i % n, j % n)].clone())
}

fn levels(numbers: &mut Numbers, n: usize) -> Vec<(Vec<usize>, u32)> {
    let fine: Vec<usize> = (0..n).filter(|&i| i + 1 == n || numbers.below(2) == 0).collect();
    let mut all = vec![(fine, 2 + numbers.below(3) as u32)];
    if numbers.below(3) == 0 {
        all.push((vec![n - 1], 2));
    }
    all
}

fn steps(numbers: &mut Numbers, step: &Step) -> Vec<Rational> {
    let outer = [ratio(1, 2), ratio(1, 1), ratio(3, 2), ratio(2, 1)][numbers.below(4) as usize].clone();
    let two = [(1, 2), (1, 3), (2, 3), (3, 4), (1, 4)][numbers.below(5) as usize];
    let three = [[1, 2, 4], [2, 3, 6], [1, 3, 6], [2, 3, 4]][numbers.below(4) as usize];
    let parts = |all: &[i64]| -> Vec<Rational> {
        all.iter().map(|k| &outer * ratio(*k, all[all.len() - 1])).collect()
    };
    match step {
        Step::Local(_) => vec![outer; 1 + numbers.below(2) as usize],
        Step::Midpoint => parts(&[two.0, two.1]),
        _ => match numbers.below(8) {
            0 => vec![outer],
            // Two potentials of one clock.
            1 => [parts(&[two.0, two.1]), vec![outer.clone()]].concat(),
            2 | 3 => parts(&three),
            _ => parts(&[two.0, two.1]),
        },
    }
}

fn direction(numbers: &mut Numbers, n: usize) -> Vec<i64> {
    loop {
        let own: Vec<i64> = (0..n).map(|_| numbers.below(3) - 1).collect();
        if own.iter().any(|x| *x != 0) {
            return own;
        }
    }
}

/// Makes the last degree of freedom, which is fine, turn fully in a step: p² 2 (1 − cos(2 π/p)) over the
/// squared step.
fn full_turn((step, k): &mut (Rational, Matrix), levels: &[(Vec<usize>, u32)], masses: &[Rational]) {
    if levels.len() > 1 {
        return;
    }
    let square = match levels[0].1 {
        2 => 16,
        3 => 27,
        _ => 32,
    };
    let last = masses.len() - 1;
    k[(last, last)] = ratio(square, 1) * &masses[last] / (&*step * &*step);
}

/// Rows in echelon form: the columns of their pivots.
fn eliminated(mut rows: Vec<Vec<Rational>>, n: usize) -> (Vec<Vec<Rational>>, Vec<usize>) {
    let mut pivots = Vec::new();
    for column in 0..n {
        let Some(at) = (pivots.len()..rows.len()).find(|&i| !rows[i][column].is_zero()) else { continue };
        let place = pivots.len();
        rows.swap(place, at);
        let pivot = rows[place][column].recip();
        rows[place].iter_mut().for_each(|x| *x *= &pivot);
        let own = rows[place].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != place) {
            let factor = row[column].clone();
            row.iter_mut().zip(&own).for_each(|(x, y)| *x -= &factor * y);
        }
        pivots.push(column);
    }
    (rows, pivots)
}

fn rank(rows: Vec<Vec<Rational>>) -> usize {
    let n = rows.first().map_or(0, Vec::len);
    eliminated(rows, n).1.len()
}

fn null_space(rows: Vec<Vec<Rational>>, n: usize) -> Vec<Vec<Rational>> {
    let (rows, pivots) = eliminated(rows, n);
    let free = (0..n).filter(|j| !pivots.contains(j));
    let vector = |j: usize| {
        let entry = |i: usize| match pivots.iter().position(|&pivot| pivot == i) {
            Some(row) => -rows[row][j].clone(),
            None => ratio(i64::from(i == j), 1),
        };
        (0..n).map(entry).collect()
    };
    free.map(vector).collect()
}

fn inverse(m: &Matrix) -> Option<Matrix> {
    let n = m.nrows();
    let row = |i: usize| {
        let unit = (0..n).map(move |j| ratio(i64::from(i == j), 1));
        (0..n).map(|j| m[(i, j)].clone()).chain(unit).collect()
    };
    let (rows, pivots) = eliminated((0..n).map(row).collect(), n);
    (pivots.len() == n).then(|| DMatrix::from_fn(n, n, |i, j| rows[i][n + j].clone()))
}

/// Coefficients, the constant one first.
type Polynomial = Vec<Rational>;

fn trimmed(mut p: Polynomial) -> Polynomial {
    while p.last().is_some_and(Zero::is_zero) {
        p.pop();
    }
    p
}

fn derivative(p: &Polynomial) -> Polynomial {
    trimmed(p.iter().enumerate().skip(1).map(|(k, c)| c * ratio(k as i64, 1)).collect())
}

/// Quotient and rest.
fn divided(p: &Polynomial, by: &Polynomial) -> (Polynomial, Polynomial) {
    let (mut rest, last) = (p.clone(), by.last().expect("not 0"));
    let mut quotient = vec![Rational::zero(); (p.len() + 1).saturating_sub(by.len())];
    while rest.len() >= by.len() {
        let shift = rest.len() - by.len();
        let factor = rest.last().expect("not empty") / last;
        by.iter().enumerate().for_each(|(k, c)| rest[k + shift] -= &factor * c);
        rest.pop();
        quotient[shift] = factor;
    }
    (quotient, trimmed(rest))
}

fn squarefree(p: &Polynomial) -> Polynomial {
    let (mut a, mut b) = (p.clone(), derivative(p));
    while !b.is_empty() {
        let rest = divided(&a, &b).1;
        (a, b) = (b, rest);
    }
    divided(p, &a).0
}

fn value(p: &Polynomial, x: &Rational) -> Rational {
    p.iter().rev().fold(Rational::zero(), |sum, c| sum * x + c)
}

/// Of a squarefree one in [lo, hi].
fn real_roots(p: &Polynomial, lo: &Rational, hi: &Rational) -> usize {
    let mut chain = vec![p.clone(), derivative(p)];
    while chain[chain.len() - 1].len() > 1 {
        let rest = divided(&chain[chain.len() - 2], &chain[chain.len() - 1]).1;
        chain.push(rest.into_iter().map(|c| -c).collect());
    }
    let changes = |x: &Rational| {
        let signs: Vec<bool> =
            chain.iter().map(|p| value(p, x)).filter(|v| !v.is_zero()).map(|v| v.is_positive()).collect();
        signs.windows(2).filter(|two| two[0] != two[1]).count()
    };
    changes(lo) - changes(hi) + usize::from(value(p, lo).is_zero())
}

/// Whether all powers of a matrix with the eigenvalues of its inverse are bounded: they lie on the unit
/// circle, and none has a chain.
fn is_bounded(q: &Matrix) -> bool {
    let n = q.nrows();
    // Faddeev and Leverrier, over the integers: of d q.
    let d = q.iter().fold(BigInt::one(), |lcm, x| lcm.lcm(x.denom()));
    let whole = q.map(|x| x.numer() * (&d / x.denom()));
    let (mut characteristic, mut power) = (vec![Rational::one()], BigInt::one());
    let mut m = DMatrix::<BigInt>::identity(n, n);
    for k in 1..=n {
        let product = &whole * &m;
        let c = -product.trace() / BigInt::from(k);
        m = product + DMatrix::identity(n, n) * c.clone();
        power *= &d;
        characteristic.push(Rational::new(c, power.clone()));
    }
    characteristic.reverse();
    assert!((0..=n).all(|k| characteristic[k] == characteristic[n - k]), "no eigenvalue without its inverse");
    let simple = squarefree(&characteristic);
    // Simple eigenvalues have no chains.
    if simple.len() < characteristic.len() {
        let one = Matrix::identity(n, n);
        let image = simple.iter().rev().fold(Matrix::zeros(n, n), |sum, c| sum * q + &one * c.clone());
        if image.iter().any(|x| !x.is_zero()) {
            return false;
        }
    }
    // In λ + 1/λ, by λ^k + λ^-k.
    let half = n / 2;
    let (mut before, mut own): (Polynomial, Polynomial) =
        (vec![ratio(2, 1)], vec![Rational::zero(), Rational::one()]);
    let mut turned = vec![characteristic[half].clone()];
    for k in 1..=half {
        turned.resize(turned.len().max(own.len()), Rational::zero());
        own.iter().enumerate().for_each(|(i, c)| turned[i] += &characteristic[half + k] * c);
        let mut next = vec![Rational::zero()];
        next.extend(own.iter().cloned());
        before.iter().enumerate().for_each(|(i, c)| next[i] -= c);
        (before, own) = (own, next);
    }
    let turned = squarefree(&turned);
    real_roots(&turned, &ratio(-2, 1), &ratio(2, 1)) + 1 == turned.len()
}
