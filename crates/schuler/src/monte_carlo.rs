//! What only a Monte Carlo has: parts, single runs, merging, and scripts for those who have many machines.

use std::{
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
};

use schuler_studies::{
    Context, Diagnostic, Error, Record, Scenario,
    monte_carlo::{self, Origin, Part},
    record::Folder,
    scenario::{MonteCarlo, Study},
};

use crate::{
    End,
    args::{MergeArgs, PlanArgs, RunArgs},
    progress::Bar,
    report::report,
    run::{command, show},
};

/// Something else than all runs of the study.
pub enum Only {
    /// Some of them, to be merged with others.
    Part(Part),
    /// One of them, sample by sample.
    Run(u64),
}

impl Only {
    /// What the arguments ask for.
    pub fn of(args: &RunArgs) -> Option<Only> {
        let part = args.runs.clone().or_else(|| args.shard.clone());
        part.map(Only::Part).or(args.run.map(Only::Run))
    }

    /// The end of the name of its folder.
    pub fn name(&self) -> String {
        match self {
            Only::Part(part) => part.name(),
            Only::Run(run) => format!("run-{run}"),
        }
    }
}

/// The study of a scenario, which must be a Monte Carlo.
pub fn study(scenario: &Scenario) -> Result<&MonteCarlo, Diagnostic> {
    match &scenario.study {
        Study::MonteCarlo(study) => Ok(study),
        other => Err(Diagnostic::new(&scenario.file, "only a Monte Carlo has runs with numbers")
            .path("study")
            .expected("`monte_carlo`")
            .found(format!("`{}`", other.name()))),
    }
}

/// Runs the whole study; finished runs are kept beside the folder until the results are in it.
pub fn whole(
    scenario: &Scenario,
    study: &MonteCarlo,
    folder: &Folder,
    context: &Context,
) -> Result<Record, Error> {
    let kept = monte_carlo::kept(folder.path());
    let mut record = monte_carlo::run_kept(scenario, study, context, &kept)?;
    record.header.command = command();
    folder.write(&record, scenario.output.formats)?;
    monte_carlo::discard(&kept)?;
    Ok(record)
}

/// Runs a part or a single run.
pub fn only(only: &Only, args: &RunArgs, scenario: &Scenario, folder: &Folder) -> io::Result<End> {
    let bar = Bar::new(args.quiet);
    let context = Context { data: args.data.clone(), progress: &bar };
    let result = study(scenario).map_err(Error::from).and_then(|study| match only {
        Only::Part(part) => made(scenario, study, args, part, folder, &context),
        Only::Run(run) => {
            let mut record = monte_carlo::replay(scenario, study, *run, &context)?;
            record.header.command = command();
            folder.write(&record, scenario.output.formats)?;
            Ok(record.summary_text())
        }
    });
    bar.finish();
    match result {
        Ok(text) => {
            if !args.quiet {
                writeln!(io::stdout(), "{text}\nwritten to {}", folder.path().display())?;
            }
            Ok(End::Success)
        }
        Err(error) => {
            report(&error)?;
            Ok(End::BadInput)
        }
    }
}

fn made(
    scenario: &Scenario,
    study: &MonteCarlo,
    args: &RunArgs,
    part: &Part,
    folder: &Folder,
    context: &Context,
) -> Result<String, Error> {
    let file = scenario.file.clone();
    let text = fs::read_to_string(&file).map_err(|source| Error::Read { path: file.clone(), source })?;
    let origin = Origin { file, text, overrides: args.scenarios.overrides() };
    let kept = monte_carlo::kept(folder.path());
    let digest = monte_carlo::part(scenario, study, &origin, part, (folder, &kept), context)?;
    monte_carlo::discard(&kept)?;
    Ok(format!("{}: {}, digest {digest}", scenario.title, part.name()))
}

