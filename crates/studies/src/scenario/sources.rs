//! Error sources from the registries: nothing here knows a term or a process by name.

use schuler_imu::{
    Instrument, PROCESSES, Process, ProcessKind, Source, Spec, TERMS, Term, Unit, Value as Given,
    process::Parameter, process_kind, term,
};

use super::{
    de::one_of,
    document::{Document, NodeId, Spot, Value},
    quantity::Range,
    schema::{Scalar, Sources},
};
use crate::{Diagnostic, similar::similar, units};

/// Adds the sources of both instruments.
pub fn add(document: &Document, spec: &mut Spec, gyro: &Sources, accel: &Sources) -> Result<(), Diagnostic> {
    for (instrument, sources) in [(Instrument::Gyro, gyro), (Instrument::Accel, accel)] {
        for &node in &sources.0 {
            let fault = |e: schuler_imu::Error| document.diagnostic(Spot::Node(node), e.to_string());
            spec.push(source(document, instrument, node)?).map_err(fault)?;
        }
    }
    Ok(())
}

/// `term: { process: { parameter: quantity, … } }`.
fn source(document: &Document, instrument: Instrument, node: NodeId) -> Result<Source, Diagnostic> {
    let (word, key, below) = one_key(document, node, "a term", || example(instrument))?;
    let known: Vec<&str> =
        TERMS.iter().filter(|t| t.instruments().contains(&instrument)).map(|t| t.name()).collect();
    let term = term(word).filter(|t| t.instruments().contains(&instrument)).ok_or_else(|| {
        unknown(document, key, &format!("unknown term `{word}` of the {instrument}"), word, &known)
    })?;
    let process_example =
        || format!("{}: {}", term.name(), process_example(PROCESSES[0], term.unit(instrument)));
    let (word, key, below) = one_key(document, below, "a process", process_example)?;
    let known: Vec<&str> = PROCESSES.iter().map(|p| p.name()).collect();
    let kind = process_kind(word)
        .ok_or_else(|| unknown(document, key, &format!("unknown process `{word}`"), word, &known))?;
    let process = process(document, kind, term, instrument, below)?;
    let fault = |e: schuler_imu::Error| document.diagnostic(Spot::Node(below), e.to_string());
    Source::new(instrument, term, process).map_err(fault)
}

