//! Stiffnesses by reference to NumPy's files: Hessians as people measure them, in doubles.
//!
//! ```json
//! {
//!     "schema": "kickdrift/system/1",
//!     "mass_weighted": true,
//!     "masses": {"npz": "water.npz", "array": "masses"},
//!     "positions": {"npz": "water.npz", "array": "positions"},
//!     "accuracy": 1e-6,
//!     "potentials": [
//!         {"name": "bonded", "step": "1/2000", "stiffness": {"npz": "water.npz", "array": "fast"}},
//!         {"name": "rest", "step": "1/250", "stiffness": {"npy": "slow.npy"}}
//!     ]
//! }
//! ```
//!
//! Rigid motions are projected out: by `positions` three translations and three rotations, with `"periodic": true` the translations alone,
//! else the null space of the total, if it is no larger than that.
//!
//! `"hydrogen_mass": 3.024` makes hydrogens (up to 1.1) heavier at the cost of the nearest heavy particle. `"constraints": "h-bonds"`, or pairs,
//! holds distances; then each potential has a `force` by reference, at the positions and not mass-weighted (see `held`).
//! `"keep_rigid": true` projects no rigid motions out: there are none, as of atoms among others that stand still.

use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

use faer::Mat;
use nalgebra::DMatrix;
use num_traits::One;
use serde::Deserialize;
use serde_json::Value;

use super::array::{Arrays, Reference};
use super::document::{LARGEST, Number, no_system};
use super::held::{Constraints, Particles, reweigh};
use crate::error::{Error, Result};
use crate::number::Rational;
use crate::number::rational::{from_f64_exact, to_f64};
use crate::system::friction::Friction;
use crate::system::levels::{Cells, Hessians, Kernel, Outer, rigid_motions, translations};
use crate::system::stretches::{Stretch, cover};
use crate::system::{Analysis, Holds, Limits, Potential, Route, Symmetric, System};

/// How well a measured stiffness is known unless its file says so: a Hessian by differences is good to some 10^-6 of its norm.
const USUAL_ACCURACY: f64 = 1e-6;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(rename = "schema")]
    _schema: String,
    #[serde(rename = "title")]
    _title: Option<String>,
    #[serde(rename = "time_unit")]
    _time_unit: Option<String>,
    #[serde(default)]
    mass_weighted: bool,
    masses: Option<Reference>,
    positions: Option<Reference>,
    #[serde(default)]
    periodic: bool,
    accuracy: Option<Number>,
    constraints: Option<Constraints>,
    hydrogen_mass: Option<Number>,
    #[serde(default)]
    keep_rigid: bool,
    potentials: Vec<PotentialDocument>,
    #[serde(rename = "labels")]
    _labels: Option<Vec<String>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PotentialDocument {
    name: Option<String>,
    step: Number,
    scale: Option<Number>,
    stiffness: Reference,
    force: Option<Reference>,
}

/// Measured stiffnesses with their clocks.
#[derive(Clone, Debug)]
pub(super) struct Measured {
    /// By increasing step.
    pub(super) potentials: Vec<(Rational, DMatrix<f64>)>,
    /// Of each degree of freedom; `None`: the stiffnesses are mass-weighted and no masses were given.
    masses: Option<Vec<f64>>,
    positions: Option<Vec<[f64; 3]>>,
    is_weighted: bool,
    is_periodic: bool,
    accuracy: f64,
    keeps_rigid: bool,
    /// The stiffnesses of steps that several potentials have: each is known to its own norm.
    shares: Vec<(Rational, Vec<DMatrix<f64>>)>,
    /// Particles whose distances are held; the stiffnesses are bent by them.
    held: Vec<[usize; 2]>,
    scales: Vec<Scale>,
    kernel: Arc<OnceLock<Kernel>>,
}

/// The scale of a potential as it stands in the file.
#[derive(Clone, Debug)]
struct Scale {
    index: usize,
    name: Option<String>,
    step: Rational,
    scale: f64,
}

impl Scale {
    fn is_at(&self, path: &str) -> bool {
        let key = path.strip_prefix("potentials.").and_then(|rest| rest.strip_suffix(".scale"));
        key.is_some_and(|key| key.parse() == Ok(self.index) || self.name.as_deref() == Some(key))
    }
}

