//! The tables of `schuler sources` and `schuler presets`, from the registries.

use schuler_imu::{
    Instrument, PROCESSES, TERMS,
    preset::{BAND, Figure, Kind, presets as all_presets},
};
use schuler_studies::scenario::process_example;

/// Markdown tables of terms and processes.
pub fn sources() -> String {
    let mut text = String::from(
        "An error source is a term whose coefficients follow a process:\n\n    \
         - bias: { white: { density: 0.003 deg/sqrt(h) } }\n\n\
         | term | instruments | coefficients | unit | meaning | formula | source |\n|---|---|---|---|---|---|---|\n",
    );
    for term in TERMS {
        let instruments: Vec<&str> = term.instruments().iter().map(|i| i.name()).collect();
        let units: Vec<String> = term.instruments().iter().map(|i| term.unit(*i).to_string()).collect();
        let same = units.iter().all(|u| *u == units[0]);
        let unit = if same { units[0].clone() } else { units.join(", ") };
        text += &format!(
            "| {} | {} | {} | {unit} | {} | {} | {} |\n",
            term.name(),
            instruments.join(", "),
            term.labels().join(" "),
            cell(term.doc()),
            cell(term.formula()),
            cell(term.source()),
        );
    }
    text += "\n| process | parameters | example on a gyro bias | meaning | formula | source |\n|---|---|---|---|---|---|\n";
    for process in PROCESSES {
        let forms: Vec<String> =
            process.forms().iter().map(|f| f.iter().map(|p| p.name).collect::<Vec<_>>().join(", ")).collect();
        text += &format!(
            "| {} | {} | `{}` | {} | {} | {} |\n",
            process.name(),
            forms.join(" or "),
            process_example(*process, Instrument::Gyro.unit()),
            cell(process.doc()),
            cell(process.formula()),
            cell(process.source()),
        );
    }
    text
}

/// Markdown tables of devices and grades, and of their figures.
pub fn presets() -> String {
    let mut text = format!(
        "`imu: {{ preset: NAME }}` in a scenario stands for the error sources below.\n\
         Figures printed as ± or as a maximum count as one standard deviation; a bias instability is the lowest\n\
         point of the Allan deviation, 0.6643 B, flat from {} s to {} s.\n\n\
         | preset | device | figures | seen in | disagreements, and what is left open |\n|---|---|---|---|---|\n",
        BAND[0], BAND[1]
    );
    for preset in all_presets() {
        text += &format!(
            "| {} | {} | {} | {} | {} |\n",
            preset.name,
            cell(preset.device),
            kind(preset.kind),
            cell(preset.source),
            cell(preset.note)
        );
    }
    text += "\n| preset | instrument | as printed | SI | becomes |\n|---|---|---|---|---|\n";
    for preset in all_presets() {
        for figure in preset.figures {
            text += &format!(
                "| {} | {} | {} | {:.6e} {} | {} |\n",
                preset.name,
                figure.instrument,
                cell(figure.printed),
                figure.si(),
                figure.dimension(),
                becomes(figure)
            );
        }
    }
    text
}

fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Sheet => "of the maker",
        Kind::ThirdParty => "of a third party",
        Kind::Program => "of a program, no data sheet",
        Kind::Grade => "of a grade",
    }
}

/// The source that a figure becomes, or why it becomes none.
fn becomes(figure: &Figure) -> String {
    use schuler_imu::preset::Role;
    match (figure.role, figure.as_source()) {
        (Role::Shown(why), _) => format!("none: {}", cell(why)),
        (_, Ok(Some(source))) => {
            let names: Vec<String> = source.name().to_string().split('.').skip(1).map(String::from).collect();
            names.join(": ")
        }
        (_, Ok(None)) => "none".into(),
        (_, Err(error)) => error.to_string(),
    }
}

/// The page of the documentation: terms, processes, presets.
pub fn page() -> String {
    format!(
        "# Error sources\n\n\
         Written by `schuler sources --markdown` from the definitions; a test holds it equal to them. Units are SI\n\
         with angles in radians, axes are those of the sensor, an error is measured minus true.\n\n\
         ## Terms and processes\n\n{}\n## Presets\n\n{}",
        sources(),
        presets()
    )
}

/// Text for a cell: a bar would end it.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}
