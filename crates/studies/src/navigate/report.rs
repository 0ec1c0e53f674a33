//! The record of a navigate study.

use schuler_frames::wgs84;
use schuler_strapdown::{NavError, Pva};

use super::figures;
use super::pass::{Mean, Outcome, Pass, Plan};
use crate::Scenario;
use crate::record::{Record, Table, columns};
use crate::scenario::Navigate;

/// Columns of the summary: attitude found, and how far it went from the start.
const SUMMARY: [&str; 9] =
    ["part", "t_s", "roll_rad", "pitch_rad", "yaw_rad", "dn_m", "de_m", "dd_m", "speed_mps"];

/// deg/h per rad/s.
const DEG_PER_H: f64 = 648_000.0 / std::f64::consts::PI;

/// Relative difference between the mean rate and the Earth rate from which on averaging is not to be trusted.
const RATE_TOLERANCE: f64 = 0.01;

pub fn record(
    scenario: &Scenario,
    navigate: &Navigate,
    plan: &Plan,
    pass: &Pass,
    outcome: &Outcome,
) -> Record {
    let start = Pva { position: plan.position, ..outcome.rows[0].1 };
    // Against the known point, zero velocity and the attitude that alignment gave.
    let apart: Vec<(f64, NavError)> =
        outcome.rows.iter().map(|(t, pva)| (*t, NavError::between(pva, &start))).collect();
    let mut record = Record::new(scenario, summary(outcome, &apart));
    record.tables.push(trajectory(&outcome.rows));
    record.tables.push(log(plan, pass));
    if navigate.log.stationary {
        record.tables.push(errors(&apart));
    }
    record.notes = notes(navigate, plan, pass, outcome);
    if scenario.output.formats.png || scenario.output.formats.svg {
        record.figures = figures::figures(&scenario.title, navigate, plan, &outcome.rows, &apart);
    }
    record
}

fn summary(outcome: &Outcome, apart: &[(f64, NavError)]) -> Table {
    let mut table = Table::new("summary", &SUMMARY, &["part"]);
    let ends = [("aligned", outcome.rows.first(), apart.first()), ("end", outcome.rows.last(), apart.last())];
    for (part, row, error) in ends {
        let (Some((t, pva)), Some((_, e))) = (row, error) else { continue };
        let angles = pva.c_tb.as_euler();
        table.push(&[
            part.into(),
            (*t).into(),
            angles.roll.into(),
            angles.pitch.into(),
            angles.yaw.into(),
            e.dr[0].into(),
            e.dr[1].into(),
            e.dr[2].into(),
            pva.v_t.norm().into(),
        ]);
    }
    table
}

fn trajectory(rows: &[(f64, Pva)]) -> Table {
    let mut table = Table::new("trajectory", &columns::TRAJECTORY, &[]);
    for (t, pva) in rows {
        let (p, v, a) = (pva.position, pva.v_t, pva.c_tb.as_euler());
        let row = [*t, p.lat, p.lon, p.h, v[0], v[1], v[2], a.roll, a.pitch, a.yaw];
        table.push(&row.map(Into::into));
    }
    table
}

/// What the log says by itself: the whole of it and the window.
fn log(plan: &Plan, pass: &Pass) -> Table {
    let mut table = Table::new("log", &columns::LOG, &["source"]);
    let [begin, _] = plan.window;
    for (part, first, mean) in [("log", 0, &pass.whole), ("window", begin, &pass.window)] {
        let (omega, f) = (mean.omega_b(plan.dt), mean.f_b(plan.dt));
        table.push(&[
            ((first + mean.count) as f64 * plan.dt).into(),
            part.into(),
            (mean.count as f64).into(),
            omega.norm().into(),
            f.norm().into(),
            omega[0].into(),
            omega[1].into(),
            omega[2].into(),
            f[0].into(),
            f[1].into(),
            f[2].into(),
        ]);
    }
    table
}

fn errors(apart: &[(f64, NavError)]) -> Table {
    let mut table = Table::new("errors", &columns::ERRORS, &["source", "way"]);
    for (t, e) in apart {
        let mut row = vec![(*t).into(), "all".into(), "nonlinear".into()];
        row.extend(e.as_array().map(crate::record::Cell::from));
        table.push(&row);
    }
    table
}

fn notes(navigate: &Navigate, plan: &Plan, pass: &Pass, outcome: &Outcome) -> Vec<String> {
    let Mean { count, .. } = pass.window;
    let angles = outcome.c_tb.as_euler();
    let [roll, pitch, yaw] = [angles.roll, angles.pitch, angles.yaw].map(f64::to_degrees);
    let (omega, f) = (pass.window.omega_b(plan.dt).norm(), pass.window.f_b(plan.dt).norm());
    let g = plan.gravity.gravity_t(plan.position).norm();
    let [begin, end] = navigate.align.window;
    let mut notes = vec![
        format!(
            "TRIAD, specific force first, over {begin} s to {end} s ({count} samples): roll {roll:.4} deg, pitch {pitch:.4} deg, heading {:.4} deg",
            yaw.rem_euclid(360.0)
        ),
        format!(
            "Mean specific force {f:.6} m/s² against gravity {g:.6} m/s²; mean rate {:.4} deg/h against the Earth's {:.4} deg/h",
            omega * DEG_PER_H,
            wgs84::OMEGA * DEG_PER_H
        ),
    ];
    if (omega / wgs84::OMEGA - 1.0).abs() > RATE_TOLERANCE {
        notes.push(format!(
            "The mean rate differs from the Earth rate by {:.1} %: the vehicle turned within the window or the gyros are biased, and the heading is wrong by degrees",
            100.0 * (omega / wgs84::OMEGA - 1.0)
        ));
    }
    if navigate.log.stationary {
        notes.push("Position and velocity errors are against the known point at rest; phi is the change since alignment, because the true attitude is not known".into());
    }
    notes
}
