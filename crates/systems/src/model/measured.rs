//! Stiffnesses in doubles, as people measure them, each potential with its clock.

use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

use nalgebra::DMatrix;
use num_traits::Zero;

use crate::levels::{Hessians, Kernel, Method, Nested, Outer, Source};
use crate::linear::sparse::Symmetric;
use crate::linear::system::{Potential, System};
use crate::verdict::measured::check_accuracy;
use number::{Error, Rational, Result, from_f64_exact, to_f64};

/// The masses that move, and the motions that are held.
#[derive(Clone, Debug, Default)]
pub struct Body {
    /// The mass of each degree of freedom; `None`: the stiffnesses are mass-weighted and no masses are known.
    pub masses: Option<Vec<f64>>,
    /// The place of each particle in space.
    pub positions: Option<Vec<[f64; 3]>>,
    /// Whether the stiffnesses are M^-½ K M^-½ instead of K.
    pub is_weighted: bool,
    /// Whether rotations are no rigid motions, as in a periodic box.
    pub is_periodic: bool,
    /// The mass-weighted gradients of the distances that are held, a column each; by these the stiffnesses
    /// are bent.
    pub held: Option<DMatrix<f64>>,
    /// The rigid motions where these are known, mass-weighted and independent, a column each; `None`: they
    /// are looked for.
    pub rigid: Option<DMatrix<f64>>,
}

/// Measured stiffnesses with their clocks.
#[derive(Clone, Debug)]
pub struct MeasuredSystem {
    /// The sums of the stiffnesses of each step, by increasing step.
    pub(super) potentials: Vec<(Rational, DMatrix<f64>)>,
    /// The stiffnesses of steps that several potentials have: each is known to its own norm.
    shares: Vec<(Rational, Vec<DMatrix<f64>>)>,
    pub(super) body: Body,
    pub(super) accuracy: f64,
    pub(super) keeps_rigid: bool,
    method: Method,
    pub(super) system: OnceLock<System>,
    pub(super) kernel: Arc<OnceLock<Kernel>>,
}

/// Levels of measured stiffnesses, to be asked at any steps.
#[derive(Clone, Debug)]
pub struct MeasuredLevels<'a> {
    pub source: Arc<dyn Source>,
    pub body: &'a Body,
    /// Every stiffness is known to this times its norm.
    pub accuracy: f64,
}

/// The accuracy of rational stiffnesses in doubles, relative to their norms: more than (√n + 4) 2⁻⁵³ of n =
/// 4096 rows, from half a unit in the last place of each entry and each mass, and enough for rigid motions to
/// be found.
const ROUNDED: f64 = 1e-12;

impl MeasuredSystem {
    /// From the step and the stiffness of each potential, at least one, all n x n finite doubles; masses and
    /// positions, where they are given, fit them.
    ///
    /// # Errors
    /// Steps as those of [`System::new`]; an accuracy as for [`MeasuredSystem::at_accuracy`].
    pub fn new(body: Body, given: Vec<(Rational, DMatrix<f64>)>, accuracy: f64) -> Result<MeasuredSystem> {
        let mut shares: Vec<(Rational, Vec<DMatrix<f64>>)> = Vec::new();
        for (step, stiffness) in given {
            match shares.iter_mut().find(|(other, _)| *other == step) {
                Some((_, matrixes)) => matrixes.push(stiffness),
                None => shares.push((step, vec![stiffness])),
            }
        }
        let sum = |(step, matrixes): &(Rational, Vec<DMatrix<f64>>)| {
            let (n, m) = matrixes[0].shape();
            (step.clone(), matrixes.iter().fold(DMatrix::zeros(n, m), |sum, k| sum + k))
        };
        let mut potentials: Vec<(Rational, DMatrix<f64>)> = shares.iter().map(sum).collect();
        shares.retain(|(_, matrixes)| matrixes.len() > 1);
        potentials.sort_by(|a, b| a.0.cmp(&b.0));
        // The steps, checked as those of any system are.
        System::of_clocks(1, potentials.iter().map(|(step, _)| step.clone()))?;
        let (system, kernel) = (OnceLock::new(), Arc::default());
        let (keeps_rigid, method) = (false, Method::default());
        let read = MeasuredSystem { potentials, shares, body, accuracy, keeps_rigid, method, system, kernel };
        read.at_accuracy(accuracy)
    }