/// Two levels of measured stiffnesses.
#[derive(Clone, Debug)]
pub struct TwoLevels<'a> {
    pub kernel: &'a Kernel,
    pub inner: Rational,
    pub outer: Rational,
    /// Every stiffness is known to this times its norm.
    pub accuracy: f64,
}

/// Whether some stiffness of the file stands by reference.
pub(super) fn is_by_reference(source: &Value) -> bool {
    let potentials = source.get("potentials").and_then(Value::as_array);
    potentials.is_some_and(|all| all.iter().any(|own| own.get("stiffness").is_some_and(Value::is_object)))
}

impl Measured {
    /// From a file of such stiffnesses.
    pub fn read(source: &Value, arrays: &Arrays) -> Result<Measured> {
        let document: Document = serde_path_to_error::deserialize(source).map_err(|fault| {
            let field = fault.path().to_string();
            let error = no_system(fault.into_inner());
            if field == "." { error } else { error.at(field) }
        })?;
        let read = document.potentials.iter().enumerate().map(|(k, own)| own.read(k, arrays));
        let mut read = read.collect::<Result<Vec<_>>>()?;
        let scale = |(index, (own, (step, scale, _))): (usize, (&PotentialDocument, &(_, _, _)))| Scale {
            index,
            name: own.name.clone(),
            step: Rational::clone(step),
            scale: *scale,
        };
        let scales = document.potentials.iter().zip(&read).enumerate().map(scale).collect();
        let n = read.first().map_or(0, |(.., k)| k.nrows());
        if n == 0 || n > LARGEST {
            return Err(Error::input("potentials", n, format!("give 1 to {LARGEST} degrees of freedom")));
        }
        if read.iter().any(|(.., k)| k.iter().any(|x| !x.is_finite()) || k.shape() != (n, n)) {
            let remedy = format!("give {n} x {n} finite numbers for each potential");
            return Err(Error::input("potentials", "a stiffness", remedy));
        }
        let masses = document.masses.as_ref().map(|at| at.read("masses", arrays)).transpose()?;
        let masses = masses.map(|own| spread(own.into_values(), n)).transpose()?;
        if masses.is_none() && !document.mass_weighted {
            return Err(Error::missing("masses", "give them, or say \"mass_weighted\": true"));
        }
        let positions = document.positions.as_ref().map(|at| at.read("positions", arrays)).transpose()?;
        let positions = positions.map(|own| triples(&own.into_values(), n)).transpose()?;
        let mut body = Body { masses, positions, is_weighted: document.mass_weighted };
        let held = body.transform(&document, &mut read, arrays)?;
        let Body { masses, positions, is_weighted } = body;
        let mut shares: Vec<(Rational, Vec<DMatrix<f64>>)> = Vec::new();
        for (step, _, stiffness) in read {
            match shares.iter_mut().find(|(other, _)| *other == step) {
                Some((_, own)) => own.push(stiffness),
                None => shares.push((step, vec![stiffness])),
            }
        }
        let sum = |(step, own): &(Rational, Vec<DMatrix<f64>>)| {
            (step.clone(), own.iter().fold(DMatrix::zeros(n, n), |sum, k| sum + k))
        };
        let mut potentials: Vec<(Rational, DMatrix<f64>)> = shares.iter().map(sum).collect();
        shares.retain(|(_, own)| own.len() > 1);
        potentials.sort_by(|a, b| a.0.cmp(&b.0));
        // The steps, checked as those of any system are: what is read can be decided.
        let clock = |step: &Rational| Potential {
            stiffness: Symmetric::zero(1),
            step: step.clone(),
            phase: Rational::default(),
        };
        System::new(
            Symmetric::diagonal(&[Rational::one()]),
            potentials.iter().map(|(step, _)| clock(step)).collect(),
        )?;
        let accuracy = match &document.accuracy {
            Some(number) => to_f64(&number.read("accuracy")?),
            None => USUAL_ACCURACY,
        };
        let read = Measured {
            potentials,
            masses,
            positions,
            is_weighted,
            is_periodic: document.periodic,
            accuracy: 0.0,
            keeps_rigid: document.keep_rigid,
            shares,
            held,
            scales,
            kernel: Arc::default(),
        };
        read.at_accuracy(accuracy)
    }

