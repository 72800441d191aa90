//! `kickdrift advise`: which steps are safe, for how long, and why.

use std::path::{Path, PathBuf};

use super::args::Common;
use super::paper::Paper;
use super::progress::announce;
use super::system;
use crate::advise::engine::{self, Reading};
use crate::advise::unit::{self, Dimension, decimal};
use crate::advise::{Constraints, Mode, Molecule, Question, Scheme};
use crate::error::{Error, Result};
use crate::format::Format;
use crate::number::Rational;
use crate::number::parse::parse_rational;
use crate::report::advise as report;
use crate::scene::{SystemScene, file, of_archive};

/// Fastest periods of molecules, in fs.
const PLAUSIBLE: std::ops::RangeInclusive<f64> = 3.0..=3000.0;

/// Kicks a second that advice on periods follows, and products a second of advice on Hessians, as measured.
const KICKS_A_SECOND: f64 = 5e6;
const PRODUCTS_A_SECOND: f64 = 1e10;

/// Flags of `advise`.
///
/// --output FILE.svg, FILE.pdf or FILE.png draws: the outer step across, each mode a row.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Hessians in place of periods: a system file of two steps, or FILE.npz.
    ///
    /// The file's steps are the first scheme; an archive holds fast, slow (mass-weighted, 1/ps^2), masses and positions.
    #[arg(value_name = "FILE", conflicts_with_all = ["period", "bond", "on"])]
    file: Option<PathBuf>,
    /// A period or wavenumber of a force, as OH=10fs or 3700/cm; the last ones are on the slower clocks
    #[arg(long, value_name = "[NAME=]T")]
    period: Vec<String>,
    /// A bond: k of E = k x^2/2 or K of E = K x^2, two masses in amu, the heavy atom's hydrogens if not 1
    #[arg(long, value_name = "NAME:k=X,M1,M2[,N]")]
    bond: Vec<String>,
    /// The clocks of modes, 1 the fastest, as OH=1,bend=2.
    #[arg(long, value_name = "NAME=CLOCK,...", value_delimiter = ',')]
    on: Vec<String>,
    /// The steps from the innermost to the outermost one; again for another scheme.
    #[arg(long, value_name = "0.5fs,4fs")]
    steps: Vec<String>,
    /// An input of OpenMM, LAMMPS, GROMACS, NAMD, Tinker or i-PI, for its steps; twice with an OpenMM system
    #[arg(long, value_name = "FILE")]
    engine: Vec<PathBuf>,
    /// How far every period may be off.
    #[arg(long, value_name = "PART", default_value = "5%")]
    band: String,
    /// The length of the run, as 10ns.
    #[arg(long, value_name = "TIME")]
    length: Option<String>,
    /// The friction of the thermostat, as 1/ps: does it mask what grows?
    #[arg(long, value_name = "RATE")]
    friction: Option<String>,
    /// Bonds that do not vibrate: h-bonds, all-bonds, or modes, as OH,NH [default: as the engine's text says]
    ///
    /// Of Hessians h-bonds only, with the force of each potential in the file.
    #[arg(long, value_name = "WHICH")]
    constraints: Option<String>,
    /// Hydrogens of this mass in amu, taken from their heavy atoms.
    #[arg(long, value_name = "MASS")]
    hmr: Option<String>,
    #[command(flatten)]
    paper: Paper,
}

impl Args {
    pub fn run(&self, common: &Common) -> Result<()> {
        let format = common.format(&Format::DOCUMENT_OR_FIGURE, Format::Text)?;
        self.paper.check(format.is_figure())?;
        let reading = self.reading()?;
        if let Some(path) = &self.file {
            return self.molecule(path, reading.as_ref(), common);
        }
        let question = self.question(reading.as_ref())?.within(common.limits());
        announce(common.quiet, "advice on these steps", question.cost() as f64 / KICKS_A_SECOND);
        let advice = question.answer()?;
        let document = |format| report::document(&advice, reading.as_ref(), format == Format::Csv);
        match common.output.as_deref().filter(|_| format.is_figure()) {
            Some(path) => {
                let figure = report::figure(&advice, "Which outer steps are safe");
                self.paper.draw("output", path, figure, common)?;
            }
            None => common.write(&document(format), format)?,
        }
        common.tell_beside_output(&document(Format::Text))
    }

