//! `allan`: the scenario of an Allan study, written from the arguments.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
};

use schuler_imu::Unit;
use schuler_studies::{
    Diagnostic, Error, Record, Scenario,
    log::titles,
    record::Folder,
    units::{describe, parse_quantity},
};

use crate::{End, args::AllanArgs, report::report, run};

/// What messages call the place where the arguments stand.
const PLACE: &str = "command line";

/// Keys of the scenario, the arguments they come from, and what works. The first whose key fits is taken.
const ARGUMENTS: [(&str, &str, &str); 9] = [
    ("log.file", "LOG", "schuler allan imu.csv --rate '100 Hz'"),
    ("log.rate", "--rate", "--rate '100 Hz'"),
    ("log.content", "--content", "--content increments"),
    ("log.columns.time", "--time", "--time t_s"),
    ("log.columns", "--columns", "--columns gyro=gx,gy,gz accel=ax,ay,az"),
    ("log.scale", "--scale", "--scale gyro='0.1 arcsec' accel='1 mm/s' time='1 ms'"),
    ("log.axes", "--axes", "--axes y,x,-z"),
    ("output.formats", "--formats", "--formats csv,svg"),
    ("output", "--formats", "--formats csv,svg"),
];

/// Columns that say themselves what they are, and what one count of them is where their name says that too.
const KNOWN: [(&str, [&str; 3], Option<&str>); 6] = [
    (GYRO, ["omega_x_radps", "omega_y_radps", "omega_z_radps"], Some("1 rad/s")),
    (GYRO, ["dtheta_x_rad", "dtheta_y_rad", "dtheta_z_rad"], Some("1 rad")),
    (GYRO, ["gx", "gy", "gz"], None),
    (ACCEL, ["f_x_mps2", "f_y_mps2", "f_z_mps2"], Some("1 m/s^2")),
    (ACCEL, ["dv_x_mps", "dv_y_mps", "dv_z_mps"], Some("1 m/s")),
    (ACCEL, ["ax", "ay", "az"], None),
];
const KNOWN_TIME: &str = "t_s";

const GYRO: &str = "gyro";
const ACCEL: &str = "accel";
const TIME: &str = "time";

/// Runs the study, and prints its table, where its files are and its list of error sources.
pub fn allan(args: &AllanArgs) -> io::Result<End> {
    match complete(args) {
        Ok((record, folder)) if !args.quiet => {
            let mut text = format!("{}\nwritten to {}\n", record.summary_text(), folder.path().display());
            for (_, sources) in &record.texts {
                text += &format!("\n{sources}");
            }
            io::stdout().write_all(text.as_bytes())?;
            Ok(End::Success)
        }
        Ok(_) => Ok(End::Success),
        Err(error) => {
            report(&error)?;
            Ok(End::BadInput)
        }
    }
}

fn complete(args: &AllanArgs) -> Result<(Record, Folder), Error> {
    // A log that is there as it was typed needs no folder of logs.
    let data = args.data.as_deref().filter(|_| !Path::new(&args.log).is_file());
    let text = Parts::of(args, data)?.scenario(args)?;
    let scenario = Scenario::load(PLACE, &text, &[]).map_err(of_arguments)?;
    let out = args.out.clone().unwrap_or_else(|| PathBuf::from("out").join(stem(&args.log)));
    let folder = Folder::check(out)?;
    let record = run::one(data, args.quiet, &scenario, &folder).map_err(of_arguments)?;
    Ok((record, folder))
}

/// File name without its endings: `imu` of `logs/imu.csv.gz`.
fn stem(log: &str) -> String {
    let name = Path::new(log).file_name().unwrap_or_default().to_string_lossy().into_owned();
    name.split('.').find(|part| !part.is_empty()).unwrap_or("log").into()
}

