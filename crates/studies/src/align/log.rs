//! Windows of a recorded log, aligned one by one, and navigation from the first of them on.

use schuler_frames::Vec3;
use schuler_strapdown::{Increments, LocalLevel, Mechanization, NavError, Pva, Samples};

use super::method::{Worker, begin, measure};
use super::place::Place;
use crate::log::{LogReader, LogSpec, find};
use crate::record::{Cell, Record, Table, columns};
use crate::scenario::{AlignStudy, Coarse};
use crate::{Context, Diagnostic, Error, Scenario, channel};

/// Columns of the summary: attitudes over the windows, in degrees, and the spread of the heading.
const SUMMARY: [&str; 6] =
    ["method", "windows", "mean_yaw_deg", "sd_yaw_arcmin", "sd_roll_arcmin", "sd_pitch_arcmin"];

const ARCMIN: f64 = 10_800.0 / std::f64::consts::PI;

/// Aligns each whole window of the log by every method.
pub fn run(
    scenario: &Scenario,
    study: &AlignStudy,
    spec: &LogSpec,
    window: u64,
    context: &Context,
) -> Result<Record, Error> {
    let file = find(spec, context.data.as_deref(), &scenario.file)?;
    let position = study.start.position;
    let vertical = channel::vertical(&study.mechanization, position);
    let coning = study.mechanization.coning;
    let place = Place { position, gravity: study.mechanization.gravity, vertical, coning };
    let dt = 1.0 / spec.rate;
    let stride = scenario.output.every.map_or(1, |every| (every / dt).round().max(1.0) as u64);
    context.progress.begin("log", 1);

    let mut windows = Table::new("windows", &columns::WINDOWS, &["source"]);
    let mut errors = Table::new("errors", &columns::ERRORS, &["source", "way"]);
    let mut found: Vec<Vec<[f64; 3]>> = vec![Vec::new(); study.methods.len()];
    let mut failures: Vec<String> = Vec::new();
    let mut work = Work::new(study, &place, window as f64 * dt);
    let mut navigators: Vec<Option<LocalLevel>> = Vec::new();
    let mut free = Samples::new(coning);
    let mut k = 0u64;
    for sample in LogReader::open(spec, &file)? {
        let increments = sample?.increments;
        if let Some(motion) = free.add(&increments)
            && k >= window
            && k < window + study.navigate
        {
            for navigator in navigators.iter_mut().flatten() {
                navigator.advance(&motion, dt);
            }
        }
        work.advance(study, &place, k % window, &increments, dt);
        k += 1;
        if k.is_multiple_of(window) {
            let t = k as f64 * dt;
            for (i, method) in study.methods.iter().enumerate() {
                match work.workers[i].as_ref().map_err(String::clone).and_then(|w| w.found(&place)) {
                    Ok(attitude) => {
                        let angles = attitude.c_tb.as_euler();
                        let angles = [angles.roll, angles.pitch, angles.yaw];
                        found[i].push(angles);
                        let mut row: Vec<Cell> = vec![t.into(), method.name.as_str().into()];
                        row.extend(angles.map(Cell::from));
                        windows.push(&row);
                        if k == window && study.navigate > 0 {
                            let start = Pva { position, v_t: Vec3::ZERO, c_tb: attitude.c_tb };
                            navigators.resize_with(study.methods.len(), || None);
                            navigators[i] = Some(LocalLevel::new(&start, place.gravity, place.vertical));
                        }
                    }
                    Err(why) => failures.push(format!(
                        "`{}` gave no attitude in the window that ends at {t} s: {why}",
                        method.name
                    )),
                }
            }
            work = Work::new(study, &place, window as f64 * dt);
        }
        let navigated = k.saturating_sub(window);
        if navigated > 0 && navigated <= study.navigate && navigated.is_multiple_of(stride) {
            for (method, navigator) in study.methods.iter().zip(&navigators) {
                let Some(navigator) = navigator else { continue };
                let pva = navigator.pva();
                let truth = Pva { position, v_t: Vec3::ZERO, c_tb: pva.c_tb };
                let mut e = NavError::between(&pva, &truth).as_array();
                e[6..].fill(f64::NAN);
                let mut row: Vec<Cell> =
                    vec![(navigated as f64 * dt).into(), method.name.as_str().into(), "navigated".into()];
                row.extend(e.map(Cell::from));
                errors.push(&row);
            }
        }
    }
    context.progress.advance(1);
    if k < window {
        return Err(Diagnostic::new(&file, "the log ends within the first window")
            .expected(format!("{} s of data or more, because `alignment.window` says so", window as f64 * dt))
            .found(format!("{k} rows, which are {} s at {} Hz", k as f64 * dt, spec.rate))
            .into());
    }
    let mut record = Record::new(scenario, summary(study, &found));
    record.tables.push(windows);
    if !errors.is_empty() {
        record.tables.push(errors);
    }
    record.notes.push(
        "Nobody knows the true attitude of a log: what is shown is how well windows agree with each other, which holds what the base itself did between them".into(),
    );
    record.notes.extend(failures);
    Ok(record)
}

