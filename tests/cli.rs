//! Exit codes, messages and streams of the command line.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
};

const SCENARIO: &str = "\
schuler: 1
study: imu
title: A test
motion: zero_truth
duration: 1 s
imu: { rate: 100 Hz, gyro: [{ bias: { constant: { value: 1 deg/h } } }] }
output: { formats: [csv] }
expect:
  - { quantity: omega_x_radps, at: final, value: 1 deg/h, tolerance: 1e-9 % }
";

/// A folder of its own for each test, gone afterwards.
pub struct Place(pub PathBuf);

impl Place {
    pub fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("schuler-cli-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a folder");
        fs::write(path.join("a.yaml"), SCENARIO).expect("a scenario");
        Place(path)
    }

    pub fn schuler(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("schuler"));
        command.current_dir(&self.0).env_remove("SCHULER_DATA").args(arguments).output().expect("it starts")
    }

    /// Everything below the folder but the scenario.
    pub fn left(&self) -> Vec<PathBuf> {
        let entries = fs::read_dir(&self.0).expect("a folder").map(|e| e.expect("an entry").path());
        entries.filter(|path| path.extension().is_none_or(|e| e != "yaml")).collect()
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn a_run_leaves_its_folder() {
    let place = Place::new("run");
    let output = place.schuler(&["run", "a.yaml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("expect holds"));
    assert_eq!(text(&output.stderr), "");
    let csv = fs::read_to_string(place.0.join("out/a/imu.csv")).expect("samples");
    assert_eq!(csv.lines().count(), 101);
    let summary = fs::read_to_string(place.0.join("out/a/summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&summary).expect("JSON");
    assert_eq!(summary["header"]["command"], "schuler run a.yaml");
    assert_eq!(summary["header"]["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(summary["expect"][0]["holds"], true);
    // Again, quietly, elsewhere and with another seed.
    let output = place.schuler(&["run", "a.yaml", "--quiet", "--out", "b", "--seed", "7"]);
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(0), String::new()));
    let summary = fs::read_to_string(place.0.join("b/summary.json")).expect("a summary");
    assert!(summary.contains("\"seed\": 7"));
}

#[test]
fn a_failed_expect_is_1() {
    let place = Place::new("expect");
    let output =
        place.schuler(&["run", "a.yaml", "--set", "imu.gyro[0].bias.constant.value=2 deg/h", "--quiet"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("expect failed: omega_x_radps at the end"));
    // The results are there to be looked at.
    assert!(place.0.join("out/a/summary.json").is_file());
}

#[test]
fn bad_input_is_2_and_leaves_nothing() {
    let place = Place::new("bad");
    let bad = |arguments: &[&str], message: &str| {
        let output = place.schuler(arguments);
        let error = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        assert!(error.contains(message), "{arguments:?}: {error}");
        assert_eq!(place.left(), Vec::<PathBuf>::new(), "{arguments:?}");
    };
    bad(&["run", "a.yaml", "--set", "duration=0 s"], "duration: must be more than zero");
    bad(&["run", "a.yaml", "--set", "nonsense"], "there is no `=`");
    bad(&["run", "missing.yaml"], "cannot read missing.yaml");
    bad(&["run", "a.yaml", "--out", "a.yaml"], "a.yaml: cannot write the results here");
    bad(&["run", "a.yaml", "--out", "a.yaml/below"], "a.yaml/below: cannot write the results here");
    bad(&["run", "a.yaml", "--out", "a.yaml/below"], "help: choose another folder with --out DIR");
    // Where not even root can make a folder.
    #[cfg(target_os = "linux")]
    bad(&["run", "a.yaml", "--out", "/proc/schuler/a"], "/proc/schuler/a: cannot write the results here");
    bad(&["run"], "Usage");
    bad(&["walk"], "unrecognized subcommand");
    fs::write(place.0.join("b.yaml"), SCENARIO.replace("1 deg/h } }", "1 dge/h } }")).expect("a scenario");
    // One bad scenario among good ones: nothing runs.
    bad(&["run", "a.yaml", "b.yaml"], "unknown unit `dge`");
    bad(&["check", "b.yaml"], "--> b.yaml:6:58");
}

#[test]
fn two_scenarios_of_one_name_are_refused() {
    let place = Place::new("names");
    fs::create_dir(place.0.join("other.yaml")).expect("a folder");
    fs::write(place.0.join("other.yaml/a.yaml"), SCENARIO).expect("a scenario");
    for arguments in [&["run", "a.yaml", "other.yaml/a.yaml"][..], &["run", "a.yaml", "a.yaml", "--out", "b"]]
    {
        let output = place.schuler(arguments);
        let error = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert!(error.contains(arguments[2]) && error.contains("those of a.yaml"), "{error}");
        assert!(error.contains("--out DIR"), "{error}");
        assert_eq!(place.left(), Vec::<PathBuf>::new());
    }
}

/// The message points at the place in the line.
#[test]
fn a_message_shows_the_line() {
    let place = Place::new("line");
    fs::write(place.0.join("a.yaml"), SCENARIO.replace("rate: 100 Hz", "rate: 100")).expect("a scenario");
    let output = place.schuler(&["check", "a.yaml"]);
    let expected = "\
error: imu.rate: a number without a unit
 --> a.yaml:6:14
  |
6 | imu: { rate: 100, gyro: [{ bias: { constant: { value: 1 deg/h } } }] }
  |              ^^^
  |
  = expected: a frequency (SI: 1/s)
  = found: 100
  = example: 100 Hz
";
    assert_eq!(text(&output.stderr), expected);
}

#[test]
fn check_runs_nothing() {
    let place = Place::new("check");
    let output = place.schuler(&["check", "a.yaml"]);
    assert_eq!((output.status.code(), text(&output.stdout)), (Some(0), "a.yaml: valid, imu study\n".into()));
    assert_eq!(place.left(), Vec::<PathBuf>::new());
}

/// `schuler … | head` ends the reader first; that is no fault of anybody.
#[test]
fn a_closed_pipe_is_success() {
    let place = Place::new("pipe");
    for arguments in [&["schema"][..], &["sources"], &["run", "a.yaml"]] {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("schuler"));
        let command =
            command.current_dir(&place.0).args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("it starts");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("it ends");
        assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()), "{arguments:?}");
    }
}

/// The tables name every term and process of the registries.
#[test]
fn sources_lists_the_registries() {
    let output = Place::new("sources").schuler(&["sources"]);
    let table = text(&output.stdout);
    let terms = schuler::imu::TERMS.iter().map(|t| t.name());
    for name in terms.chain(schuler::imu::PROCESSES.iter().map(|p| p.name())) {
        assert!(table.contains(&format!("| {name} |")), "{name}");
    }
}

/// Each `schuler …` command that the README shows is one that the program takes.
#[test]
fn commands_of_the_readme() {
    let readme =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")).expect("README.md");
    let help = text(&Place::new("readme").schuler(&["help"]).stdout);
    let commands = readme.lines().filter_map(|line| {
        let line = line.trim();
        line.strip_prefix("cargo run --release -- ")
    });
    for command in commands {
        let word = command.split_whitespace().next().unwrap_or_default();
        assert!(help.contains(&format!("  {word}")), "README: {command}");
        for file in
            command.split_whitespace().filter(|word| word.starts_with("configs/") && !word.contains('*'))
        {
            assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join(file).is_file(), "README: {file}");
        }
    }
}