    fn molecule(&self, path: &Path, reading: Option<&Reading>, common: &Common) -> Result<()> {
        let archive = path.extension().is_some_and(|extension| extension == "npz");
        let scene = if archive { self.archive(path, reading, common)? } else { system::read(path, common)? };
        let scene = self.changed(scene)?;
        let (band, length, friction) = (part("band", &self.band)?, self.run_length()?, self.friction()?);
        let asked = self.given(reading)?;
        let size = scene.model().size();
        let cost = Molecule::allow(
            size,
            (asked.len() + usize::from(!archive)).max(1),
            friction.is_some(),
            common.budget,
        )?;
        announce(
            common.quiet,
            &format!("advice on {size} degrees of freedom"),
            cost as f64 / PRODUCTS_A_SECOND,
        );
        let (molecule, own) = scene.molecule()?;
        let own = reading.map_or(own, |reading| reading.scheme.clone());
        let given = asked.into_iter().filter(|scheme| !archive || *scheme != own);
        let schemes: Vec<Scheme> = [own.clone()].into_iter().chain(given).collect();
        let findings = molecule.advise(&schemes, &band, length.as_ref(), friction.as_ref())?;
        let fastest = findings.groups[0].period.0;
        if archive && !PLAUSIBLE.contains(&fastest) {
            let given = format!("a fastest period of {fastest:.1e} fs");
            let remedy =
                "an archive is read as mass-weighted, in 1/ps^2: write a system file that says what it is";
            return Err(Error::input("fast", given, remedy));
        }
        let read =
            archive.then(|| "fast and slow as mass-weighted, in 1/ps^2, known to 1e-6 of their norms".into());
        let heavy =
            self.hmr.as_ref().map(|mass| format!("hydrogens of {mass}, their nearest heavy atoms lighter"));
        let notes: Vec<String> = read.into_iter().chain(heavy).collect();
        let document = report::of_molecule(&findings, reading, &notes);
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let document = document.input("file", name).input_json("system", scene.source().clone());
        let format = common.format(&Format::DOCUMENT_OR_FIGURE, Format::Text)?;
        match common.output.as_deref().filter(|_| format.is_figure()) {
            Some(path) => {
                let figure = report::figure_of_molecule(&findings, "Which outer steps are safe");
                self.paper.draw("output", path, figure, common)?;
            }
            None => common.write(&document, format)?,
        }
        common.tell_beside_output(&document)
    }

    /// The arrays of an archive, with the steps given.
    fn archive(&self, path: &Path, reading: Option<&Reading>, common: &Common) -> Result<SystemScene> {
        let own = reading.map(|reading| reading.scheme.clone());
        let scheme = own.or(self.given(reading)?.into_iter().next());
        let needed = || Error::missing("steps", "give the inner and the outer step, as 0.5fs,4fs");
        let scheme = scheme.ok_or_else(needed)?;
        let [inner, outer] = scheme.steps() else { return Err(needed()) };
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        SystemScene::from_json_in(system::arrays(path, common), of_archive(&name, [inner, outer]))
    }

    /// With the hydrogens and the constraints of the command line.
    fn changed(&self, scene: SystemScene) -> Result<SystemScene> {
        let mass = self.hmr.as_deref().map(heavy_hydrogen).transpose()?.map(|mass| decimal(&mass));
        let held = self.constraints.as_deref().map(|which| which.trim().to_string());
        if mass.is_none() && held.is_none() {
            return Ok(scene);
        }
        let fields = [("hydrogen_mass", mass), ("constraints", held)].into_iter();
        scene.with_fields(fields.filter_map(|(key, value)| Some((key, value?))))
    }

    fn friction(&self) -> Result<Option<Rational>> {
        self.friction.as_deref().map(|rate| unit::rational("friction", rate, Dimension::Rate)).transpose()
    }

    fn run_length(&self) -> Result<Option<Rational>> {
        self.length.as_deref().map(|length| unit::rational("length", length, Dimension::Time)).transpose()
    }

    /// The schemes of the command line; beside an engine's a step alone is the outer one that its text lacks.
    fn given(&self, reading: Option<&Reading>) -> Result<Vec<Scheme>> {
        let given = self.steps.iter().map(|steps| scheme(steps)).collect::<Result<Vec<_>>>()?;
        Ok(given.into_iter().filter(|scheme| reading.is_none() || scheme.steps().len() > 1).collect())
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
        // The engine's own scheme first.
        let own = reading.map(|reading| reading.scheme.clone());
        let schemes = own.into_iter().chain(self.given(reading)?).collect();
        let asked = self.constraints.as_deref().map(Constraints::parse);
        let constraints = asked.or_else(|| reading.and_then(|reading| reading.constraints.clone()));
        let (modes, held) = match constraints {
            Some(constraints) => constraints.split(modes)?,
            None => (modes, Vec::new()),
        };
        let mut question = Question::new(modes, schemes, part("band", &self.band)?)?.holding(held);
        if let Some(length) = self.run_length()? {
            question = question.of_length(length)?;
        }
        match self.friction()? {
            Some(rate) => question.with_friction(rate),
            None => Ok(question),
        }
    }
}

fn text(path: &Path) -> Result<String> {
    file::text(path, file::LONGEST).map_err(|cause| {
        Error::io(path.display(), format!("cannot read it ({cause}): name an engine's input"))
            .caused_by(cause)
    })
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