/// Merges parts.
pub fn merge(args: &MergeArgs) -> io::Result<End> {
    let bar = Bar::new(args.quiet);
    let result = monte_carlo::merge(&args.parts, &bar).and_then(|(scenario, mut record)| {
        record.header.command = command();
        let out = args.out.clone().unwrap_or_else(|| default_out(&scenario.file));
        let folder = Folder::check(out)?;
        folder.write(&record, scenario.output.formats)?;
        Ok((record, folder))
    });
    bar.finish();
    match result {
        Ok((record, folder)) => show(&record, &folder, args.quiet),
        Err(error) => {
            report(&error)?;
            Ok(End::BadInput)
        }
    }
}

/// `out/name` of `somewhere/name.yaml`.
fn default_out(file: &Path) -> PathBuf {
    Path::new("out").join(file.file_stem().unwrap_or(file.as_os_str()))
}

/// Prints a job script.
pub fn plan(args: &PlanArgs) -> io::Result<End> {
    let overrides = args.overrides();
    let checked = Scenario::from_file(&args.file, &overrides).and_then(|scenario| {
        let study = study(&scenario)?;
        let parts = args.slurm.or(args.gnu_parallel).unwrap_or(1);
        if parts == 0 || parts > study.runs {
            return Err(Diagnostic::new(&args.file, "the study has not so many parts")
                .path("monte_carlo.runs")
                .expected(format!("1 to {}", study.runs))
                .found(parts.to_string())
                .into());
        }
        Ok(parts)
    });
    let parts = match checked {
        Ok(parts) => parts,
        Err(error) => {
            report(&error)?;
            return Ok(End::BadInput);
        }
    };
    let out = args.out.clone().unwrap_or_else(|| default_out(&args.file));
    let mut folder = out.clone().into_os_string();
    folder.push(".parts");
    let (out, folder) = (quoted(&out.display().to_string()), quoted(&folder.to_string_lossy()));
    let mut run = format!("schuler run {}", quoted(&args.file.display().to_string()));
    for setting in &overrides {
        run += &format!(" --set {}", quoted(setting));
    }
    let name = args.file.file_stem().unwrap_or_default().to_string_lossy().replace(char::is_whitespace, "_");
    let merge = format!(
        "parts=(); for k in $(seq 1 {parts}); do parts+=({folder}/\"$k\"); done\nschuler merge \"${{parts[@]}}\" --out {out}"
    );
    let script = if args.slurm.is_some() {
        format!(
            "#!/bin/bash
#SBATCH --job-name={name}
#SBATCH --array=1-{parts}
#SBATCH --cpus-per-task=1
# Save as {name}.sh. Parts, then the whole when all of them are there:
#   job=$(sbatch --parsable {name}.sh) && sbatch --dependency=afterok:$job {name}.sh merge
# A part that was killed goes on where it was when it is submitted again: sbatch --array=3,7 {name}.sh
set -euo pipefail
if [ \"${{1:-}}\" = merge ]; then
  [ \"${{SLURM_ARRAY_TASK_ID:-1}}\" = 1 ] || exit 0
{merge}
  exit
fi
export RAYON_NUM_THREADS=\"${{SLURM_CPUS_PER_TASK:-1}}\"
{run} --shard \"$SLURM_ARRAY_TASK_ID/{parts}\" --out {folder}/\"$SLURM_ARRAY_TASK_ID\" --quiet
"
        )
    } else {
        // Not `{{}}`, which may be in a name.
        let run = quoted(&format!("{run} --shard @k@/{parts} --out {folder}/@k@ --quiet"));
        format!(
            "#!/bin/bash
# Parts side by side, one a core, by GNU parallel; hosts are added with --sshlogin. Started again, what was killed goes on where it was.
set -euo pipefail
export RAYON_NUM_THREADS=1
seq 1 {parts} | parallel --halt soon,fail=1 -I @k@ {run}
{merge}
"
        )
    };
    io::stdout().write_all(script.as_bytes())?;
    Ok(End::Success)
}

/// A word of a shell.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-=".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.into()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}