/// All methods over one window.
struct Work {
    workers: Vec<Result<Worker, String>>,
    coarse: Option<(u64, Worker)>,
    samples: Samples,
}

impl Work {
    fn new(study: &AlignStudy, place: &Place, duration: f64) -> Work {
        let coarse = match study.coarse {
            Some(Coarse::Triad(ready)) => Some((ready, Worker::mean())),
            Some(Coarse::Inertial(ready)) => Some((ready, Worker::inertial(ready as f64 / study.rate()))),
            Some(Coarse::Value(_) | Coarse::Sigma(_)) | None => None,
        };
        let workers = study.methods.iter().map(|m| Worker::new(m, place, duration)).collect();
        Work { workers, coarse, samples: Samples::new(study.mechanization.coning) }
    }

    /// Sample `k` of the window.
    fn advance(&mut self, study: &AlignStudy, place: &Place, k: u64, increments: &Increments, dt: f64) {
        let motion = self.samples.add(increments).expect("invariant: one sample an update");
        if let Some((ready, coarse)) = &mut self.coarse {
            if k == *ready {
                let begun = coarse.found(place).map(|found| found.c_tb);
                begin(&mut self.workers, &begun, place);
            }
            if k < *ready {
                coarse.advance(increments, &motion, dt);
            }
        }
        for worker in self.workers.iter_mut().flatten() {
            worker.advance(increments, &motion, dt);
        }
        if (k + 1).is_multiple_of(study.velocity.every) {
            measure(&mut self.workers, [0.0; 2], place);
        }
    }
}

fn summary(study: &AlignStudy, found: &[Vec<[f64; 3]>]) -> Table {
    let mut table = Table::new("summary", &SUMMARY, &["method"]);
    for (method, angles) in study.methods.iter().zip(found) {
        let n = angles.len() as f64;
        // Headings about the first of them, so that none is cut at ±180 deg.
        let about = angles.first().map_or(0.0, |a| a[2]);
        let turn = |x: f64| x - std::f64::consts::TAU * ((x / std::f64::consts::TAU).round());
        let statistics = |axis: usize| {
            let values: Vec<f64> =
                angles.iter().map(|a| if axis == 2 { turn(a[2] - about) } else { a[axis] }).collect();
            let mean = values.iter().sum::<f64>() / n;
            let sd = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
            (mean, sd)
        };
        let (yaw, sd_yaw) = statistics(2);
        table.push(&[
            method.name.as_str().into(),
            n.into(),
            (about + yaw).to_degrees().into(),
            (sd_yaw * ARCMIN).into(),
            (statistics(0).1 * ARCMIN).into(),
            (statistics(1).1 * ARCMIN).into(),
        ]);
    }
    table
}
