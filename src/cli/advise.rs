//! `kickdrift advise`: which steps are safe, for how long, and why.

use std::path::{Path, PathBuf};

use super::args::Common;
use super::system::draw;
use crate::advise::engine::{self, Reading};
use crate::advise::unit::{self, Dimension};
use crate::advise::{Mode, Question, Scheme};
use crate::error::{Error, Result};
use crate::format::Format;
use crate::number::Rational;
use crate::number::parse::parse_rational;
use crate::report::advise as report;
use crate::report::file::write_output;

const EXAMPLES: &str = "Examples:
  Flexible water, bonds every 0.5 fs, the rest every 4 fs or every 5 fs:
    kickdrift advise --period OH=10fs --period slow=40fs --steps 0.5fs,4fs --steps 0.5fs,5fs
  A force field's bond (K of E = K x^2, k of E = k x^2/2), heavy hydrogens, a run of 10 ns, drawn:
    kickdrift advise --bond CH:K=340kcal/mol/A^2,12.011,1.008,3 --period 60fs --hmr 3.024 --steps 1fs,6fs --length 10ns --output advice.png
  Three clocks, a wavenumber, and which force is on which clock (1 is the fastest):
    kickdrift advise --period OH=3700/cm --period bend=1600/cm --period pme=100fs --on bend=1,pme=3 --steps 0.5fs,1fs,4fs";

/// Flags of `advise`.
///
/// --output FILE.svg, FILE.pdf or FILE.png draws: the outer step across, each mode a row.
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// A period or a wavenumber, as 10fs, OH=10fs or OH=3700/cm; once for each force. Of K steps the last K - 1 entries are on the slower
    /// clocks, all before them on the fastest.
    #[arg(long, value_name = "[NAME=]T")]
    period: Vec<String>,
    /// A bond: its force constant (k of E = k x^2/2, K of E = K x^2), two masses in amu, and, if not 1, how many hydrogens the heavy atom has.
    #[arg(long, value_name = "NAME:k=X,M1,M2[,N]")]
    bond: Vec<String>,
    /// The clocks of modes, 1 the fastest, as OH=1,bend=2.
    #[arg(long, value_name = "NAME=CLOCK,...", value_delimiter = ',')]
    on: Vec<String>,
    /// The steps from the innermost to the outermost one; again for another scheme.
    #[arg(long, value_name = "0.5fs,4fs")]
    steps: Vec<String>,
    /// The input of an engine (OpenMM, LAMMPS, GROMACS, NAMD, Tinker, i-PI), for its steps; with a serialized OpenMM system, twice.
    #[arg(long, value_name = "FILE")]
    engine: Vec<PathBuf>,
    /// How far every period may be off.
    #[arg(long, value_name = "PART", default_value = "5%")]
    band: String,
    /// The length of the run, as 10ns.
    #[arg(long, value_name = "TIME")]
    length: Option<String>,
    /// Hydrogens of this mass in amu, taken from their heavy atoms.
    #[arg(long, value_name = "MASS")]
    hmr: Option<String>,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let format = common.format(&Format::DOCUMENT_OR_FIGURE, Format::Text)?;
        let reading = self.reading()?;
        let advice = self.question(reading.as_ref())?.answer()?;
        match common.output.as_deref().filter(|_| format.is_figure()) {
            Some(path) => draw("output", path, &report::figure(&advice, "Which outer steps are safe")),
            None => {
                let text =
                    report::document(&advice, reading.as_ref(), format == Format::Csv).render(format)?;
                write_output(common.output.as_deref(), text.as_bytes())
            }
        }
    }

    /// What the engine's files say.
    fn reading(&self) -> Result<Option<Reading>> {
        if self.engine.is_empty() {
            return Ok(None);
        }
        let texts = self.engine.iter().map(|path| text(path)).collect::<Result<Vec<_>>>()?;
        let outer = self.steps.first().map(|steps| scheme(steps)).transpose()?;
        let texts: Vec<&str> = texts.iter().map(String::as_str).collect();
        engine::read(&texts, outer.as_ref().map(Scheme::outer)).map(Some)
    }

    fn question(&self, reading: Option<&Reading>) -> Result<Question> {
        let hydrogen = self.hmr.as_deref().map(heavy_hydrogen).transpose()?;
        if hydrogen.is_some() && self.bond.is_empty() {
            return Err(Error::input(
                "hmr",
                "given without a bond",
                "a period has no masses: give the bond, as CH:K=340kcal/mol/A^2,12.011,1.008",
            ));
        }
        let bonds = self.bond.iter().map(|text| Mode::from_bond(text, hydrogen.as_ref()));
        let periods = self.period.iter().map(|text| Mode::from_period(text));
        let mut modes = bonds.chain(periods).collect::<Result<Vec<_>>>()?;
        for entry in &self.on {
            place(&mut modes, entry)?;
        }
        // The engine's own scheme first; a step alone is then the outer one that the engine's text lacks.
        let own = reading.map(|reading| reading.scheme.clone());
        let given = self.steps.iter().map(|steps| scheme(steps)).collect::<Result<Vec<_>>>()?;
        let others = given.into_iter().filter(|scheme| own.is_none() || scheme.steps().len() > 1);
        let schemes = own.iter().cloned().chain(others).collect();
        let question = Question::new(modes, schemes, part("band", &self.band)?)?;
        Ok(match &self.length {
            Some(length) => question.of_length(unit::rational("length", length, Dimension::Time)?),
            None => question,
        })
    }
}

fn text(path: &Path) -> Result<String> {
    std::fs::read_to_string(path).map_err(|cause| Error::io(path.display(), &cause).caused_by(cause))
}

fn heavy_hydrogen(text: &str) -> Result<Rational> {
    let with_unit = unit::dimension(text).map_or_else(|| format!("{text}amu"), |_| text.into());
    unit::rational("hmr", &with_unit, Dimension::Mass)
}

/// `OH=2`: the mode OH on the second clock.
fn place(modes: &mut [Mode], entry: &str) -> Result<()> {
    let form = || Error::input("on", entry, "write NAME=CLOCK, as OH=1; 1 is the fastest clock");
    let (name, clock) = entry.rsplit_once('=').ok_or_else(form)?;
    let clock = clock.trim().parse::<usize>().ok().and_then(|clock| clock.checked_sub(1)).ok_or_else(form)?;
    let names: Vec<String> = modes.iter().map(|mode| mode.name.clone()).collect();
    let found = modes.iter_mut().find(|mode| mode.name == name.trim());
    let mode = found.ok_or_else(|| {
        Error::input("on", entry, format!("there is no mode of this name, but {}", names.join(", ")))
    })?;
    mode.clock = Some(clock);
    Ok(())
}

fn scheme(text: &str) -> Result<Scheme> {
    Scheme::new(
        text.split(',').map(|step| unit::rational("steps", step, Dimension::Time)).collect::<Result<_>>()?,
    )
}

/// `5%` or `1/20`.
fn part(field: &str, text: &str) -> Result<Rational> {
    match text.trim().strip_suffix('%') {
        Some(percent) => Ok(parse_rational(field, percent)? / Rational::from_integer(100.into())),
        None => parse_rational(field, text),
    }
}
