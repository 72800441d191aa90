//! Periods that are known by name, for those who know none: each with what it was measured on.

/// The shortest period of a kind of molecule, at a minimum of its energy.
#[derive(Debug, PartialEq, Eq)]
pub struct Typical {
    /// As it is asked for: `slow=water`, `fast=protein,h-bonds`.
    pub name: &'static str,
    /// Whether it is of the fastest clock, or else of nonbonded forces alone.
    pub is_fast: bool,
    /// In fs.
    pub period: &'static str,
    /// Where it comes from, in documents.
    pub origin: &'static str,
    pub what: &'static str,
    /// By what it was measured.
    pub source: &'static str,
}

/// The shortest period of nonbonded forces alone, as if nothing else acted. Torsions on the slow clock make
/// it shorter.
pub const SLOW: [Typical; 3] = [
    Typical {
        name: "water",
        is_fast: false,
        period: "39.5",
        origin: "slow period of water",
        what: "of nonbonded forces in water",
        source: "Hessians of data/scenes/flexible-water.json: 16 flexible waters, amber14 tip3pfb",
    },
    Typical {
        name: "protein",
        is_fast: false,
        period: "38.7",
        origin: "slow period of a protein in water",
        what: "of nonbonded forces of a peptide in water, which is that of the water",
        source: "python/tests/bench/solvated.py 2: alanine dipeptide in 232 flexible waters with PME, amber14, with a probability of 99.9 %",
    },
    Typical {
        name: "peptide",
        is_fast: false,
        period: "71.6",
        origin: "slow period of a peptide",
        what: "of nonbonded forces in a peptide in vacuum",
        source: "Hessians of data/scenes/alanine-dipeptide.json: amber ff96",
    },
];

macro_rules! fast {
    ($count:literal, $($source:ident: $($name:literal $period:literal $what:literal;)*)*) => {
        /// The shortest period of all forces or of the bonded ones alone, whichever is shorter: rounded down,
        /// as python/tests/bench/periods.py measures it with OpenMM, or as it is published.
        pub const FAST: [Typical; $count] = [$($(Typical {
            name: $name,
            is_fast: true,
            period: $period,
            origin: concat!("typical fast period: ", $name),
            what: $what,
            source: $source,
        },)*)*];
    };
}

const WATER: &str = "measured on 64 waters: amber14 tip3pfb, tip3p, spce, CHARMM36; periods.py water";
const PROTEIN: &str = "measured on villin headpiece, amber14 and CHARMM36, and 22 capped amino acids, amber14; periods.py villin amino";
const DNA: &str = "measured on DNA and RNA of four bases, amber14 OL15 and OL3; periods.py dna";
const LIPID: &str = "measured on POPC and DPPC, amber14 lipid17 and CHARMM36; periods.py lipid";
const GROMACS: &str =
    "GROMACS reference manual, removing fastest degrees of freedom: measured from a simulation";

fast! {
    18,
    WATER:
        "water" "8.9" "of flexible water";
        "water,h-bonds" "13.7" "of water with held bonds and free angles";
        "water,hmr3" "13.8" "of flexible water with hydrogens of 3.024 amu";
        "water,rigid" "43.6" "of rigid water, which librates";
    PROTEIN:
        "protein" "8.98" "of a protein";
        "protein,h-bonds" "17.7" "of a protein with bonds to hydrogen held";
        "protein,hmr3" "13.9" "of a protein with hydrogens of 3.024 amu";
        "protein,h-bonds,hmr3" "17.4" "of a protein with both";
    DNA:
        "dna" "8.98" "of DNA and RNA";
        "dna,h-bonds" "17.4" "of DNA and RNA with bonds to hydrogen held";
        "dna,hmr3" "14.5" "of DNA and RNA with hydrogens of 3.024 amu";
        "dna,h-bonds,hmr3" "17.2" "of DNA and RNA with both";
    LIPID:
        "lipid" "10.9" "of lipids";
        "lipid,h-bonds" "18.9" "of lipids with bonds to hydrogen held";
        "lipid,hmr3" "14.9" "of lipids with hydrogens of 3.024 amu";
        "lipid,h-bonds,hmr3" "18.5" "of lipids with both";
    GROMACS:
        "h-bonds" "13" "of angles with hydrogen where bonds are held, of any molecule";
        "virtual-sites" "20" "where these angles are held too, about";
}

impl Typical {
    /// The period that this name means where a mode is called `mode`: with `fast=` those of the fastest
    /// clock, else the slow ones first.
    pub fn of(mode: &str, name: &str) -> Option<&'static Typical> {
        let plain = name.split(',').map(str::trim).collect::<Vec<_>>().join(",");
        let found = |all: &'static [Typical]| all.iter().find(|typical| typical.name == plain);
        if mode.trim() == "fast" { found(&FAST) } else { found(&SLOW).or_else(|| found(&FAST)) }
    }

    /// All that are known, the slow ones first.
    pub fn all() -> impl Iterator<Item = &'static Typical> {
        SLOW.iter().chain(&FAST)
    }

    /// "fast=protein,h-bonds".
    pub fn asked(&self) -> String {
        format!("{}={}", if self.is_fast { "fast" } else { "slow" }, self.name)
    }
}