    /// The same known to another accuracy.
    pub fn at_accuracy(mut self, accuracy: f64) -> Result<Measured> {
        if !(accuracy > 0.0 && accuracy < 0.1) {
            return Err(Error::input("accuracy", accuracy, "give a positive number below 1/10, as 1e-6"));
        }
        (self.accuracy, self.kernel) = (accuracy, Arc::default());
        Ok(self)
    }

    /// The same with its rigid motions left in.
    pub fn keeping_rigid(mut self) -> Measured {
        (self.keeps_rigid, self.kernel) = (true, Arc::default());
        self
    }

    /// Takes over what was asked of another of the same file, and its eigenbasis where the stiffnesses are the same.
    pub fn follow(&mut self, other: &Measured) {
        (self.accuracy, self.keeps_rigid) = (other.accuracy, other.keeps_rigid);
        if self.potentials.iter().map(|(_, k)| k).eq(other.potentials.iter().map(|(_, k)| k)) {
            self.kernel = Arc::clone(&other.kernel);
        }
    }

    /// The steps, increasing.
    pub fn steps(&self) -> Vec<Rational> {
        self.potentials.iter().map(|(step, _)| step.clone()).collect()
    }

    /// Whether the kernel of two levels decides it.
    pub fn is_of_two_levels(&self) -> bool {
        self.outer().is_some()
    }

    /// What is proven of it, for this one verdict at the least cost; `None` where it is not of two levels.
    pub fn verdict(&self, limits: &Limits) -> Result<Option<Holds>> {
        let Some((outer, _)) = self.outer() else { return Ok(None) };
        self.allow(limits)?;
        Ok(Some(self.hessians()?.verdict(&outer)?))
    }

    /// What is proven of it, in an eigenbasis that serves others of the same file; `None` where it is not of two levels.
    pub fn holds(&self) -> Result<Option<Holds>> {
        let Some((outer, _)) = self.outer() else { return Ok(None) };
        Ok(Some(self.kernel()?.verdict_within(&outer, 0.0)))
    }

    /// Which of the two levels the scale at a path is of, 0 the fast one, and its present value.
    pub fn scaled_at(&self, path: &str) -> Result<(usize, f64)> {
        let entry = self.scales.iter().find(|own| own.is_at(path));
        let entry = entry.ok_or_else(|| Error::input("intervals", path, "name the scale of a potential"))?;
        let level = self.potentials.iter().position(|(step, _)| *step == entry.step).expect("its own step");
        if self.scales.iter().filter(|own| own.step == entry.step).count() > 1 || entry.scale == 0.0 {
            let remedy = "give the potential a step of its own and a scale that is not 0";
            return Err(Error::input("intervals", path, remedy));
        }
        Ok((level, entry.scale))
    }

    /// The verdicts on a range of factors of one level, all else as it is.
    pub fn stretches_of_scale(
        &self,
        level: usize,
        (lo, hi): (f64, f64),
        factor: f64,
        width: f64,
    ) -> Result<Vec<Stretch>> {
        let Some((outer, _)) = self.outer() else {
            return Ok(vec![Stretch { lo, hi, verdict: Holds::NotTold }]);
        };
        let cells = Cells::new(self.kernel()?)?;
        cover((lo, hi), width, |lo, hi| {
            let (a, b) = (lo / factor, hi / factor);
            Ok(cells.verdict_scaled(&outer, level, (a.min(b), a.max(b))))
        })
    }

    /// The verdict: two levels by their kernel, anything else as a rational system of the doubles given.
    pub fn decide(&self, route: Route, limits: &Limits) -> Result<Analysis> {
        let Some((outer, period)) = self.outer().filter(|_| route == Route::Cheapest) else {
            return self.decide_projected(route, limits);
        };
        self.allow(limits)?;
        Ok(self.kernel()?.decide(&outer, &period, self.accuracy))
    }

    /// The verdict at an outer step, as many inner ones as in the file.
    pub fn decide_at(&self, outer: &Rational, limits: &Limits) -> Result<Analysis> {
        self.allow(limits)?;
        let at = Outer::new(to_f64(outer), self.inner_steps())?;
        Ok(self.kernel()?.decide(&at, outer, self.accuracy))
    }

