//! Arguments of the command line.

use std::path::PathBuf;

use clap::{Args as ClapArgs, Parser, Subcommand};
use schuler_studies::monte_carlo::Part;

/// Strapdown-navigation error propagation: IMU error sources, mechanization, drift, alignment, error budgets, Monte Carlo.
#[derive(Debug, Parser)]
#[command(name = "schuler", version, about, max_term_width = 100)]
#[command(after_help = "Exit codes: 0 success, 1 an `expect` of a scenario failed, 2 bad input.")]
pub struct Args {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run scenarios; write tables, figures and a summary of each into a folder. `study:` in a scenario says what is done:
    /// `simulate` makes logs of a motion, `navigate` follows logs, `drift` and `budget` say what each error source does,
    /// `monte_carlo` makes runs of them, `align` aligns, `imu` and `allan` look at sensors alone.
    Run(RunArgs),
    /// Merge parts of a Monte Carlo that were run anywhere, in any order, into the result of one process.
    Merge(MergeArgs),
    /// Print a job script that runs a Monte Carlo in parts and merges them.
    Plan(PlanArgs),
    /// Allan deviations of a recorded log at rest, and the error model that they show.
    Allan(AllanArgs),
    /// Read scenarios and say whether they are valid; nothing is run or written.
    Check(ScenarioArgs),
    /// Print the JSON Schema of the scenario format.
    Schema,
    /// Print the tables of error terms and processes.
    Sources {
        /// Print the page of the documentation: terms, processes and presets.
        #[arg(long)]
        markdown: bool,
    },
    /// Print the presets: devices and grades with their figures as printed and in SI.
    Presets,
    /// Print completions for a shell.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
}

/// Which scenarios, and what is changed in them.
#[derive(Debug, ClapArgs)]
pub struct ScenarioArgs {
    /// Scenario files (YAML).
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Change a value before the scenario is checked: imu.rate='200 Hz', imu.gyro[0].bias.…; repeatable.
    #[arg(long, value_name = "KEY.PATH=VALUE")]
    pub set: Vec<String>,
    /// Master seed of every random draw; the same as --set seed=N.
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
}

/// Arguments of `run`.
#[derive(Debug, ClapArgs)]
pub struct RunArgs {
    #[command(flatten)]
    pub scenarios: ScenarioArgs,
    /// Folder of the results; out/<name of the scenario> when absent. Of several scenarios, each gets a folder in it.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Folder of recorded logs.
    #[arg(long, value_name = "DIR", env = "SCHULER_DATA")]
    pub data: Option<PathBuf>,
    /// Of a Monte Carlo only the runs from A to the one before B, as a part to be merged.
    #[arg(long, value_name = "A..B", value_parser = Part::parse_runs, conflicts_with_all = ["shard", "run"])]
    pub runs: Option<Part>,
    /// Of a Monte Carlo only part K of N, from 1 on, to be merged.
    #[arg(long, value_name = "K/N", value_parser = Part::parse_shard, conflicts_with = "run")]
    pub shard: Option<Part>,
    /// Of a Monte Carlo only run N, from 0 on, with its errors sample by sample.
    #[arg(long, value_name = "N")]
    pub run: Option<u64>,
    /// Print nothing but errors.
    #[arg(long)]
    pub quiet: bool,
}

/// Arguments of `merge`.
#[derive(Debug, ClapArgs)]
pub struct MergeArgs {
    /// Folders of all parts.
    #[arg(required = true, value_name = "DIR")]
    pub parts: Vec<PathBuf>,
    /// Folder of the results; out/<name of the scenario> when absent.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print nothing but errors.
    #[arg(long)]
    pub quiet: bool,
}

/// Arguments of `plan`.
#[derive(Debug, ClapArgs)]
#[command(group = clap::ArgGroup::new("engine").required(true))]
pub struct PlanArgs {
    /// Scenario file (YAML).
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// A Slurm job array of so many parts.
    #[arg(long, value_name = "N", group = "engine")]
    pub slurm: Option<u64>,
    /// A script for GNU parallel with so many parts.
    #[arg(long, value_name = "N", group = "engine")]
    pub gnu_parallel: Option<u64>,
    /// Change a value before the scenario is checked; repeatable.
    #[arg(long, value_name = "KEY.PATH=VALUE")]
    pub set: Vec<String>,
    /// Master seed of every random draw; the same as --set seed=N.
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Folder of the results; out/<name of the scenario> when absent. Parts go into a folder beside it.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Arguments of `allan`.
#[derive(Debug, ClapArgs)]
#[command(after_help = "Examples:
  schuler allan imu.csv --rate 100Hz --columns gyro=gx,gy,gz accel=ax,ay,az --scale gyro='0.1 arcsec' accel='1 mm/s'
  schuler allan gyro.npy --rate 1kHz --columns gyro=1 --scale gyro='1 deg/s'

The result is that of a scenario with `study: allan`.")]
pub struct AllanArgs {
    /// The log: CSV or npy, either also gzipped, or Parquet; looked up in this folder, then in that of `--data`.
    pub log: String,
    /// Samples a second: 100Hz.
    #[arg(long, value_name = "QUANTITY")]
    pub rate: String,
    /// Columns of x, y, z (or of the first of them), by name or number from 1; what the header says when absent.
    #[arg(long, value_name = "INSTRUMENT=X,Y,Z", num_args = 1..)]
    pub columns: Vec<String>,
    /// What one count is, one for an instrument or three; its unit says what it is of where that is not named.
    #[arg(long, value_name = "INSTRUMENT=QUANTITY", num_args = 1..)]
    pub scale: Vec<String>,
    /// What a row holds, increments or rates; told by the unit of `--scale` when absent.
    #[arg(long, value_name = "WORD")]
    pub content: Option<String>,
    /// Column of time, which is then checked for gaps and order.
    #[arg(long, value_name = "COLUMN")]
    pub time: Option<String>,
    /// Sensor axes that point forward, right and down: y,x,-z for a sensor with x right, y forward, z up.
    #[arg(long, value_name = "X,Y,Z", value_delimiter = ',', allow_hyphen_values = true)]
    pub axes: Vec<String>,
    /// What is written: csv, png, svg; csv and png when absent.
    #[arg(long, value_name = "FORMAT,…", value_delimiter = ',')]
    pub formats: Vec<String>,
    /// Folder of the results; out/<name of the log> when absent.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Folder of recorded logs.
    #[arg(long, value_name = "DIR", env = "SCHULER_DATA")]
    pub data: Option<PathBuf>,
    /// Print nothing but errors.
    #[arg(long)]
    pub quiet: bool,
}

impl ScenarioArgs {
    /// Every change of the document, in order.
    pub fn overrides(&self) -> Vec<String> {
        overrides(&self.set, self.seed)
    }
}

impl PlanArgs {
    /// Every change of the document, in order.
    pub fn overrides(&self) -> Vec<String> {
        overrides(&self.set, self.seed)
    }
}

fn overrides(set: &[String], seed: Option<u64>) -> Vec<String> {
    set.iter().cloned().chain(seed.map(|seed| format!("seed={seed}"))).collect()
}
