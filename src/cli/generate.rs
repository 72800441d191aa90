//! `kickdrift generate`: what packagers need, made from the commands themselves.

use std::path::PathBuf;

use clap::{Command, ValueEnum};
use clap_complete::Shell;

use super::args::Common;
use documents::report::file::{Folder, write_output};
use number::{Error, Result};

/// Flags of `generate`.
///
/// Files go to the folder of --output, out/man or out/completions unless it is given.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// What to write.
    #[arg(value_enum)]
    what: What,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum What {
    /// A page for man(1) of the program and of each command.
    Man,
    /// Completions for bash, elvish, fish, PowerShell and zsh.
    Completions,
}

impl Args {
    /// Writes the files; `program` is the whole of the commands.
    pub fn run(&self, program: Command, common: &Common) -> Result<()> {
        let (default, files) = match self.what {
            What::Man => ("man", pages(program)?),
            What::Completions => ("completions", completions(program)),
        };
        let default = || PathBuf::from("out").join(default);
        let folder = Folder::make(&common.output.clone().unwrap_or_else(default))?;
        let count = files.len();
        for (name, bytes) in files {
            write_output(Some(&folder.path().join(name)), &bytes)?;
        }
        common.wrote(format_args!("{count} files to {}", folder.path().display()));
        folder.keep();
        Ok(())
    }
}

/// A file's name and its bytes.
type File = (String, Vec<u8>);

fn pages(mut program: Command) -> Result<Vec<File>> {
    program.build();
    let commands = program.get_subcommands().filter(|command| command.get_name() != "help");
    std::iter::once(&program).chain(commands).map(page).collect()
}

fn page(command: &Command) -> Result<File> {
    let (man, mut bytes) = (clap_mangen::Man::new(command.clone()), Vec::new());
    let name = man.get_filename();
    man.render(&mut bytes).map_err(|cause| Error::io(&name, &cause).caused_by(cause))?;
    Ok((name, bytes))
}

fn completions(program: Command) -> Vec<File> {
    let one = |shell: &Shell| {
        let mut bytes = Vec::new();
        clap_complete::generate(*shell, &mut program.clone(), "kickdrift", &mut bytes);
        (clap_complete::Generator::file_name(shell, "kickdrift"), bytes)
    };
    Shell::value_variants().iter().map(one).collect()
}