    /// The clocks of a rational system in doubles.
    ///
    /// # Errors
    /// A mass matrix that is not diagonal; numbers that are no doubles of full precision.
    pub fn rounded(system: &System) -> Result<MeasuredSystem> {
        let (mass, n) = (system.mass(), system.size());
        if !mass.is_diagonal() {
            let remedy =
                "methods but implicit-explicit are decided in doubles: give masses in place of mass_matrix";
            return Err(Error::input("mass_matrix", "not diagonal", remedy));
        }
        let double = |x: &Rational| {
            let value = to_f64(x);
            let error =
                || Error::input("method", x, "decides in doubles of full precision: choose other units");
            (value.is_normal() || x.is_zero()).then_some(value).ok_or_else(error)
        };
        let masses = (0..n).map(|i| double(&mass.get(i, i))).collect::<Result<_>>()?;
        let dense = |clock: &Potential| {
            let mut matrix = DMatrix::zeros(n, n);
            for i in 0..n {
                for (&j, x) in clock.stiffness.row(i) {
                    matrix[(i, j)] = double(x)?;
                }
            }
            Ok((clock.step.clone(), matrix))
        };
        let masses: Vec<f64> = masses;
        // Exactly: what is soft beside the roundings of doubles is not rigid.
        let rigid = system.rigid_modes();
        let rigid = DMatrix::from_fn(n, rigid.len(), |i, k| to_f64(&rigid[k].1[i]) * masses[i].sqrt());
        let body = Body { masses: Some(masses), rigid: Some(rigid), ..Body::default() };
        let clocks = system.clocks().iter().map(dense).collect::<Result<_>>()?;
        MeasuredSystem::new(body, clocks, ROUNDED)
    }

    /// This system with every stiffness known to this times its norm.
    ///
    /// # Errors
    /// An accuracy that is not in (0, 1/10).
    pub fn at_accuracy(mut self, accuracy: f64) -> Result<MeasuredSystem> {
        check_accuracy(accuracy)?;
        (self.accuracy, self.kernel) = (accuracy, Arc::default());
        Ok(self)
    }

    /// This system with its rigid motions left in.
    #[must_use]
    pub fn keeping_rigid(mut self) -> MeasuredSystem {
        (self.keeps_rigid, self.kernel) = (true, Arc::default());
        self
    }

    /// This system under another integrator of two levels.
    ///
    /// # Errors
    /// Where there are not two levels.
    pub fn with_method(mut self, method: Method) -> Result<MeasuredSystem> {
        (self.method, self.kernel) = (method, Arc::default());
        if method == Method::Respa || self.is_of_two() {
            return Ok(self);
        }
        let remedy = "is for two levels: give two potentials with different steps, the shorter one's force is the fast one";
        Err(Error::input("method", method, remedy))
    }

    pub fn method(&self) -> Method {
        self.method
    }

    /// That kicks and drifts integrate it.
    pub fn refuse_method(&self, what: &str) -> Result<()> {
        match self.method {
            Method::Respa => Ok(()),
            method => Err(Error::input("method", method, format!("{what} is for respa: leave it out"))),
        }
    }

    /// Copies accuracy, method and the choice to keep rigid motions from another system of the same body, and
    /// its eigenbasis where the stiffnesses are the same.
    pub fn copy_settings_from(&mut self, other: &MeasuredSystem) {
        (self.accuracy, self.keeps_rigid, self.method) = (other.accuracy, other.keeps_rigid, other.method);
        if self.potentials.iter().map(|(_, k)| k).eq(other.potentials.iter().map(|(_, k)| k)) {
            self.kernel = Arc::clone(&other.kernel);
        }
    }

    /// The number of degrees of freedom.
    pub fn size(&self) -> usize {
        self.potentials[0].1.nrows()
    }

    /// The two levels, with their period; `None` where the steps are of another kind.
    pub(super) fn outer(&self) -> Option<(Outer, Rational)> {
        match self.potentials.as_slice() {
            [(step, _)] => Some((Outer::of_steps(step, step)?, step.clone())),
            [_, (outer, _)] if !self.method.has_inner_steps() => {
                Some((Outer::new(to_f64(outer), 1).ok()?, outer.clone()))
            }
            [(inner, _), (outer, _)] => Some((Outer::of_steps(inner, outer)?, outer.clone())),
            _ => None,
        }
    }

    /// What `ask` finds of levels that are not two of an inner and an outer step, and of their steps.
    pub(super) fn over_steps<T>(&self, ask: impl FnOnce(&Nested, &[Rational]) -> Result<T>) -> Result<T> {
        self.refuse_method("advice")?;
        ask(&self.nested()?, &self.steps())
    }

    /// The steps, increasing.
    pub(super) fn steps(&self) -> Vec<Rational> {
        self.potentials.iter().map(|(step, _)| step.clone()).collect()
    }

    /// The steps, increasing, of kicks and drifts.
    ///
    /// # Errors
    /// Another integrator.
    pub fn steps_of_kicks(&self) -> Result<Vec<Rational>> {
        self.refuse_method("advice").map(|()| self.steps())
    }

