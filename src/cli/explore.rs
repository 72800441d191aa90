//! `kickdrift explore`: a page on this machine to move in the plane of steps.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::args::Common;
use crate::explore::Session;
use crate::explore::serve::Server;
use documents::input::{SystemScene, json};
use documents::question::{Scene, flag};
use documents::report::file::{private, write_output};
use number::{Error, ExactSign, Laurent, Rational, Result, Sign, file};

/// Flags of `explore`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A scene or a system, a JSON file as data/scenes/figure1.json [default: Figure 1 of the paper].
    #[arg(value_name = "SCENE.json", conflicts_with_all = ["lambda1", "lambda2", "period"])]
    scene: Option<PathBuf>,
    /// The stiffness of the fast force, as 10 or pi^2.
    #[arg(long, value_name = "X", requires = "lambda2", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
    lambda1: Option<Laurent>,
    /// The stiffness of the slow force, as 2/5 or pi^2/25; may be negative.
    #[arg(long, value_name = "Y", requires = "lambda1", allow_hyphen_values = true, value_parser = flag::<Laurent>)]
    lambda2: Option<Laurent>,
    /// A period in place of a stiffness, (2 pi/T)^2: twice, the fast force first.
    #[arg(long, value_name = "T", conflicts_with_all = ["lambda1", "lambda2"], value_parser = flag::<Laurent>)]
    period: Vec<Laurent>,
    /// The unit of time, for the page's words.
    #[arg(long, value_name = "UNIT")]
    units: Option<String>,
    /// The port to listen at [default: a free one].
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Print the address and do not open the browser.
    #[arg(long)]
    no_open: bool,
}

impl Args {
    /// Serves the page until the process is interrupted.
    pub fn run(&self, common: &Common) -> Result<()> {
        let server = Server::bind(self.session()?, self.port, common.threads())?;
        let address = server.address();
        write_output(None, format!("{address}\n").as_bytes())?;
        if !self.no_open && open(&address).is_err() && !common.quiet {
            eprintln!("kickdrift: no browser could be started: open the address above");
        }
        match server.run()? {}
    }

    /// The session that the page starts on.
    fn session(&self) -> Result<Session> {
        let session = match (&self.scene, &self.lambda1, &self.lambda2, self.period.as_slice()) {
            (Some(path), ..) => of_file(path)?,
            (None, Some(lambda1), Some(lambda2), _) => Session::new(lambda1.clone(), lambda2.clone())?,
            (None, _, _, [fast, slow]) => Session::new(stiffness(fast)?, stiffness(slow)?)?,
            (None, _, _, []) => Session::figure1(),
            (None, _, _, other) => {
                let given = format!("given {} times", other.len());
                return Err(Error::input("period", given, "give it twice, the fast force's first"));
            }
        };
        Ok(match &self.units {
            Some(unit) => session.in_unit(unit),
            None => session,
        })
    }
}

/// (2π/T)².
fn stiffness(period: &Laurent) -> Result<Laurent> {
    let four_pi_squared = Laurent::monomial(Rational::from_integer(4.into()), 2);
    let squared =
        (period.sign() == Sign::Positive).then(|| four_pi_squared.checked_div(&(period * period))).flatten();
    squared.ok_or_else(|| {
        Error::input("period", period, "must be positive, a number or one times a power of pi")
    })
}

/// A scene, or a system, whose schema says that it is one.
fn of_file(path: &Path) -> Result<Session> {
    let text = file::text(path, file::LONGEST).map_err(|cause| {
        let text = format!("cannot read it ({cause}): name a scene or a system, as data/scenes/figure1.json");
        Error::io(path.display(), text).caused_by(cause)
    })?;
    let value: serde_json::Value = json::from_str(&text).unwrap_or_default();
    if value["schema"].as_str().is_some_and(|schema| schema.starts_with("kickdrift/system/")) {
        let folder = path.parent().unwrap_or(Path::new(""));
        return Ok(Session::of_system(SystemScene::read_in(folder, &text)?));
    }
    Session::of_scene(&Scene::from_json(&text)?)
}

/// Starts a browser on a file that leads to the address: every user sees the arguments of all processes, and
/// the address is the key to the page.
fn open(address: &str) -> std::io::Result<()> {
    let page = format!(
        "<!doctype html><meta http-equiv=\"refresh\" content=\"0; url={address}\"><title>kickdrift explore</title>\n"
    );
    let path = private(".html", page.as_bytes())?;
    let (program, first): (&str, &[&str]) = match std::env::consts::OS {
        "macos" => ("open", &[]),
        "windows" => ("rundll32", &["url.dll,FileProtocolHandler"]),
        _ => ("xdg-open", &[]),
    };
    let mut command = Command::new(program);
    command.args(first).arg(path).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().map(drop)
}
