//! The tables of `schuler sources`, from the registries.

use schuler_imu::{Instrument, PROCESSES, TERMS};
use schuler_studies::scenario::process_example;

/// Markdown tables of terms and processes.
pub fn sources() -> String {
    let mut text = String::from(
        "An error source is a term whose coefficients follow a process:\n\n    \
         - bias: { white: { density: 0.003 deg/sqrt(h) } }\n\n\
         | term | instruments | coefficients | unit | meaning | formula |\n|---|---|---|---|---|---|\n",
    );
    for term in TERMS {
        let instruments: Vec<&str> = term.instruments().iter().map(|i| i.name()).collect();
        let units: Vec<String> = term.instruments().iter().map(|i| term.unit(*i).to_string()).collect();
        let same = units.iter().all(|u| *u == units[0]);
        let unit = if same { units[0].clone() } else { units.join(", ") };
        text += &format!(
            "| {} | {} | {} | {unit} | {} | {} |\n",
            term.name(),
            instruments.join(", "),
            term.labels().join(" "),
            cell(term.doc()),
            cell(term.formula()),
        );
    }
    text +=
        "\n| process | parameters | example on a gyro bias | meaning | formula |\n|---|---|---|---|---|\n";
    for process in PROCESSES {
        let forms: Vec<String> =
            process.forms().iter().map(|f| f.iter().map(|p| p.name).collect::<Vec<_>>().join(", ")).collect();
        text += &format!(
            "| {} | {} | `{}` | {} | {} |\n",
            process.name(),
            forms.join(" or "),
            process_example(*process, Instrument::Gyro.unit()),
            cell(process.doc()),
            cell(process.formula()),
        );
    }
    text
}

/// Text for a cell: a bar would end it.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}