/// Columns and counts by the instrument they are of, or `time`.
#[derive(Default)]
struct Parts {
    columns: Vec<(&'static str, Vec<String>)>,
    scale: Vec<(&'static str, Vec<String>)>,
}

impl Parts {
    fn of(args: &AllanArgs, data: Option<&Path>) -> Result<Parts, Error> {
        let mut parts = Parts::default();
        for word in &args.scale {
            parts.add_scale(word)?;
        }
        for word in &args.columns {
            parts.add_columns(word)?;
        }
        if parts.columns.is_empty() {
            parts.known(&args.log, data)?;
        }
        if let Some(time) = &args.time {
            parts.columns.retain(|(key, _)| *key != TIME);
            parts.columns.push((TIME, vec![time.clone()]));
        }
        Ok(parts)
    }

    /// `gyro=0.1 arcsec`, three of them in a list, or quantities alone, whose units say what they are of.
    fn add_scale(&mut self, word: &str) -> Result<(), Diagnostic> {
        let list = |text: &str| text.split(',').map(|q| q.trim().to_string()).collect::<Vec<_>>();
        let Some((key, quantities)) = word.split_once('=') else {
            for quantity in list(word) {
                let key = kind(&quantity)?.0;
                self.set_scale(key, vec![quantity])?;
            }
            return Ok(());
        };
        self.set_scale(known_key("log.scale", key, &[GYRO, ACCEL, TIME])?, list(quantities))
    }

    fn set_scale(&mut self, key: &'static str, quantities: Vec<String>) -> Result<(), Diagnostic> {
        set(&mut self.scale, "log.scale", key, quantities)
    }

    /// `gyro=gx,gy,gz`, or columns alone: six of both instruments, or up to three of the one that has a scale.
    fn add_columns(&mut self, word: &str) -> Result<(), Diagnostic> {
        let list = |text: &str| text.split(',').map(|name| name.trim().to_string()).collect::<Vec<_>>();
        if let Some((key, columns)) = word.split_once('=') {
            let key = known_key("log.columns", key, &[GYRO, ACCEL])?;
            return set(&mut self.columns, "log.columns", key, list(columns));
        }
        let columns = list(word);
        let scaled: Vec<&'static str> =
            self.scale.iter().map(|(key, _)| *key).filter(|key| *key != TIME).collect();
        match (columns.len(), &scaled[..]) {
            (6, _) => {
                set(&mut self.columns, "log.columns", GYRO, columns[..3].to_vec())?;
                set(&mut self.columns, "log.columns", ACCEL, columns[3..].to_vec())
            }
            (1..=3, [only]) => set(&mut self.columns, "log.columns", only, columns),
            (n, _) => Err(fault("log.columns", format!("{n} columns of an instrument that is not named"))
                .expected("`gyro=…` and `accel=…`, the six columns of both, or those of the one that `--scale` names")
                .found(format!("`{word}`"))
                .example(example("log.columns"))),
        }
    }

    /// The columns of the log that say themselves what they are.
    fn known(&mut self, log: &str, data: Option<&Path>) -> Result<(), Error> {
        let beside = Path::new(log).to_path_buf();
        let Some(file) = data.map(|data| data.join(log)).into_iter().chain([beside]).find(|f| f.is_file())
        else {
            // What is not there is named by the study, which knows where it may be.
            self.columns.push((GYRO, KNOWN[2].1.map(String::from).to_vec()));
            return Ok(());
        };
        let titles = titles(&file)?;
        for (key, names, count) in KNOWN {
            let there = |name: &&str| titles.iter().any(|title| title == *name);
            let names: Vec<String> =
                names.iter().take_while(|name| there(name)).map(|n| n.to_string()).collect();
            if !names.is_empty() && !self.columns.iter().any(|(k, _)| *k == key) {
                self.columns.push((key, names));
                if let Some(count) = count.filter(|_| !self.scale.iter().any(|(k, _)| *k == key)) {
                    self.scale.push((key, vec![count.into()]));
                }
            }
        }
        // Who gives the count of one instrument wants that one.
        let scaled = |key: &str| self.scale.iter().any(|(k, _)| *k == key);
        if scaled(GYRO) || scaled(ACCEL) {
            self.columns.retain(|(key, _)| scaled(key));
        }
        if self.columns.is_empty() {
            let names: Vec<&str> = titles.iter().map(String::as_str).filter(|t| !t.is_empty()).collect();
            return Err(fault("log.columns", "which columns are gyros and accelerometers is not known")
                .expected("their names in the header of the log, or their numbers from 1")
                .found(format!("{} columns {}", titles.len(), names.join(",")))
                .example("--columns gyro=2,3,4 accel=5,6,7")
                .into());
        }
        if titles.iter().any(|title| title == KNOWN_TIME) {
            self.columns.push((TIME, vec![KNOWN_TIME.into()]));
        }
        Ok(())
    }

    /// The scenario as YAML.
    fn scenario(&self, args: &AllanArgs) -> Result<String, Diagnostic> {
        let columns = self.columns.iter().map(|(key, names)| match *key {
            TIME => format!("{key}: {}", column(&names[0])),
            _ => format!("{key}: {}", list(names, column)),
        });
        let scale = self.scale.iter().map(|(key, counts)| match &counts[..] {
            // One for all axes is no list.
            [one] => format!("{key}: {}", quoted(one)),
            _ => format!("{key}: {}", list(counts, quoted)),
        });
        let [columns, scale] =
            [columns.collect::<Vec<_>>(), scale.collect()].map(|entries| entries.join(", "));
        let mut text = format!(
            "schuler: 1\nstudy: allan\ntitle: {}\nlog:\n  file: {}\n  rate: {}\n  content: {}\n  columns: {{ {columns} }}\n  scale: {{ {scale} }}\n",
            quoted(&Path::new(&args.log).file_name().unwrap_or_default().to_string_lossy()),
            quoted(&args.log),
            quoted(&args.rate),
            quoted(&self.content(args)?),
        );
        if !args.axes.is_empty() {
            text += &format!("  axes: {}\n", list(&args.axes, quoted));
        }
        if !args.formats.is_empty() {
            text += &format!("output: {{ formats: {} }}\n", list(&args.formats, quoted));
        }
        Ok(text)
    }

    /// As stated, or what the units of the counts say.
    fn content(&self, args: &AllanArgs) -> Result<String, Diagnostic> {
        if let Some(content) = &args.content {
            return Ok(content.clone());
        }
        match self.scale.iter().find(|(key, _)| *key != TIME) {
            Some((_, quantities)) => Ok(kind(&quantities[0])?.1.into()),
            None => Err(fault("log.scale", "what one count of a column is, is not known")
                .expected("an angle (increments) or angular rate (rates) for gyros, a velocity or specific force for accelerometers")
                .example(example("log.scale"))),
        }
    }
}

fn set(
    parts: &mut Vec<(&'static str, Vec<String>)>,
    argument: &str,
    key: &'static str,
    values: Vec<String>,
) -> Result<(), Diagnostic> {
    if parts.iter().any(|(k, _)| *k == key) {
        return Err(fault(argument, format!("two entries for `{key}`")).example(example(argument)));
    }
    parts.push((key, values));
    Ok(())
}

fn known_key(argument: &str, word: &str, keys: &[&'static str]) -> Result<&'static str, Diagnostic> {
    keys.iter().copied().find(|key| *key == word.trim()).ok_or_else(|| {
        fault(argument, format!("`{}` is neither of {}", word.trim(), keys.join(", ")))
            .example(example(argument))
    })
}

/// The instrument and the content of its columns, by the unit of a count.
fn kind(quantity: &str) -> Result<(&'static str, &'static str), Diagnostic> {
    let complain = |problem: String| {
        fault("log.scale", problem)
            .expected("an angle or angular rate for gyros, a velocity or specific force for accelerometers")
            .found(format!("`{quantity}`"))
            .example(example("log.scale"))
    };
    let unit = parse_quantity(quantity).map_err(|error| complain(error.to_string()))?.unit;
    let kinds = [
        (Unit::RATE * Unit::SECOND, GYRO, "increments"),
        (Unit::RATE, GYRO, "rates"),
        (Unit::FORCE * Unit::SECOND, ACCEL, "increments"),
        (Unit::FORCE, ACCEL, "rates"),
    ];
    match kinds.into_iter().find(|(u, ..)| *u == unit) {
        Some((_, instrument, content)) => Ok((instrument, content)),
        None if unit == Unit::ONE => Err(complain("a number without a unit".into())),
        None => Err(complain(format!("wrong dimension: {}", describe(unit)))),
    }
}

fn list(words: &[String], show: fn(&str) -> String) -> String {
    format!("[{}]", words.iter().map(|word| show(word.trim())).collect::<Vec<_>>().join(", "))
}

/// A column by its number, or by its name.
fn column(word: &str) -> String {
    match word.parse::<u64>() {
        Ok(number) => number.to_string(),
        Err(_) => quoted(word),
    }
}

/// As YAML takes any text.
fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', "''"))
}

/// A fault in the argument of a key of the scenario.
fn fault(key: &str, problem: impl Into<String>) -> Diagnostic {
    let name = ARGUMENTS.iter().find(|(k, ..)| *k == key).map_or(key, |(_, name, _)| name);
    Diagnostic::new(PLACE, problem).path(name)
}

fn example(key: &str) -> &'static str {
    ARGUMENTS.iter().find(|(k, ..)| *k == key).map_or("", |(.., example)| example)
}

/// A message about a key of the scenario, as one about the argument behind it.
fn of_arguments(error: Error) -> Error {
    let Error::Input(mut diagnostic) = error else { return error };
    if diagnostic.file == Path::new(PLACE) {
        // The text that it quotes is none that the user wrote.
        diagnostic.excerpt = None;
        diagnostic.place = None;
        if let Some((_, name, example)) = ARGUMENTS.iter().find(|(key, ..)| diagnostic.path.starts_with(key))
        {
            diagnostic.path = (*name).into();
            diagnostic.example = (*example).into();
        }
    }
    Error::Input(diagnostic)
}
