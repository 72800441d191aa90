//! The half period of systems on a line, modulo a prime, with bounds on its invariants.
//!
//! *Degree.* Minors of size k of a product are sums of products of minors of its factors (Cauchy and Binet).
//! Those of a kick K₀ + s K₁ have a degree of at most min(k, rank K₁). Those of a drift, times δ(s) = Π det
//! (islands of M that vary), have at most the rank of M₁ as theirs, since minors of M⁻¹ are those of M over
//! det M (Jacobi). The coefficients c_k of χ are such sums over S = Bᵀ C, two half periods.
//!
//! *Length.* On |s| = 1 no entry of kicks and drifts exceeds the sum of its coefficients' sizes, so no
//! product of their row sums is exceeded by a row sum of H or Hᵀ. A polynomial that is at most b on |s| = 1
//! has no coefficient beyond b (Cauchy).

use std::collections::BTreeSet;

use nalgebra::DMatrix;
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, Zero};

use super::line::Line;
use crate::exact::modular;
use crate::half::compose::{Kick, Program, Row, State};
use crate::linear::frame::Frame;
use crate::linear::sparse::Symmetric;
use crate::linear::system::{Potential, System};
use clocks::schedule::Weight;
use number::{PrimeField, Rational, Result, prime_fields, ratio, to_f64};

/// x₀ + s x₁.
type Linear<T> = [T; 2];

/// The masses of an island that vary: c (A + s B), A and B of whole numbers without a common factor.
struct Masses {
    dofs: Vec<usize>,
    c: Rational,
    line: DMatrix<Linear<BigInt>>,
}

/// The half period on a line.
pub(super) struct Half {
    /// A system with the clocks of almost all of them.
    generic: System,
    frame: Frame,
    program: Program<Linear<Rational>>,
    /// The islands whose masses vary; `program` has no rows of M⁻¹ there.
    masses: Vec<Masses>,
    /// The rank of what M gains with s.
    rank_of_masses: usize,
    /// The ranks of what each clock's kick gains with s.
    ranks: Vec<usize>,
    /// A common denominator e of M⁻¹, but for δ.
    unit: BigInt,
    /// Integer multiples: the entries of `scale` δ^E S are in ℤ\[s\], and those of `scale` e δ^E H.
    scale: BigInt,
    /// Whether D = Aᵀ, so that S + 1 = Dᵀ A = A², and 0 and −1 are not always eigenvalues of (A − 1)/2: at
    /// some places modulo a prime.
    pub is_square: bool,
    /// Whether S is self-adjoint in the metric of M, as it is where potentials commute.
    pub is_selfadjoint: bool,
    /// A matrix that commutes with S and with every matrix that does; its eigenspaces have no μ in common
    /// that could couple.
    symmetry: Option<DMatrix<Rational>>,
}

/// Eigenspaces of a symmetry modulo a prime: coordinates in which S is made of blocks.
pub(super) struct Eigenspaces {
    sizes: Vec<usize>,
    from: DMatrix<u64>,
    to: DMatrix<u64>,
}

/// Any places.
pub(super) const PLACES: [u64; 3] = [0x9e37_79b9, 0x7f4a_7c15, 0x85eb_ca6b];

/// Of so many primes one has all eigenvalues of a symmetry, or none is looked for.
const MOST_PRIMES: usize = 40;

