//! Inputs of engines that are not read here: known by name, and refused with the rule by which their steps
//! are given.

use number::Error;

/// An engine's name, and how its steps follow from its words.
struct Other {
    name: &'static str,
    /// What it writes at the start of a line, in lower case, white space left out: any of them is enough.
    begins: &'static [&'static str],
    steps: &'static str,
}

const OTHERS: [Other; 7] = [
    Other {
        name: "AMBER",
        begins: &["&cntrl"],
        steps: "dt is the inner step in ps; with nrespa the slow forces have dt*nrespa",
    },
    Other {
        name: "GENESIS",
        begins: &["[dynamics]", "[energy]", "[ensemble]"],
        steps: "timestep is the inner step in ps; with VRES the reciprocal forces have timestep*elec_long_period",
    },
    Other {
        name: "CP2K",
        begins: &["&force_eval", "&motion", "&global"],
        steps: "TIMESTEP is the outer step; with &RESPA the fast forces have TIMESTEP/FREQUENCY",
    },
    Other {
        name: "Desmond",
        begins: &["integrator={", "integrator.dt=", "respa={", "app=mdsim", "simulate{", "task{"],
        steps: "dt is the inner step in ps; near forces have dt*near_timesteps, far forces dt*far_timesteps",
    },
    Other {
        name: "Quantum ESPRESSO",
        begins: &["&control", "&system", "&electrons", "&ions"],
        steps: "dt is its one step in atomic units",
    },
    Other {
        name: "CHARMM",
        begins: &["dynamics", "dynaleap", "dynavver", "dynacpt"],
        steps: "TIMESTEP is its step in ps",
    },
    Other {
        name: "DL_POLY",
        begins: &["ensemblenve", "ensemblenvt", "ensemblenpt", "multipletimestep"],
        steps: "timestep is its inner step in ps; with multiple timestep n the slow forces have n of them",
    },
];

/// The refusal of a text that is another engine's, or Python without an integrator that is known.
pub(super) fn refusal(text: &str) -> Option<Error> {
    let squeezed = text.lines().map(|line| {
        let code = line.split(['#', '!', ';']).next().unwrap_or_default();
        let plain: String = code.chars().filter(|c| !c.is_whitespace()).take(40).collect();
        plain.to_ascii_lowercase()
    });
    for line in squeezed {
        let begins = |other: &&Other| other.begins.iter().any(|begin| line.starts_with(begin));
        if let Some(Other { name, steps, .. }) = OTHERS.iter().find(begins) {
            let remedy = format!("is not read here: give the steps themselves, as --steps 1fs,4fs ({steps})");
            return Some(Error::input("engine", format!("an input of {name}"), remedy));
        }
    }
    is_python(text).then(|| {
        let remedy = "imports no OpenMM: give the steps themselves, as --steps 1fs,4fs";
        Error::input("engine", "a text in Python", remedy)
    })
}

/// Lines that are Python and no engine's.
fn is_python(text: &str) -> bool {
    let begins = |line: &str| {
        let import = line.strip_prefix("import ").or_else(|| line.strip_prefix("from "));
        let is_block = ["def ", "class ", "with ", "for ", "if "].iter().any(|word| line.starts_with(word));
        import.is_some_and(|rest| !rest.contains(['=', '"'])) || (is_block && line.trim_end().ends_with(':'))
    };
    text.lines().any(begins)
}
