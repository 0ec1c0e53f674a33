//! `run` and `check`.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
};

use schuler_studies::{
    Context, Diagnostic, Error, Record, Scenario, record::Folder, run as run_study, scenario::Study,
};

use crate::{
    End,
    args::{RunArgs, ScenarioArgs},
    monte_carlo::{self, Only},
    progress::Bar,
    report::report,
};

/// Checks scenarios.
pub fn check(args: &ScenarioArgs) -> io::Result<End> {
    let mut end = End::Success;
    for file in &args.files {
        match Scenario::from_file(file, &args.overrides()) {
            Ok(scenario) => {
                writeln!(io::stdout(), "{}: valid, {} study", file.display(), scenario.study.name())?;
            }
            Err(error) => {
                report(&error)?;
                end = End::BadInput;
            }
        }
    }
    Ok(end)
}

/// Runs scenarios. All are checked before the first one runs.
pub fn run(args: &RunArgs) -> io::Result<End> {
    if let Some(clash) = clash(args) {
        report(&clash.into())?;
        return Ok(End::BadInput);
    }
    let only = Only::of(args);
    let mut jobs = Vec::new();
    for file in &args.scenarios.files {
        let job = Scenario::from_file(file, &args.scenarios.overrides()).and_then(|scenario| {
            if only.is_some() {
                monte_carlo::study(&scenario)?;
            }
            let folder = match &only {
                Some(Only::Part(_)) => Folder::check_for_part(out(args, file))?,
                _ => Folder::check(out(args, file))?,
            };
            Ok((scenario, folder))
        });
        match job {
            Ok(job) => jobs.push(job),
            Err(error) => report(&error)?,
        }
    }
    if jobs.len() < args.scenarios.files.len() {
        return Ok(End::BadInput);
    }
    let mut end = End::Success;
    for (scenario, folder) in &jobs {
        if let Some(only) = &only {
            match monte_carlo::only(only, args, scenario, folder)? {
                End::Success => continue,
                end => return Ok(end),
            }
        }
        let record = match one(args.data.as_deref(), args.quiet, scenario, folder) {
            Ok(record) => record,
            Err(error) => {
                report(&error)?;
                return Ok(End::BadInput);
            }
        };
        if let End::ExpectFailed = show(&record, folder, args.quiet)? {
            end = End::ExpectFailed;
        }
    }
    Ok(end)
}

/// Tells what was found and where it is.
pub fn show(record: &Record, folder: &Folder, quiet: bool) -> io::Result<End> {
    if !quiet {
        writeln!(io::stdout(), "{}\nwritten to {}", record.summary_text(), folder.path().display())?;
    }
    for verdict in record.verdicts.iter().filter(|v| !v.holds) {
        writeln!(io::stderr(), "expect failed: {verdict}")?;
    }
    Ok(if record.holds() { End::Success } else { End::ExpectFailed })
}

/// Runs a scenario and leaves the results in `folder`; `data` is the folder of recorded logs.
pub fn one(data: Option<&Path>, quiet: bool, scenario: &Scenario, folder: &Folder) -> Result<Record, Error> {
    let bar = Bar::new(quiet);
    let context = Context { data: data.map(Path::to_path_buf), progress: &bar };
    if let Study::MonteCarlo(study) = &scenario.study {
        let result = monte_carlo::whole(scenario, study, folder, &context);
        bar.finish();
        return result;
    }
    let result = run_study(scenario, &context);
    bar.finish();
    let mut record = result?;
    record.header.command = command();
    folder.write(&record, scenario.output.formats)?;
    Ok(record)
}

/// What was typed.
pub fn command() -> String {
    let words = std::env::args().skip(1).map(|word| match word.contains([' ', '\'', '"', '(', '[']) {
        true => format!("'{}'", word.replace('\'', "'\\''")),
        false => word,
    });
    std::iter::once("schuler".to_string()).chain(words).collect::<Vec<_>>().join(" ")
}

/// The folder of a scenario's results.
fn out(args: &RunArgs, file: &Path) -> PathBuf {
    let mut stem = file.file_stem().unwrap_or(file.as_os_str()).to_os_string();
    if let Some(only) = Only::of(args) {
        stem.push(format!("-{}", only.name()));
    }
    match &args.out {
        Some(out) if args.scenarios.files.len() == 1 => out.clone(),
        Some(out) => out.join(stem),
        None => Path::new("out").join(stem),
    }
}

/// Two scenarios whose results would go into one folder, where the second would take the place of the first.
fn clash(args: &RunArgs) -> Option<Diagnostic> {
    let files = &args.scenarios.files;
    files.iter().enumerate().find_map(|(k, file)| {
        let folder = out(args, file);
        let first = files[..k].iter().find(|first| out(args, first) == folder)?;
        let problem = format!("its results would take the place of those of {}", first.display());
        let diagnostic = Diagnostic::new(file, problem)
            .expected("scenarios of different file names: each name is the name of a folder")
            .found(format!("{} for both", folder.display()))
            .help("run them one by one, each with a folder of its own: --out DIR");
        Some(diagnostic)
    })
}