    /// What friction of this rate per unit time does.
    pub fn friction(&self, rate: &Rational, limits: &Limits) -> Result<Friction> {
        let (outer, _) = self.outer().ok_or_else(|| {
            let remedy = "friction is answered for two levels, the outer step a multiple of the inner one";
            Error::input("potentials", format!("{} steps", self.potentials.len()), remedy)
        })?;
        // Some 20 eigenvalue problems of 2n rows, each 25 (2n)³.
        let cost = (self.size() as u64).saturating_pow(3).saturating_mul(4_000);
        limits.allow(cost, || format!("the eigenvalues of a period of {} rows", 2 * self.size()))?;
        Ok(self.kernel()?.friction(&outer, rate))
    }

    fn allow(&self, limits: &Limits) -> Result<()> {
        limits.allow(self.cost(), || format!("eigenvalues and factorizations of {} rows", self.size()))
    }

    fn inner_steps(&self) -> u64 {
        self.outer().map_or(1, |(outer, _)| outer.inner_steps())
    }

    /// The products that a verdict costs, roughly.
    pub fn cost(&self) -> u64 {
        (self.size() as u64).saturating_pow(3).saturating_mul(200)
    }

    /// The number of inner steps, and the verdicts on a range of outer ones.
    pub fn stretches(&self, range: (f64, f64), width: f64) -> Result<(u64, Vec<Stretch>)> {
        let (outer, _) = self.outer().ok_or_else(|| {
            let remedy = "intervals are computed for two levels, the outer step a multiple of the inner one";
            Error::input("potentials", format!("{} steps", self.potentials.len()), remedy)
        })?;
        let inner_steps = outer.inner_steps();
        Ok((inner_steps, self.kernel()?.stretches(inner_steps, range, width)?))
    }

    /// The growth rate at each outer step, as many inner ones as in the file; `None` where none is told.
    pub fn growth_rates(&self, steps: &[f64]) -> Result<Vec<Option<f64>>> {
        let (inner_steps, kernel) = (self.inner_steps(), self.kernel()?);
        steps.iter().map(|&step| Ok(kernel.growth_rate(&Outer::new(step, inner_steps)?))).collect()
    }

