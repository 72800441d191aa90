//! Statements that are published and not proven here: each with its source.

/// A statement from the literature about an outer or an inner step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Caution {
    /// The step is the period over this.
    pub parts: u64,
    /// Whether it is about the innermost step, or else about the outermost one.
    pub inner: bool,
    pub statement: &'static str,
    pub source: &'static str,
}

/// The statements, about the period T of the fastest mode below the step's own clock.
pub const PUBLISHED: [Caution; 4] = [
    Caution {
        parts: 3,
        inner: false,
        statement: "nonlinear instability sets in near an outer step of T/3: flexible water drifts a little at 4 fs and fails at 5 fs",
        source: "Ma, Izaguirre, Skeel 2003 (SIAM J. Sci. Comput.)",
    },
    Caution {
        parts: 4,
        inner: false,
        statement: "a nonlinear resonance of fourth order lies near an outer step of T/4",
        source: "Ma, Izaguirre, Skeel 2003 (SIAM J. Sci. Comput.)",
    },
    Caution {
        parts: 5,
        inner: true,
        statement: "grompp warns where the innermost step is longer than T/5",
        source: "GROMACS, grompp.cpp, check_bonds_timestep",
    },
    Caution {
        parts: 10,
        inner: true,
        statement: "grompp notes where the innermost step is longer than T/10",
        source: "GROMACS, grompp.cpp, check_bonds_timestep",
    },
];

/// The shortest period of nonbonded forces alone, as if nothing else acted, at a minimum. Torsions on the slow clock make it shorter.
#[derive(Debug, PartialEq, Eq)]
pub struct Slow {
    /// As it is asked for: `slow=water`.
    pub name: &'static str,
    /// In fs.
    pub period: &'static str,
    /// Where it comes from, in documents.
    pub origin: &'static str,
    pub what: &'static str,
    /// By what it was measured.
    pub source: &'static str,
}

/// Those that are known by name.
pub const SLOW: [Slow; 3] = [
    Slow {
        name: "water",
        period: "39.5",
        origin: "slow period of water",
        what: "of nonbonded forces in water",
        source: "Hessians of data/scenes/flexible-water.json: 16 flexible waters, amber14 tip3pfb",
    },
    Slow {
        name: "protein",
        period: "38.7",
        origin: "slow period of a protein in water",
        what: "of nonbonded forces of a peptide in water, which is that of the water",
        source: "python/tests/bench/solvated.py 2: alanine dipeptide in 232 flexible waters with PME, amber14, with a probability of 99.9 %",
    },
    Slow {
        name: "peptide",
        period: "71.6",
        origin: "slow period of a peptide",
        what: "of nonbonded forces in a peptide in vacuum",
        source: "Hessians of data/scenes/alanine-dipeptide.json: amber ff96",
    },
];

impl Slow {
    /// The period that is known by this name.
    pub fn of(name: &str) -> Option<&'static Slow> {
        SLOW.iter().find(|own| own.name == name.trim())
    }
}