fn process(
    document: &Document,
    kind: &'static dyn ProcessKind,
    term: &'static dyn Term,
    instrument: Instrument,
    node: NodeId,
) -> Result<Process, Diagnostic> {
    let unit = term.unit(instrument);
    let Value::Map(entries) = &document.node(node).value else {
        return Err(document
            .diagnostic(Spot::Node(node), format!("`{}` needs its parameters", kind.name()))
            .expected(parameter_names(kind))
            .example(process_example(kind, unit)));
    };
    let mut given: Vec<(&'static str, Vec<f64>, bool)> = Vec::new();
    for (index, (key, value)) in entries.iter().enumerate() {
        let parameter = find_parameter(kind, &key.name).ok_or_else(|| {
            let known: Vec<&str> = kind.forms().iter().copied().flatten().map(|p| p.name).collect();
            let problem = format!("unknown parameter `{}` of the process `{}`", key.name, kind.name());
            unknown(document, Spot::Key(node, index), &problem, &key.name, &known)
                .example(process_example(kind, unit))
        })?;
        let (values, list) = parameter_values(document, *value, parameter, term, unit)?;
        given.push((parameter.name, values, list));
    }
    let arguments: Vec<(&str, Given)> = given
        .iter()
        .map(|(name, values, list)| (*name, if *list { Given::Each(values) } else { Given::Same(values[0]) }))
        .collect();
    Process::new(kind, &arguments).map_err(|e| {
        let names: Vec<&str> = given.iter().map(|g| g.0).collect();
        // A form that holds all that is given tells what is missing.
        let form = kind.forms().iter().find(|f| names.iter().all(|n| f.iter().any(|p| p.name == *n)));
        let missing = form.and_then(|f| f.iter().find(|p| !names.contains(&p.name)));
        let problem = missing.map_or(e.to_string(), |p| format!("the parameter `{}` is missing", p.name));
        document
            .diagnostic(Spot::Node(node), problem)
            .expected(parameter_names(kind))
            .found(if names.is_empty() { "nothing".into() } else { format!("`{}`", names.join("`, `")) })
            .example(process_example(kind, unit))
    })
}

/// One value for all coefficients, or a list with one each.
fn parameter_values(
    document: &Document,
    node: NodeId,
    parameter: &Parameter,
    term: &dyn Term,
    coefficient: Unit,
) -> Result<(Vec<f64>, bool), Diagnostic> {
    let unit = parameter.unit_for(coefficient);
    let one = |node: NodeId| scalar(document, node, parameter, coefficient);
    match &document.node(node).value {
        Value::List(items) if items.len() == term.len() => {
            Ok((items.iter().map(|&item| one(item)).collect::<Result<_, _>>()?, true))
        }
        Value::List(items) => Err(document
            .diagnostic(Spot::Node(node), format!("the list has {} entries", items.len()))
            .expected(format!(
                "one quantity, or a list of {}, one for each coefficient of `{}`: {}",
                term.len(),
                term.name(),
                term.labels().join(", ")
            ))
            .example(format!("[{}]", vec![units::example(unit); term.len()].join(", ")))),
        _ => Ok((vec![one(node)?], false)),
    }
}

fn scalar(
    document: &Document,
    node: NodeId,
    parameter: &Parameter,
    coefficient: Unit,
) -> Result<f64, Diagnostic> {
    let unit = parameter.unit_for(coefficient);
    let scalar = match &document.node(node).value {
        Value::Whole(value) => Scalar::Bare(*value as f64),
        Value::Number(value) => Scalar::Bare(*value),
        Value::Text(text) => Scalar::Text(text.clone()),
        _ => {
            return Err(document
                .diagnostic(Spot::Node(node), "no quantity")
                .expected(units::describe(unit))
                .example(units::example(unit)));
        }
    };
    document.scalar(
        node,
        &scalar,
        unit,
        |given| parameter.accepts(coefficient, given),
        range(parameter.range),
    )
}

fn range(range: schuler_imu::process::Range) -> Range {
    match range {
        schuler_imu::process::Range::Any => Range::Any,
        schuler_imu::process::Range::NonNegative => Range::NonNegative,
        schuler_imu::process::Range::Positive => Range::Positive,
    }
}

/// Key, its spot and the node below of a map with one key.
fn one_key<'d>(
    document: &'d Document,
    node: NodeId,
    what: &str,
    example: impl FnOnce() -> String,
) -> Result<(&'d str, Spot, NodeId), Diagnostic> {
    match &document.node(node).value {
        Value::Map(entries) if entries.len() == 1 => {
            Ok((&entries[0].0.name, Spot::Key(node, 0), entries[0].1))
        }
        value => {
            let found = match value {
                Value::Map(entries) => format!("a map of {} keys", entries.len()),
                Value::List(_) => "a list".into(),
                Value::Null => "nothing".into(),
                _ => "a scalar".into(),
            };
            let problem = format!("{what} with its settings belongs here");
            Err(document
                .diagnostic(Spot::Node(node), problem)
                .expected("a map of one key")
                .found(found)
                .example(example()))
        }
    }
}

pub(super) fn unknown(
    document: &Document,
    spot: Spot,
    problem: &str,
    word: &str,
    known: &[&str],
) -> Diagnostic {
    let diagnostic = document.diagnostic(spot, problem).expected(one_of(known));
    match similar(word, known.iter().copied()) {
        Some(similar) => diagnostic.help(format!("did you mean `{similar}`?")),
        None => diagnostic,
    }
}

fn find_parameter(kind: &dyn ProcessKind, name: &str) -> Option<&'static Parameter> {
    kind.forms().iter().copied().flatten().find(|p| p.name == name)
}

/// `{ value } or { sigma }`.
pub(super) fn parameter_names(kind: &dyn ProcessKind) -> String {
    let form = |form: &schuler_imu::process::Form| {
        let names: Vec<&str> = form.iter().map(|p| p.name).collect();
        format!("{{ {} }}", names.join(", "))
    };
    kind.forms().iter().map(form).collect::<Vec<_>>().join(" or ")
}

/// `{ constant: { value: 0.01 deg/h } }`, with the unit of a coefficient: taken as it stands (tested).
pub fn process_example(kind: &dyn ProcessKind, unit: Unit) -> String {
    let mut used: Vec<Unit> = Vec::new();
    let mut parameters = Vec::new();
    for parameter in kind.forms()[0] {
        let unit = parameter.unit_for(unit);
        let example = units::example(unit);
        // Of several in one unit each is ten times the one before: a band has a lower and an upper end.
        let before = used.iter().filter(|u| **u == unit).count() as i32;
        let value = match (before, example.split_once(' ')) {
            (1.., Some((number, symbol))) => {
                format!("{} {symbol}", 10f64.powi(before) * number.parse().unwrap_or(1.0))
            }
            _ => example,
        };
        used.push(unit);
        parameters.push(format!("{}: {value}", parameter.name));
    }
    format!("{{ {}: {{ {} }} }}", kind.name(), parameters.join(", "))
}

fn example(instrument: Instrument) -> String {
    format!("- {}: {}", TERMS[0].name(), process_example(PROCESSES[0], TERMS[0].unit(instrument)))
}