impl Half {
    /// The half period of the systems on a line.
    ///
    /// # Errors
    /// As [`Line::at`].
    pub fn new(line: &Line) -> Result<Half> {
        let (frame, generic) = (line.frame()?, generic(line)?);
        let mut program = Program::new(&generic).map(|x| [x.clone(), Rational::zero()]);
        let mut ranks = Vec::new();
        for (k, clock) in generic.clocks().iter().enumerate() {
            let [lo, hi] = line.ends.each_ref().map(|ends| sum(ends, clock));
            let ticks = Rational::from_integer(generic.schedule().clocks()[k].step().into());
            let factor = generic.tick() * generic.tick() * ticks;
            let mut gained = hi;
            gained.add_all(&lo.scaled(&ratio(-1, 1)));
            ranks.push(gained.size() - gained.null_space().len());
            let rows = rows(&lo, &gained, &factor);
            let islands: BTreeSet<_> = rows.iter().map(|(i, _)| program.island_of[*i]).collect();
            program.kicks[k] = Kick { rows, islands: islands.into_iter().collect() };
        }
        let [lo, hi] = line.ends.each_ref().map(System::mass);
        let mut gained = hi.clone();
        gained.add_all(&lo.scaled(&ratio(-1, 1)));
        let rank_of_masses = gained.size() - gained.null_space().len();
        let varying =
            program.islands.iter().filter(|island| island.iter().any(|&i| !gained.row(i).is_empty()));
        let masses: Vec<_> = varying
            .map(|varying| Masses::between(varying, [lo.restricted(varying), gained.restricted(varying)]))
            .collect();
        masses.iter().flat_map(|mass| &mass.dofs).for_each(|&i| program.inverse_mass[i].clear());
        let is_selfadjoint = line.commutes;
        let [unit, scale] = [BigInt::one(), BigInt::one()];
        let symmetry = line.symmetry.clone().filter(|_| frame.rigid.is_empty());
        let mut half = Half {
            generic,
            frame,
            program,
            masses,
            rank_of_masses,
            ranks,
            unit,
            scale,
            is_square: false,
            is_selfadjoint,
            symmetry,
        };
        (half.unit, half.scale) = half.common();
        half.is_square = half.seems_square();
        if !prime_fields().take(MOST_PRIMES).any(|field| half.eigenspaces(&field).is_some()) {
            half.symmetry = None;
        }
        Ok(half)
    }

    fn seems_square(&self) -> bool {
        let pair = prime_fields().find_map(|field| Some((field, self.residues(&field)?)));
        let (field, program) = pair.expect("primes enough");
        let mut places = PLACES.into_iter().filter_map(|s| self.at(&field, &program, field.of(s))).peekable();
        let is_no_end = |at: &At| {
            let f = modular::characteristic(&field, at.blocks[0].clone());
            let value = |x: u64| f.iter().rev().fold(0, |sum, &c| field.add(field.mul(sum, x), c));
            value(at.unit) != 0 && value(field.sub(0, at.unit)) != 0
        };
        places.peek().is_some_and(is_no_end) && places.all(|at| at.is_square())
    }

    /// An integer multiple: the entries of it times δ^E times what [`At::product`] stands for are in ℤ\[s\].
    pub fn scale(&self) -> BigInt {
        if self.is_square { 2 * &self.scale * &self.unit } else { self.scale.clone() }
    }

    /// Whether there is a symmetry, so that only primes that have its eigenvalues serve.
    pub fn is_symmetric(&self) -> bool {
        self.symmetry.is_some()
    }

    /// The eigenspaces of the symmetry; `None` where there is none, and where the prime does not have all of
    /// its eigenvalues.
    pub fn eigenspaces(&self, field: &PrimeField) -> Option<Eigenspaces> {
        let symmetry = self.symmetry.as_ref()?;
        let entries = symmetry.iter().map(|x| field.of_rational(x)).collect::<Option<Vec<_>>>()?;
        let n = symmetry.nrows();
        let symmetry = DMatrix::from_column_slice(n, n, &entries);
        let minimal = modular::squarefree(field, modular::characteristic(field, symmetry.clone()));
        let spaces = field.roots(&minimal)?.into_iter().map(|root| {
            let mut shifted = symmetry.clone();
            (0..n).for_each(|i| shifted[(i, i)] = field.sub(shifted[(i, i)], root));
            modular::kernel(field, shifted)
        });
        let spaces: Vec<_> = spaces.collect();
        let columns: Vec<u64> = spaces.iter().flatten().flatten().copied().collect();
        if columns.len() != n * n {
            return None;
        }
        let from = DMatrix::from_column_slice(n, n, &columns);
        let (to, _) = modular::inverse(field, from.clone())?;
        Some(Eigenspaces { sizes: spaces.iter().map(Vec::len).collect(), from, to })
    }

    /// m, the size of S.
    pub fn size(&self) -> usize {
        self.frame.kept.len()
    }

    /// Kicks of the half period, those at one instant as one.
    fn kicks(&self) -> usize {
        self.generic.schedule().half_period().filter(|event| event.clocks().next().is_some()).count()
    }

    /// E: the drifts of two half periods.
    fn drifts(&self) -> usize {
        2 * self.generic.schedule().half_period().filter(|event| event.drift > 0).count()
    }

    /// The operations of one evaluation, roughly.
    pub fn cost(&self) -> f64 {
        let (n, m) = (self.program.size() as f64, self.size() as f64);
        let varying: f64 = self.masses.iter().map(|mass| (mass.dofs.len() as f64).powi(2)).sum();
        let entries = self.program.entries().count() as f64 + varying;
        let eliminations: f64 = self.masses.iter().map(|mass| 2.0 * (mass.dofs.len() as f64).powi(3)).sum();
        (self.kicks() as f64 + 1.0) * 2.0 * m * (entries + n)
            + eliminations
            + 12.0 * m.powi(3)
            + 200.0 * m.powi(2)
    }