    /// The eigenbasis with the inner and the outer step, and how well the stiffnesses are known.
    pub fn two_levels(&self) -> Result<TwoLevels<'_>> {
        let remedy = "give two potentials, the step of one a multiple of the other's";
        let other = || Error::input("potentials", format!("{} steps", self.potentials.len()), remedy);
        let [(inner, _), (outer, _)] = self.potentials.as_slice() else { return Err(other()) };
        self.outer().ok_or_else(other)?;
        let [inner, outer] = [inner, outer].map(Clone::clone);
        Ok(TwoLevels { kernel: self.kernel()?, inner, outer, accuracy: self.accuracy })
    }

    /// The eigenbasis, computed when it is first asked for.
    fn kernel(&self) -> Result<&Kernel> {
        if let Some(kernel) = self.kernel.get() {
            return Ok(kernel);
        }
        let kernel = Kernel::new(&self.hessians()?)?;
        Ok(self.kernel.get_or_init(|| kernel))
    }

    /// The stiffness of the shortest step and the sum of the others, rigid motions and held distances projected out.
    pub fn hessians(&self) -> Result<Hessians> {
        let whole = self.summed_hessians()?;
        Ok(self.shares.iter().fold(whole, |whole, (step, own)| {
            let level = usize::from(*step != self.potentials[0].0);
            whole.of_shares(level, &own.iter().map(|k| self.weighted(k)).collect::<Vec<_>>())
        }))
    }

    /// M^-½ K M^-½.
    pub(super) fn weighted(&self, k: &DMatrix<f64>) -> DMatrix<f64> {
        match self.masses.as_ref().filter(|_| !self.is_weighted) {
            Some(m) => DMatrix::from_fn(k.nrows(), k.ncols(), |i, j| k[(i, j)] / (m[i].sqrt() * m[j].sqrt())),
            None => k.clone(),
        }
    }

    /// The largest ln |λ|/T over the eigenvalues of the dense full period, rounded; `None` where it is not of two levels.
    pub fn growth_of_period(&self) -> Result<Option<f64>> {
        let Some((outer, _)) = self.outer() else { return Ok(None) };
        Ok(Some(self.hessians()?.growth_of_period(outer.step(), outer.inner_steps())))
    }

    fn summed_hessians(&self) -> Result<Hessians> {
        let (fast, others) =
            self.potentials.split_first().map(|((_, fast), rest)| (fast, rest)).expect("checked");
        let slow = match others {
            [(_, slow)] => Cow::Borrowed(slow),
            _ => Cow::Owned(
                others.iter().fold(DMatrix::zeros(self.size(), self.size()), |sum, (_, k)| sum + k),
            ),
        };
        let slow = slow.as_ref();
        let hessians = match &self.masses {
            Some(masses) if !self.is_weighted => Hessians::weighted(masses, fast, slow, self.accuracy)?,
            _ => Hessians::new(fast, slow, self.accuracy)?,
        };
        Ok(match (&self.positions, &self.masses) {
            (Some(positions), Some(masses)) if !self.held.is_empty() => {
                let held = Particles { masses, positions }.gradients(&self.held);
                let rigid = if self.keeps_rigid { Mat::new() } else { self.rigid(Some(positions), masses) };
                let all = |i: usize, j: usize| match j.checked_sub(held.ncols()) {
                    None => held[(i, j)],
                    Some(j) => rigid[(i, j)],
                };
                let all = Mat::from_fn(held.nrows(), held.ncols() + rigid.ncols(), all);
                let by = if self.keeps_rigid { "constraints" } else { "positions and constraints" };
                hessians.without(&all.qr().compute_thin_Q(), by)
            }
            _ if self.keeps_rigid => hessians,
            (_, Some(masses)) if self.is_periodic && self.size().is_multiple_of(3) => {
                hessians.without(&self.rigid(None, masses), "periodic box")
            }
            (Some(positions), Some(masses)) => {
                hessians.without(&self.rigid(Some(positions), masses), "positions")
            }
            _ => hessians.without_null_space(self.accuracy, if self.is_periodic { 3 } else { 6 })?,
        })
    }

    fn rigid(&self, positions: Option<&[[f64; 3]]>, masses: &[f64]) -> Mat<f64> {
        let masses: Vec<f64> = masses.iter().step_by(3).copied().collect();
        match positions {
            Some(positions) if !self.is_periodic => rigid_motions(positions, &masses),
            _ => translations(&masses),
        }
    }

    /// Where the matrices themselves would be taken, all distances free.
    pub fn refuse_constraints(&self) -> Result<()> {
        let remedy = "a run leaves all distances free: take the constraints out";
        let given = || Error::input("constraints", format!("{} pairs", self.held.len()), remedy);
        if self.held.is_empty() { Ok(()) } else { Err(given()) }
    }

    /// The two levels, with their period; `None` where the steps are of another kind.
    fn outer(&self) -> Option<(Outer, Rational)> {
        match self.potentials.as_slice() {
            [(step, _)] => Some((Outer::of_steps(step, step)?, step.clone())),
            [(inner, _), (outer, _)] => Some((Outer::of_steps(inner, outer)?, outer.clone())),
            _ => None,
        }
    }

    /// The same doubles as a rational system: in mass-weighted coordinates with unit masses where they are.
    pub fn system(&self) -> System {
        let masses = self.masses.as_ref().filter(|_| !self.is_weighted);
        rational(masses.map_or(&vec![1.0; self.size()], |own| own), &self.potentials)
    }

    /// The number of degrees of freedom.
    pub fn size(&self) -> usize {
        self.potentials[0].1.nrows()
    }
}

/// Doubles as a rational system; what asymmetry there is is split evenly.
pub(super) fn rational(masses: &[f64], potentials: &[(Rational, DMatrix<f64>)]) -> System {
    let exact = |x: f64| from_f64_exact(x).expect("finite, as it was read");
    let masses: Vec<_> = masses.iter().map(|&m| exact(m)).collect();
    let potential = |(step, stiffness): &(Rational, DMatrix<f64>)| {
        let mut sum = Symmetric::zero(masses.len());
        for i in 0..masses.len() {
            for j in 0..=i {
                sum.add(i, j, &exact(stiffness[(i, j)] / 2.0 + stiffness[(j, i)] / 2.0));
            }
        }
        Potential { stiffness: sum, step: step.clone(), phase: Rational::default() }
    };
    let potentials = potentials.iter().map(potential).collect();
    System::new(Symmetric::diagonal(&masses), potentials).expect("masses and steps as they were checked")
}

