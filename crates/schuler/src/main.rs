//! The command line of Schuler.

mod allan;
mod args;
mod monte_carlo;
mod progress;
mod report;
mod run;
mod tables;

use std::{
    io::{self, Write},
    process::ExitCode,
};

use args::{Args, Command};
use clap::{CommandFactory, Parser};

/// What a command ends with.
enum End {
    /// All is well.
    Success,
    /// A run is complete, but an `expect` of it does not hold.
    ExpectFailed,
    /// The input cannot be used, or the result cannot be kept; the user has been told.
    BadInput,
}

fn main() -> ExitCode {
    let args = match Args::try_parse() {
        Ok(args) => args,
        // Help and version are no errors; clap knows which stream is theirs.
        Err(error) => {
            let _ = error.print();
            return ExitCode::from(if error.use_stderr() { 2 } else { 0 });
        }
    };
    let end = match args.command {
        Command::Run(args) => run::run(&args),
        Command::Merge(args) => monte_carlo::merge(&args),
        Command::Plan(args) => monte_carlo::plan(&args),
        Command::Allan(args) => allan::allan(&args),
        Command::Check(args) => run::check(&args),
        Command::Schema => print(&schuler_studies::scenario::json_schema()),
        Command::Sources { markdown: false } => print(&tables::sources()),
        Command::Sources { markdown: true } => print(&tables::page()),
        Command::Presets => print(&tables::presets()),
        Command::Completions { shell } => {
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut Args::command(), "schuler", &mut text);
            print(&String::from_utf8_lossy(&text))
        }
    };
    match end {
        Ok(End::Success) => ExitCode::SUCCESS,
        Ok(End::ExpectFailed) => ExitCode::from(1),
        Ok(End::BadInput) => ExitCode::from(2),
        // Whoever read our output has read enough.
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(error) => {
            let _ = writeln!(io::stderr(), "error: {error}");
            ExitCode::from(2)
        }
    }
}

fn print(text: &str) -> io::Result<End> {
    io::stdout().write_all(text.as_bytes())?;
    Ok(End::Success)
}