    /// The degree of δ^E.
    pub fn degree_of_masses(&self) -> usize {
        self.drifts() * self.rank_of_masses
    }

    /// The most that δ^E c_k can have as its degree.
    pub fn degree(&self, k: usize) -> usize {
        let kicks = self.generic.schedule().half_period().flat_map(|event| event.clocks());
        2 * kicks.map(|clock| self.ranks[clock].min(k)).sum::<usize>() + self.degree_of_masses()
    }

    /// More than log₂ of row sums on |s| = 1: of [`Half::scale`] δ^E times the product, of that times 1, and
    /// how much more of `scale` e δ^E H than of `scale` δ^E S.
    pub fn bits(&self) -> [f64; 3] {
        let size = |x: &BigInt| to_f64(&Rational::from_integer(x.abs()));
        let row = |row: &Row<Linear<Rational>>| {
            row.iter().flat_map(|(_, x)| x).map(|x| to_f64(&x.abs())).sum::<f64>()
        };
        let largest = |rows: &mut dyn Iterator<Item = f64>| rows.fold(0.0, f64::max);
        let kicks: Vec<f64> = self
            .program
            .kicks
            .iter()
            .map(|kick| largest(&mut kick.rows.iter().map(|(_, pairs)| row(pairs))))
            .collect();
        // An entry of the adjugate is at most the product of the sums of the other rows.
        let (mut inverse, mut masses) = (largest(&mut self.program.inverse_mass.iter().map(row)), 0.0);
        for mass in &self.masses {
            let sums = mass.line.row_iter().map(|row| row.iter().flatten().map(size).sum::<f64>());
            let sums: Vec<f64> = sums.collect();
            inverse = inverse.max(sums.iter().map(|x| 1.0 / x).sum::<f64>() / to_f64(&mass.c));
            masses += sums.iter().map(|x| x.log2()).sum::<f64>();
        }
        let events: Vec<(f64, f64)> = self
            .generic
            .schedule()
            .half_period()
            .map(|event| (event.drift as f64 * inverse, event.clocks().map(|clock| kicks[clock]).sum()))
            .collect();
        // Any unit of momentum: that in which drifts and kicks are alike.
        let (drift, kick) = events.iter().fold((0.0, 0.0), |sum, pair| (sum.0 + pair.0, sum.1 + pair.1));
        let unit = if drift > 0.0 && kick > 0.0 { (kick / drift).sqrt() } else { 1.0 };
        let path = events.iter().map(|(x, k)| (1.0 + x * unit).log2() + (1.0 + k / unit).log2()).sum::<f64>();
        let rigid: f64 = self.frame.rigid.iter().flat_map(|(_, n)| n).map(|x| to_f64(&x.abs())).sum();
        let framed = 4.0 * (1.0 + rigid).log2();
        let scale = self.scale.bits() as f64 + self.drifts() as f64 * masses;
        let more = self.unit.bits() as f64 + unit.log2().abs();
        let sums = [1.001 * (scale + 2.0 * path + framed) + 4.0, 1.001 * scale + 1.0, 1.001 * more + 1.0];
        // `scale` e δ^E (A − 1) in place of `scale` δ^E S.
        if self.is_square { [sums[0] + sums[2] + 1.0, sums[1] + sums[2] + 1.0, sums[2]] } else { sums }
    }

    /// e, and f^(2 kicks) with a common denominator f, times that of the frame squared: over momenta p/e
    /// every kick is 1/f of an integer one, every drift an integer one over δ.
    fn common(&self) -> (BigInt, BigInt) {
        let lcm = |lcm: BigInt, x: &Rational| lcm.lcm(x.denom());
        let e = self.program.inverse_mass.iter().flatten().map(|(_, x)| &x[0]).fold(BigInt::one(), lcm);
        let e = self.masses.iter().map(|mass| mass.c.recip()).fold(e, |e, x| lcm(e, &x));
        let twice = Rational::from_integer(&e * 2);
        let entries = self.program.kicks.iter().flat_map(|kick| &kick.rows).flat_map(|(_, row)| row);
        let f = entries.flat_map(|(_, x)| x).fold(BigInt::one(), |f, x| lcm(f, &(x / &twice)));
        let delta = self.frame.denominator();
        (e, num_traits::pow(f, 2 * self.kicks()) * &delta * &delta)
    }

