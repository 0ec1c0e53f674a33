//! The record of a navigation with a filter.

use schuler_strapdown::filter::chi_square;

use super::measured::Event;
use super::reference::Known;
use super::{Found, Row};
use super::{consistency, figures};
use crate::Scenario;
use crate::record::{Cell, Record, Table, columns};
use crate::scenario::Aided;

pub fn record(
    scenario: &Scenario,
    aided: &Aided,
    events: &[Event],
    known: Option<&Known>,
    found: &Found,
) -> Record {
    let updates = updates(aided, found);
    let mut record = Record::new(scenario, Table { name: "summary".into(), ..updates.clone() });
    record.tables = vec![trajectory(&found.rows), sigmas(&found.rows), sensors(&found.rows)];
    record.tables.push(updates);
    record.tables.push(innovations(aided, found));
    record.tables.push(states(&found.rows));
    record.notes = notes(aided, found);
    if known.is_some() {
        record.tables.push(errors(&found.rows));
        record.tables.push(nees(&found.rows));
    }
    if scenario.output.formats.png || scenario.output.formats.svg {
        record.figures = figures::figures(&scenario.title, aided, events, found);
    }
    record
}

/// Name of source `number`: logs first, then conditions.
pub fn name(aided: &Aided, number: usize) -> &'static str {
    match aided.measured.get(number) {
        Some(measured) => measured.kind.name(),
        None => aided.conditions[number - aided.measured.len()].kind.name(),
    }
}

/// Names of its components.
pub fn parts(aided: &Aided, number: usize) -> &'static [&'static str] {
    match aided.measured.get(number) {
        Some(measured) => measured.kind.parts(),
        None => aided.conditions[number - aided.measured.len()].kind.parts(),
    }
}

fn trajectory(rows: &[Row]) -> Table {
    let mut table = Table::new("trajectory", &columns::TRAJECTORY, &[]);
    for Row { t, pva, .. } in rows {
        let (p, v, a) = (pva.position, pva.v_t, pva.c_tb.as_euler());
        table.push(&[*t, p.lat, p.lon, p.h, v[0], v[1], v[2], a.roll, a.pitch, a.yaw].map(Cell::from));
    }
    table
}

fn sigmas(rows: &[Row]) -> Table {
    let mut table = Table::new("sigmas", &columns::SIGMAS, &[]);
    for row in rows {
        let cells: Vec<Cell> = [row.t].iter().chain(&row.sigma).map(|x| Cell::from(*x)).collect();
        table.push(&cells);
    }
    table
}

fn sensors(rows: &[Row]) -> Table {
    let mut table = Table::new("sensors", &columns::IMU_ERRORS, &[]);
    for row in rows {
        let cells: Vec<Cell> =
            [row.t].iter().chain(row.sensors.as_flattened()).map(|x| Cell::from(*x)).collect();
        table.push(&cells);
    }
    table
}

fn states(rows: &[Row]) -> Table {
    let mut table = Table::new("states", &columns::STATES, &["source"]);
    for row in rows {
        for (name, estimate, sigma) in &row.states {
            table.push(&[row.t.into(), name.as_str().into(), (*estimate).into(), (*sigma).into()]);
        }
    }
    table
}

/// Of source `number`: scalars offered and refused, and the sum of the normalized innovations squared of what was not
/// refused.
fn counts(found: &Found, number: usize) -> (u64, u64, f64) {
    let (mut offered, mut refused, mut nis) = (0, 0, 0.0);
    for update in found.updates.iter().filter(|update| update.source == number) {
        let len = update.outcome.len as u64;
        offered += len;
        if update.outcome.accepted[0] {
            nis += update.outcome.nis;
        } else {
            refused += len;
        }
    }
    (offered, refused, nis)
}

fn updates(aided: &Aided, found: &Found) -> Table {
    let mut table = Table::new("updates", &columns::UPDATES, &["source"]);
    for number in 0..aided.measured.len() + aided.conditions.len() {
        let (offered, refused, nis) = counts(found, number);
        let taken = offered - refused;
        let [low, high] = band(taken);
        let ratio = nis / taken as f64;
        let mut row: Vec<Cell> = vec![name(aided, number).into()];
        row.extend([offered as f64, refused as f64, ratio, low, high].map(Cell::from));
        table.push(&row);
    }
    table
}