/// What moves.
struct Body {
    masses: Option<Vec<f64>>,
    positions: Option<Vec<[f64; 3]>>,
    is_weighted: bool,
}

impl Body {
    /// Heavier hydrogens first, then constraints: the stiffnesses as they are then, and the pairs that are held.
    fn transform(
        &mut self,
        document: &Document,
        read: &mut [(Rational, f64, DMatrix<f64>)],
        arrays: &Arrays,
    ) -> Result<Vec<[usize; 2]>> {
        if document.constraints.is_none() && document.hydrogen_mass.is_none() {
            return Ok(Vec::new());
        }
        let (Some(masses), Some(positions)) = (&mut self.masses, &self.positions) else {
            let field = if self.masses.is_none() { "masses" } else { "positions" };
            return Err(Error::missing(
                field,
                "constraints and heavy hydrogens need masses and positions in the file",
            ));
        };
        // By the masses as given: heavy hydrogens are hydrogens still.
        let named = document.constraints.as_ref();
        let pairs = named.map(|own| Particles { masses, positions }.pairs(own)).transpose()?;
        let old = self.is_weighted.then(|| masses.clone());
        if let Some(mass) = &document.hydrogen_mass {
            *masses = Particles { masses, positions }.heavier(to_f64(&mass.read("hydrogen_mass")?))?;
        }
        read.iter_mut().for_each(|(.., stiffness)| reweigh(stiffness, old.as_deref(), masses));
        self.is_weighted = true;
        let Some(pairs) = pairs else { return Ok(Vec::new()) };
        let particles = Particles { masses, positions };
        for (k, (own, (_, scale, stiffness))) in document.potentials.iter().zip(read).enumerate() {
            let field = format!("potentials[{k}].force");
            let remedy = "give the force of each potential at the positions: its tension bends the bonds that are held";
            let force = own.force.as_ref().ok_or_else(|| Error::missing(&field, remedy))?;
            let force: Vec<f64> =
                force.read(&field, arrays)?.into_values().iter().map(|x| x * *scale).collect();
            particles.bend(stiffness, &force, &pairs)?;
        }
        Ok(pairs)
    }
}

impl PotentialDocument {
    fn read(&self, k: usize, arrays: &Arrays) -> Result<(Rational, f64, DMatrix<f64>)> {
        let field = |name: &str| format!("potentials[{k}].{name}");
        let step = self.step.read(&field("step"))?;
        if step <= Rational::default() {
            return Err(Error::input(&field("step"), step, "a step must be positive"));
        }
        let stiffness = self.stiffness.read(&field("stiffness"), arrays)?.matrix(&field("stiffness"))?;
        let scale = self.scale.as_ref().map(|own| own.read(&field("scale"))).transpose()?;
        let scale = scale.map_or(1.0, |own| to_f64(&own));
        Ok((step, scale, stiffness * scale))
    }
}

/// A mass for each degree of freedom, from one each or from one for each three.
fn spread(masses: Vec<f64>, n: usize) -> Result<Vec<f64>> {
    let wrong = || {
        let remedy = format!("there are {n} degrees of freedom: give a mass for each, or for each three");
        Error::input("masses", masses.len(), remedy)
    };
    if let Some((i, mass)) = masses.iter().enumerate().find(|(_, mass)| **mass <= 0.0) {
        return Err(Error::input(&format!("masses[{i}]"), mass, "a mass must be positive"));
    }
    match masses.len() {
        k if k == n => Ok(masses),
        k if 3 * k == n => Ok(masses.iter().flat_map(|&m| [m; 3]).collect()),
        _ => Err(wrong()),
    }
}

fn triples(positions: &[f64], n: usize) -> Result<Vec<[f64; 3]>> {
    if positions.len() != n || !n.is_multiple_of(3) {
        let remedy = format!("there are {n} degrees of freedom: give three coordinates for each particle");
        return Err(Error::input("positions", format!("{} numbers", positions.len()), remedy));
    }
    Ok(positions.chunks_exact(3).map(|x| [x[0], x[1], x[2]]).collect())
}
