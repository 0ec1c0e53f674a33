//! The record of an align study.

use schuler_frames::phi_between;
use schuler_strapdown::filter::chi_square;

use super::figures;
use super::limit::Limit;
use super::observability::{self, Observed};
use super::place::Place;
use super::run::Trace;
use super::scene::Scene;
use super::statistics::{Sums, Totals};
use crate::Scenario;
use crate::record::{Cell, Record, Table, columns};
use crate::scenario::{AlignStudy, MethodKind};

/// Arc minutes in a radian.
const ARCMIN: f64 = 10_800.0 / std::f64::consts::PI;

/// Columns of the summary, at the end of the alignment and in the unit of the field: root mean square over all runs, the
/// method's own standard deviation of heading, the analytic limit, and the mean NEES a degree of freedom with its 99 % band.
const SUMMARY: [&str; 12] = [
    "method",
    "phi_n_arcmin",
    "phi_e_arcmin",
    "phi_d_arcmin",
    "own_sigma_d_arcmin",
    "limit_n_arcmin",
    "limit_e_arcmin",
    "limit_d_arcmin",
    "bias_limit_d_arcmin",
    "nees",
    "nees_low",
    "nees_high",
];

pub fn record(
    scenario: &Scenario,
    study: &AlignStudy,
    scene: &Scene,
    limit: &Limit,
    first: &[Trace],
    totals: &Totals,
    end: usize,
) -> Record {
    let no_heading = limit.no_heading(scene.time(scene.samples));
    let shown = |errors: [f64; 9]| {
        let mut errors = errors;
        if no_heading.is_some() {
            errors[8] = f64::NAN;
        }
        errors
    };
    let mut record = Record::new(scenario, summary(study, scene, limit, totals, end, &shown));
    record.tables.push(errors(study, scene, limit, first, totals, &shown));
    record.tables.push(consistency(study, scene, totals, end));
    let observed = observe(study, scene);
    record.tables.push(states(&observed, first));
    record.tables.push(finals(study, totals, no_heading.is_some()));
    record.notes = notes(study, scene, totals);
    record.notes.extend(unobserved(&observed));
    record.notes.extend(no_heading.clone());
    if scenario.output.formats.png || scenario.output.formats.svg {
        record.figures = figures::figures(&scenario.title, study, scene, limit, first, totals, end);
    }
    record
}

/// 99 % band of the mean of `dof` squares of standard normals.
fn band(dof: u64) -> [f64; 2] {
    let n = dof as usize;
    [0.995, 0.005].map(|p| if n == 0 { f64::NAN } else { chi_square::quantile(p, n) / n as f64 })
}

fn summary(
    study: &AlignStudy,
    scene: &Scene,
    limit: &Limit,
    totals: &Totals,
    end: usize,
    shown: &dyn Fn([f64; 9]) -> [f64; 9],
) -> Table {
    let mut table = Table::new("summary", &SUMMARY, &["method"]);
    let total = limit.total(scene.time(scene.samples));
    for (method, sums) in study.methods.iter().zip(&totals.sums) {
        let sums = &sums[end];
        let rms = shown(sums.rms());
        let [low, high] = if sums.with_nees > 0 { band(3 * sums.with_nees) } else { [f64::NAN; 2] };
        let mut row: Vec<Cell> = vec![method.name.as_str().into()];
        let angles = [rms[6], rms[7], rms[8], sums.sigma()[2], total[0], total[1], total[2], limit.bias()[2]];
        row.extend(angles.map(|x| Cell::from(x * ARCMIN)));
        row.extend([sums.nees_ratio(), low, high].map(Cell::from));
        table.push(&row);
    }
    table
}

/// Over time and method: the first run, root mean squares, own standard deviations, the limit.
fn errors(
    study: &AlignStudy,
    scene: &Scene,
    limit: &Limit,
    first: &[Trace],
    totals: &Totals,
    shown: &dyn Fn([f64; 9]) -> [f64; 9],
) -> Table {
    let mut table = Table::new("errors", &columns::ERRORS, &["source", "way"]);
    let mut push = |k: u64, source: &str, way: &str, errors: [f64; 9]| {
        let mut row: Vec<Cell> = vec![scene.time(k).into(), source.into(), way.into()];
        row.extend(errors.map(Cell::from));
        table.push(&row);
    };
    let attitude = |phi: [f64; 3]| {
        let mut errors = [f64::NAN; 9];
        errors[6..].copy_from_slice(&phi);
        errors
    };
    for (i, method) in study.methods.iter().enumerate() {
        for (j, &k) in scene.rows.iter().enumerate() {
            let sums: &Sums = &totals.sums[i][j];
            push(k, &method.name, "run", shown(first[i].rows[j].error.as_array()));
            if study.runs > 1 {
                push(k, &method.name, "rms", shown(sums.rms()));
            }
            if k <= scene.samples {
                if matches!(method.kind, MethodKind::Filter(_) | MethodKind::AnyHeading(_)) {
                    push(k, &method.name, "sigma", attitude(sums.sigma()));
                }
                push(k, &method.name, "limit", attitude(limit.total(scene.time(k))));
            }
        }
    }
    table
}

