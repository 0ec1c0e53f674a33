//! The tables of error sources and presets are complete and current.

use std::{fs, path::Path, process::Command};

use schuler::imu::preset::presets;

fn print(arguments: &[&str]) -> String {
    let output =
        Command::new(assert_cmd::cargo::cargo_bin!("schuler")).args(arguments).output().expect("it starts");
    assert!(output.status.success(), "{arguments:?}");
    String::from_utf8(output.stdout).expect("text")
}

/// Written anew by `schuler sources --markdown > crates/imu/sources.md`.
#[test]
fn the_committed_page_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/imu/sources.md");
    let committed = fs::read_to_string(path).expect("crates/imu/sources.md");
    assert!(
        committed == print(&["sources", "--markdown"]),
        "write it anew: cargo run -- sources --markdown > crates/imu/sources.md"
    );
}

/// Every preset with its source and its remark, and every figure as printed.
#[test]
fn presets_are_shown_whole() {
    let table = print(&["presets"]);
    for preset in presets() {
        for text in [preset.name, preset.device, preset.source, preset.note] {
            assert!(table.contains(&text.replace('|', "\\|")), "{}: {text}", preset.name);
        }
        for figure in preset.figures {
            let start = format!("| {} | {} | {} |", preset.name, figure.instrument, figure.printed);
            assert!(table.contains(&start), "{start}");
        }
    }
}

/// The gyro noise of the STIM300 by hand: 0.15 deg/sqrt(h) = 0.15 (pi/180)/60 rad/sqrt(s).
#[test]
fn a_figure_in_si() {
    let row = "| stim300 | gyro | 0.15 deg/sqrt(h) | 4.363323e-5 rad/sqrt(s) | bias: white |";
    assert!(print(&["presets"]).contains(row));
}