    /// The program modulo a prime; `None` where that divides a denominator.
    pub fn residues(&self, field: &PrimeField) -> Option<Program<Linear<u64>>> {
        let constants = self.frame.rigid.iter().flat_map(|(_, n)| n);
        let masses = self.masses.iter().map(|mass| &mass.c);
        let all = self.program.entries().flatten().chain(constants);
        let sound = all.into_iter().all(|x| field.of_rational(x).is_some())
            && masses.into_iter().all(|c| field.of_rational(&c.recip()).is_some());
        let of = |x: &Rational| field.of_rational(x).expect("just seen");
        sound.then(|| self.program.map(|x| x.each_ref().map(of)))
    }

    /// S and H at s modulo the prime; `None` where M is singular.
    pub fn at(&self, field: &PrimeField, program: &Program<Linear<u64>>, s: u64) -> Option<At> {
        let at = |x: &Linear<u64>| field.add(x[0], field.mul(s, x[1]));
        let mut program = program.map(at);
        let mut delta = field.of(1);
        for mass in &self.masses {
            let line = mass.line.map(|x| at(&x.each_ref().map(|x| field.of_big(x))));
            let (inverse, determinant) = modular::inverse(field, line)?;
            delta = field.mul(delta, determinant);
            let c = field.of_rational(&mass.c.recip())?;
            for (a, &i) in mass.dofs.iter().enumerate() {
                let entry = |(b, &j): (usize, &usize)| (j, field.mul(c, inverse[(a, b)]));
                program.inverse_mass[i] = mass.dofs.iter().enumerate().map(entry).collect();
            }
        }
        let rows = self.run(field, &program);
        let m = self.size();
        let block = |rows: &[Vec<u64>], first: usize| DMatrix::from_fn(m, m, |i, j| rows[i][first + j]);
        let [a, b, c, d] = [block(&rows.x, 0), block(&rows.x, m), block(&rows.p, 0), block(&rows.p, m)];
        let scale = field.of_big(&self.scale);
        let unit = field.mul(scale, field.of_big(&self.unit));
        let product = match self.is_square {
            true => DMatrix::from_fn(m, m, |i, j| {
                field.mul(unit, field.sub(a[(i, j)], field.of(u64::from(i == j))))
            }),
            false => modular::times(field, &b.transpose(), &c).map(|x| field.mul(scale, x)),
        };
        let blocks = [a, b, c, d].map(|matrix| matrix.map(|x| field.mul(unit, x)));
        Some(At { product, blocks, unit, delta: field.power(delta, self.drifts() as u64) })
    }

    /// The half period in the frame's coordinates: A and B as rows of positions, C and D as those of momenta.
    fn run(&self, field: &PrimeField, program: &Program<u64>) -> Rows {
        let (n, m) = (program.size(), self.size());
        let of = |x: &Rational| field.of_rational(x).expect("seen with the program");
        let mut rows = Rows { field: *field, x: vec![vec![0; 2 * m]; n], p: vec![vec![0; 2 * m]; n] };
        for k in 0..m {
            rows.x[self.frame.kept[k]][k] = field.of(1);
            for (i, value) in self.frame.momentum(k) {
                rows.p[i][m + k] = of(&value);
            }
        }
        program.run(self.generic.schedule().half_period(), &mut rows);
        let kept = |row: &Vec<u64>, i: usize, x: &[Vec<u64>]| {
            let mut row = row.clone();
            for (index, n) in &self.frame.rigid {
                let factor = field.sub(0, of(&n[i]));
                add(field, &mut row, factor, &x[*index]);
            }
            row
        };
        let x = self.frame.kept.iter().map(|&i| kept(&rows.x[i], i, &rows.x)).collect();
        let p = self.frame.kept.iter().map(|&i| rows.p[i].clone()).collect();
        Rows { field: *field, x, p }
    }
}

/// A place on the line modulo a prime.
pub(super) struct At {
    /// [`Half::scale`] times S, or (A − 1)/2 where D = Aᵀ.
    pub product: DMatrix<u64>,
    /// A, B, C, D, times `unit`.
    pub blocks: [DMatrix<u64>; 4],
    /// `scale` e.
    unit: u64,
    /// δ^E.
    pub delta: u64,
}

impl At {
    /// Whether D = Aᵀ.
    pub fn is_square(&self) -> bool {
        self.blocks[3] == self.blocks[0].transpose()
    }
}