/// Of methods with a covariance: mean NEES a degree of freedom with its band, and the square of the heading error over that of its
/// standard deviation with its own.
fn consistency(study: &AlignStudy, scene: &Scene, totals: &Totals, end: usize) -> Table {
    let mut table = Table::new("consistency", &columns::CONSISTENCY, &["source"]);
    for (method, rows) in study.methods.iter().zip(&totals.sums) {
        for (sums, &k) in rows[..=end].iter().zip(&scene.rows) {
            if sums.with_nees == 0 {
                continue;
            }
            let ([low, high], [least, most]) = (band(3 * sums.with_nees), band(sums.count));
            let heading = (sums.rms()[8] / sums.sigma()[2]).powi(2);
            let numbers = [sums.nees_ratio(), low, high, heading, least, most];
            let mut row: Vec<Cell> = vec![scene.time(k).into(), method.name.as_str().into()];
            row.extend(numbers.map(Cell::from));
            table.push(&row);
        }
    }
    table
}

/// What each filter can observe at all: on a base that does not turn by its start, else by the start and the end.
fn observe(study: &AlignStudy, scene: &Scene) -> Vec<(String, usize, Observed)> {
    let coning = study.mechanization.coning;
    let place = Place { position: scene.position, gravity: scene.gravity, vertical: scene.vertical, coning };
    let attitudes = [scene.c_tb(0), scene.c_tb(scene.samples)];
    let still = phi_between(attitudes[0], attitudes[1]).norm() == 0.0;
    let attitudes = if still { &attitudes[..1] } else { &attitudes[..] };
    study
        .methods
        .iter()
        .enumerate()
        .filter_map(|(i, method)| match &method.kind {
            MethodKind::Filter(settings) => {
                Some((method.name.clone(), i, observability::observed(settings, &place, attitudes)?))
            }
            _ => None,
        })
        .collect()
}

/// States of each filter: standard deviation at the start, at the end, and after endless noise-free measurement.
fn states(observed: &[(String, usize, Observed)], first: &[Trace]) -> Table {
    let names = ["source", "state", "start", "end", "limit"];
    let mut table = Table::new("observability", &names, &["source", "state"]);
    for (name, i, observed) in observed {
        for (k, state) in observed.states.iter().enumerate() {
            let end = first[*i].states.get(k).copied().unwrap_or(f64::NAN);
            let numbers = [state.start, end, state.limit];
            let mut row: Vec<Cell> = vec![name.as_str().into(), state.name.as_str().into()];
            row.extend(numbers.map(Cell::from));
            table.push(&row);
        }
    }
    table
}

/// Rank and unobservable combinations, once for filters that share them.
fn unobserved(observed: &[(String, usize, Observed)]) -> Vec<String> {
    let mut said: Vec<(Vec<&str>, String)> = Vec::new();
    for (name, _, observed) in observed {
        let Observed { rank, of, never, .. } = observed;
        let text = if never.is_empty() {
            format!("observes all of its {of} states")
        } else {
            format!(
                "observes {rank} of {of} combinations of its states (SI units); never: {}",
                never.iter().map(|v| format!("({v})")).collect::<Vec<_>>().join(", ")
            )
        };
        match said.iter_mut().find(|(_, same)| *same == text) {
            Some((names, _)) => names.push(name),
            None => said.push((vec![name], text)),
        }
    }
    said.iter().map(|(names, text)| format!("`{}` {text}", names.join("`, `"))).collect()
}

/// Each run at the end of the alignment.
fn finals(study: &AlignStudy, totals: &Totals, no_heading: bool) -> Table {
    let names = ["run_count", "source", "final_phi_n_rad", "final_phi_e_rad", "final_phi_d_rad"];
    let mut table = Table::new("finals", &names, &["source"]);
    for (method, finals) in study.methods.iter().zip(&totals.finals) {
        for (run, &[n, e, d]) in finals.iter().enumerate() {
            let d = if no_heading { f64::NAN } else { d };
            table.push(&[(run as f64).into(), method.name.as_str().into(), n.into(), e.into(), d.into()]);
        }
    }
    table
}

/// What a reader of the numbers must know.
fn notes(study: &AlignStudy, scene: &Scene, totals: &Totals) -> Vec<String> {
    let mut notes = vec![format!(
        "The limit is that of constant errors in one position, phi_N = nabla_E/g, phi_E = -nabla_N/g, phi_D = eps_E/(Ω cos L) - tan L nabla_E/g, and the laws of noise after {} s, added in variance; a base that is turned has the laws of noise alone",
        scene.time(scene.samples)
    )];
    for (method, (count, why)) in study.methods.iter().zip(&totals.failures) {
        if let Some(why) = why {
            notes
                .push(format!("`{}` gave no attitude in {count} of {} runs: {why}", method.name, study.runs));
        }
    }
    let outside: Vec<String> = study
        .methods
        .iter()
        .zip(&totals.sums)
        .filter_map(|(method, rows)| {
            let sums = rows.get(scene.rows.iter().position(|k| *k == scene.samples)?)?;
            let [low, high] = band(3 * sums.with_nees);
            let ratio = sums.nees_ratio();
            (sums.with_nees > 0 && !(low..=high).contains(&ratio))
                .then(|| format!("`{}` ({ratio:.2}, band {low:.2} to {high:.2})", method.name))
        })
        .collect();
    if !outside.is_empty() {
        notes.push(format!(
            "Not consistent, because their mean NEES a degree of freedom is outside of its 99 % band: {}",
            outside.join(", ")
        ));
    }
    notes
}
