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

/// Shortest periods of nonbonded forces alone, in fs: of what, and by which Hessians, at a minimum. Torsions on the slow clock make it shorter.
pub const SLOW: [(&str, &str, &str); 2] = [
    (
        "39.5",
        "of nonbonded forces in water",
        "data/scenes/flexible-water.json: 16 flexible waters, amber14 tip3pfb",
    ),
    ("71.6", "of nonbonded forces in a peptide in vacuum", "data/scenes/alanine-dipeptide.json: amber ff96"),
];