impl Eigenspaces {
    /// The blocks of what commutes with the symmetry.
    pub fn blocks(&self, field: &PrimeField, m: &DMatrix<u64>) -> Vec<DMatrix<u64>> {
        let m = modular::times(field, &self.to, &modular::times(field, m, &self.from));
        let mut first = 0;
        let block = |&size: &usize| {
            first += size;
            m.view((first - size, first - size), (size, size)).into_owned()
        };
        self.sizes.iter().map(block).collect()
    }
}

/// A system of the line with all clocks and all entries of M that any of them has.
fn generic(line: &Line) -> Result<System> {
    let [lo, hi] = &line.ends;
    let acts = |potential: &&Potential| !sum(lo, potential).is_zero() || !sum(hi, potential).is_zero();
    let mut clocks: Vec<_> = lo
        .potentials()
        .iter()
        .filter(acts)
        .map(|potential| (potential.step.clone(), potential.phase.clone()))
        .collect();
    clocks.sort();
    clocks.dedup();
    let masses: BTreeSet<_> = line.ends.iter().flat_map(|end| end.mass().places()).collect();
    // A linear function of s that is not 0 vanishes at one s at most.
    let mut k = 2;
    loop {
        let found = line.at(&ratio(1, k))?;
        if found.clocks().len() == clocks.len() && found.mass().places().count() == masses.len() {
            return Ok(found);
        }
        k += 1;
    }
}

/// The stiffness of all potentials with the clock of one.
fn sum(system: &System, clock: &Potential) -> Symmetric {
    let mut sum = Symmetric::zero(system.size());
    let filter = system
        .potentials()
        .iter()
        .filter(|potential| (&potential.step, &potential.phase) == (&clock.step, &clock.phase));
    filter.for_each(|potential| sum.add_all(&potential.stiffness));
    sum
}

/// The rows of factor (K₀ + s K₁) that are not 0.
fn rows(constant: &Symmetric, gained: &Symmetric, factor: &Rational) -> Vec<(usize, Row<Linear<Rational>>)> {
    let row = |i: usize| {
        let places =
            constant.row(i).keys().chain(gained.row(i).keys().filter(|j| constant.get(i, **j).is_zero()));
        let entry = |&j: &usize| (j, [constant.get(i, j) * factor, gained.get(i, j) * factor]);
        places.map(entry).collect::<Vec<_>>()
    };
    (0..constant.size()).map(|i| (i, row(i))).filter(|(_, row)| !row.is_empty()).collect()
}

impl Masses {
    /// The masses of these degrees of freedom, from M₀ and its growth along the line.
    fn between(dofs: &[usize], line: [Symmetric; 2]) -> Masses {
        let entries =
            || line.iter().flat_map(|symmetric| symmetric.places().map(|(i, j)| symmetric.get(i, j)));
        let denominator = entries().fold(BigInt::one(), |lcm, x| lcm.lcm(x.denom()));
        let whole = |x: &Rational| (x * Rational::from_integer(denominator.clone())).to_integer();
        let common = entries().fold(BigInt::zero(), |gcd, x| gcd.gcd(&whole(&x)));
        let n = dofs.len();
        let line =
            DMatrix::from_fn(n, n, |i, j| line.each_ref().map(|line| whole(&line.get(i, j)) / &common));
        Masses { dofs: dofs.to_vec(), c: Rational::new(common, denominator), line }
    }
}

struct Rows {
    field: PrimeField,
    x: Vec<Vec<u64>>,
    p: Vec<Vec<u64>>,
}

impl State<u64> for Rows {
    fn drift(&mut self, program: &Program<u64>, island: usize, ticks: u64) {
        let ticks = self.field.of(ticks);
        for &i in &program.islands[island] {
            for (j, a) in &program.inverse_mass[i] {
                add(&self.field, &mut self.x[i], self.field.mul(ticks, *a), &self.p[*j]);
            }
        }
    }

    fn kick(&mut self, i: usize, row: &Row<u64>, weight: Weight) {
        let half = self.field.sub(0, self.field.invert(self.field.of(2)));
        let weight = if weight == Weight::Full { self.field.sub(0, self.field.of(1)) } else { half };
        for (j, a) in row {
            add(&self.field, &mut self.p[i], self.field.mul(weight, *a), &self.x[*j]);
        }
    }
}

fn add(field: &PrimeField, row: &mut [u64], factor: u64, other: &[u64]) {
    row.iter_mut().zip(other).for_each(|(x, &y)| *x = field.add(*x, field.mul(factor, y)));
}
