//! Writes `recovery.md`: how well the fit recovers known noise from seeded logs.
//!
//! `cargo run --release -p schuler-allan --example recovery`
use std::fmt::Write as _;

#[path = "../tests/support/cases.rs"]
mod cases;
#[path = "../tests/support/simulate.rs"]
mod simulate;

use cases::{cases as all_cases, false_terms, fits, scores, sun_negative};

const RUNS: usize = 200;

const HEAD: &str = "# Recovery of known noise

Made by `cargo run --release -p schuler-allan --example recovery`: 200 seeded logs of each case, six hours at 10 Hz,
exact Gaussian noise. `bound` is the Cramér-Rao bound of the relative standard deviation, `rms` the relative root mean
square error (a term that was not found counts as 100 %), `coverage` the share of runs whose 95 % interval holds the
truth (from zero on for a term that was not found). A false term is one in the model that is not in the truth. `eq. (3)` is plain least squares on the
same curves (`sun_eq3`): error where the result is real, share of runs where it is imaginary.

| case | term | bound % | rms % | rms / bound | found % | coverage % | eq. (3) rms % | imaginary % |
|---|---|---|---|---|---|---|---|---|
";

fn main() -> std::io::Result<()> {
    let mut table = HEAD.to_owned();
    let mut wrong = String::from(
        "\n| case | runs with a false term % | eq. (3): runs with a negative coefficient % |\n|---|---|---|\n",
    );
    for case in all_cases() {
        let fits = fits(&case, RUNS);
        for s in scores(&case, &fits) {
            let _ = writeln!(
                table,
                "| {} | {} | {:.2} | {:.2} | {:.2} | {:.1} | {:.1} | {:.2} | {:.1} |",
                case.name,
                s.term.name(),
                100.0 * s.bound,
                100.0 * s.rms,
                s.rms / s.bound,
                100.0 * s.found,
                100.0 * s.coverage,
                100.0 * s.sun_rms,
                100.0 * s.sun_imaginary
            );
        }
        let _ = writeln!(
            wrong,
            "| {} | {:.1} | {:.1} |",
            case.name,
            100.0 * false_terms(&case, &fits),
            100.0 * sun_negative(&fits)
        );
        eprintln!("{}", case.name);
    }
    std::fs::write(concat!(env!("CARGO_MANIFEST_DIR"), "/recovery.md"), table + &wrong)
}
