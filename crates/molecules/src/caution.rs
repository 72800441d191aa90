//! Statements that are published and not proven here: each with its source.

/// The step that a statement is about, beside the period T of the fastest motion on its clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The outermost of several steps is T/n, T the fastest period on any clock but the outermost.
    Part(u64),
    /// A clock's own step at which Verlet's rule turns by 2 π/k a step: h = (T/π) sin(π/k), never beyond its
    /// own limit T/π.
    Turn(u64),
}

impl Place {
    /// T over this is the step.
    pub fn parts(self) -> f64 {
        match self {
            Place::Part(n) => n as f64,
            Place::Turn(k) => std::f64::consts::PI / (std::f64::consts::PI / k as f64).sin(),
        }
    }

    /// "T/3", "T/4.44".
    pub fn name(self) -> String {
        match self {
            Place::Part(n) => format!("T/{n}"),
            Place::Turn(_) => format!("T/{:.2}", self.parts()),
        }
    }
}

/// A statement from the literature about a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Caution {
    pub place: Place,
    /// Whether the step is that of a clock alone or of the innermost one, or else the outermost of several.
    pub inner: bool,
    pub statement: &'static str,
    pub source: &'static str,
}

const fn turn(k: u64, statement: &'static str) -> Caution {
    let source = "Schlick, Mandziuk, Skeel, Srinivas 1998 (J. Comput. Phys. 140)";
    Caution { place: Place::Turn(k), inner: true, statement, source }
}

/// The least turn whose resonance is heeded: below h = T/6.28, that is h w ≤ 1, none was seen to lose a bond
/// at room temperature.
pub const HEEDED: u64 = 6;

/// Where a step of its own has to end for bonds that are not harmonic.
const OWN: Caution = Caution {
    place: Place::Turn(HEEDED),
    inner: true,
    statement: "below it h w <= 1; beyond it bonds that are not harmonic are lost: of q-TIP4P/F water at 298 K 1.4 fs is close to the upper bound",
    source: "Rosa-Raices, Sun, Bou-Rabee, Miller 2021 (J. Chem. Phys. 154, 024106)",
};

/// Of a single clock: the turns of the method itself, where anharmonic forces push in time.
pub const OF_ONE: [Caution; 4] = [
    turn(3, "a resonance of third order: one whole turn is three steps"),
    turn(4, "a resonance of fourth order: one whole turn is four steps"),
    turn(5, "a resonance of fifth order: one whole turn is five steps"),
    OWN,
];

/// Of several clocks, published for r-RESPA; and of the innermost step.
pub const OF_MANY: [Caution; 3] = [
    Caution {
        place: Place::Part(3),
        inner: false,
        statement: "nonlinear instability sets in near an outer step of T/3: flexible water drifts a little at 4 fs and fails at 5 fs",
        source: "Ma, Izaguirre, Skeel 2003 (SIAM J. Sci. Comput.)",
    },
    Caution {
        place: Place::Part(4),
        inner: false,
        statement: "a nonlinear resonance of fourth order lies near an outer step of T/4",
        source: "Ma, Izaguirre, Skeel 2003 (SIAM J. Sci. Comput.)",
    },
    OWN,
];

/// The statements about a scheme of so many steps.
pub fn published(steps: usize) -> &'static [Caution] {
    if steps == 1 { &OF_ONE } else { &OF_MANY }
}

/// What runs of our own show of T/4, T/3 and T/2, for people: data/published/bonds.json.
pub const SEEN: &str = "27 flexible waters in OpenMM at 298 K, bonds and angles at 0.5 fs, by the period that neighbours give: energy drifts at T/4 by 0.5 kT per \
     atom and ns at most, hardly beyond the scatter of 0.2; at T/3 by 3 where bonds are harmonic and by 15 where they are not, which a friction of 1/ps hides; at \
     T/2 all is hot within 0.5 ps, whatever the friction";

/// What practice arrived at, for people.
pub const PRACTICE: &str =
    "as in practice: 1 fs with flexible O-H, 2 fs with O-H held, 4 fs with heavy hydrogens too";

/// GROMACS's own check of the innermost step (grompp.cpp, check_bonds_timestep): T/5 it warns of, T/10 it
/// notes.
pub const GROMPP: [(u64, &str); 2] = [(5, "warns"), (10, "notes")];