/// 99 % band of the mean of `dof` squares of standard normals. Beyond a hundred by the cube of Wilson and Hilferty (Proc.
/// Natl. Acad. Sci. 17, 1931), whose error there is below 1e-4.
fn band(dof: u64) -> [f64; 2] {
    const FROM: u64 = 100;
    /// Standard normal, 0.5 % above.
    const Z: f64 = 2.575_829_303_548_901;
    let n = dof as f64;
    let cube = |z: f64| (1.0 - 2.0 / (9.0 * n) + z * (2.0 / (9.0 * n)).sqrt()).powi(3);
    match dof {
        0 => [f64::NAN; 2],
        FROM.. => [cube(-Z), cube(Z)],
        _ => [0.995, 0.005].map(|p| chi_square::quantile(p, dof as usize) / n),
    }
}

fn innovations(aided: &Aided, found: &Found) -> Table {
    let mut table = Table::new("innovations", &columns::INNOVATIONS, &["source"]);
    for update in &found.updates {
        let outcome = &update.outcome;
        for (i, part) in parts(aided, update.source).iter().enumerate().take(outcome.len) {
            let (nu, sigma) = (outcome.innovation[i], outcome.s[i][i].sqrt());
            let accepted = if outcome.accepted[i] { 1.0 } else { 0.0 };
            table.push(&[
                update.t.into(),
                (*part).into(),
                nu.into(),
                sigma.into(),
                (nu / sigma).into(),
                outcome.nis.into(),
                accepted.into(),
            ]);
        }
    }
    table
}

fn errors(rows: &[Row]) -> Table {
    let mut table = Table::new("errors", &columns::ERRORS, &["source", "way"]);
    for row in rows {
        let Some((error, _)) = &row.error else { continue };
        for (way, numbers) in [("navigated", error.as_array()), ("sigma", row.sigma)] {
            let mut cells: Vec<Cell> = vec![row.t.into(), "filter".into(), way.into()];
            cells.extend(numbers.map(Cell::from));
            table.push(&cells);
        }
    }
    table
}

fn nees(rows: &[Row]) -> Table {
    let mut table = Table::new("nees", &columns::NEES, &[]);
    for row in rows {
        if let Some((_, Some((nees, dof)))) = row.error {
            table.push(&[row.t.into(), (nees / dof as f64).into()]);
        }
    }
    table
}

fn notes(aided: &Aided, found: &Found) -> Vec<String> {
    let mut notes = Vec::new();
    for number in 0..aided.measured.len() + aided.conditions.len() {
        let (offered, refused, nis) = counts(found, number);
        let taken = offered - refused;
        let [low, high] = band(taken);
        let mut note = format!("{}: {offered} scalar measurements, {refused} refused", name(aided, number));
        if taken > 0 {
            let mean = nis / taken as f64;
            note += &format!(
                "; mean NIS of a scalar {mean:.3}, 99 % band of a consistent filter {low:.3} to {high:.3}"
            );
        }
        notes.push(note);
        notes.extend(consistency::innovations(name(aided, number), offered, refused, nis, high));
    }
    for (condition, (looked, held)) in aided.conditions.iter().zip(&found.looked) {
        if condition.detect.is_some() {
            notes.push(format!("{}: a standstill in {held} of {looked} looks", condition.kind.name()));
        }
    }
    notes.extend(consistency::errors(&found.rows));
    let errors: Vec<_> =
        found.rows.iter().filter_map(|row| row.error.as_ref().map(|(error, _)| error)).collect();
    if !errors.is_empty() {
        let rms = |of: &dyn Fn(&schuler_strapdown::NavError) -> f64| {
            (errors.iter().map(|e| of(e).powi(2)).sum::<f64>() / errors.len() as f64).sqrt()
        };
        notes.push(format!(
            "Against the reference, rms over {} rows: horizontal {:.3} m, vertical {:.3} m; velocity {:.4} m/s; roll and pitch {:.4} deg, heading {:.4} deg",
            errors.len(),
            rms(&|e| e.dr[0].hypot(e.dr[1])),
            rms(&|e| e.dr[2]),
            rms(&|e| e.dv.norm()),
            rms(&|e| e.phi[0].hypot(e.phi[1])).to_degrees(),
            rms(&|e| e.phi[2]).to_degrees(),
        ));
    }
    notes
}