    /// The matrices of an inner and an outer step, rigid motions projected out.
    ///
    /// # Errors
    /// Other steps; another integrator.
    pub fn hessians_of_two(&self) -> Result<Hessians> {
        self.refuse_method("advice")?;
        if self.is_of_two() {
            return self.hessians();
        }
        let remedy = "give two potentials, the step of one a multiple of the other's; `kickdrift system FILE` decides any number of steps";
        Err(Error::input("potentials", format!("{} steps", self.potentials.len()), remedy))
    }

    fn is_of_two(&self) -> bool {
        self.potentials.len() == 2 && self.outer().is_some()
    }

    /// The levels, behind the face that both kinds have.
    ///
    /// # Errors
    /// As [`MeasuredSystem::kernel`]; another integrator.
    pub fn levels(&self) -> Result<MeasuredLevels<'_>> {
        self.refuse_method("advice")?;
        let source: Arc<dyn Source> =
            if self.is_of_two() { Arc::new(self.kernel()?.clone()) } else { Arc::new(self.nested()?) };
        Ok(MeasuredLevels { source, body: &self.body, accuracy: self.accuracy })
    }

    /// Levels of any number, by the action.
    fn nested(&self) -> Result<Nested> {
        let weighted = |matrixes: &[DMatrix<f64>]| matrixes.iter().map(|k| self.weighted(k)).collect();
        let clocks: Vec<Vec<DMatrix<f64>>> = self.clocks().map(|(_, matrixes)| weighted(matrixes)).collect();
        Nested::new(&self.hessians()?, &clocks)
    }

    /// The stiffnesses as they were given, those of each step together, by increasing step.
    pub(super) fn clocks(&self) -> impl Iterator<Item = (&Rational, &[DMatrix<f64>])> {
        self.potentials.iter().map(|(step, matrix)| {
            let shares =
                self.shares.iter().find(|(other, _)| other == step).map(|(_, matrixes)| &matrixes[..]);
            (step, shares.unwrap_or(std::slice::from_ref(matrix)))
        })
    }

    /// The eigenbasis, computed when it is first asked for.
    pub fn kernel(&self) -> Result<&Kernel> {
        if let Some(kernel) = self.kernel.get() {
            return Ok(kernel);
        }
        let kernel = Kernel::new(&self.hessians()?)?.with_method(self.method);
        Ok(self.kernel.get_or_init(|| kernel))
    }

    /// The stiffness of the shortest step and the sum of the others, rigid motions and held distances
    /// projected out.
    pub(super) fn hessians(&self) -> Result<Hessians> {
        let whole = self.summed_hessians()?;
        Ok(self.shares.iter().fold(whole, |whole, (step, matrixes)| {
            let level = usize::from(*step != self.potentials[0].0);
            whole.of_shares(level, &matrixes.iter().map(|k| self.weighted(k)).collect::<Vec<_>>())
        }))
    }

    /// M^-½ K M^-½ of a stiffness given.
    pub(super) fn weighted(&self, k: &DMatrix<f64>) -> DMatrix<f64> {
        match self.body.masses.as_ref().filter(|_| !self.body.is_weighted) {
            Some(m) => DMatrix::from_fn(k.nrows(), k.ncols(), |i, j| k[(i, j)] / (m[i].sqrt() * m[j].sqrt())),
            None => k.clone(),
        }
    }

    /// M^-½ K M^-½ of each potential, with its step.
    pub(super) fn all_weighted(&self) -> impl Iterator<Item = (Rational, DMatrix<f64>)> {
        self.potentials.iter().map(|(step, k)| (step.clone(), self.weighted(k)))
    }

    fn summed_hessians(&self) -> Result<Hessians> {
        let ((_, fast), others) = self.potentials.split_first().expect("at least one");
        let slow = match others {
            [(_, slow)] => Cow::Borrowed(slow),
            _ => Cow::Owned(
                others.iter().fold(DMatrix::zeros(self.size(), self.size()), |sum, (_, k)| sum + k),
            ),
        };
        let slow = slow.as_ref();
        let hessians = match &self.body.masses {
            Some(masses) if !self.body.is_weighted => Hessians::weighted(masses, fast, slow, self.accuracy)?,
            _ => Hessians::new(fast, slow, self.accuracy)?,
        };
        self.without_rigid(hessians)
    }

    /// Where the matrices themselves would be taken, all distances free.
    ///
    /// # Errors
    /// Where distances are held.
    pub fn refuse_constraints(&self) -> Result<()> {
        let remedy = "a run leaves all distances free: take the constraints out";
        let given =
            |held: &DMatrix<f64>| Error::input("constraints", format!("{} pairs", held.ncols()), remedy);
        self.body.held.as_ref().map_or(Ok(()), |held| Err(given(held)))
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
        Potential::new(sum, step.clone())
    };
    let potentials = potentials.iter().map(potential).collect();
    System::new(Symmetric::diagonal(&masses), potentials).expect("masses and steps as they were checked")
}
