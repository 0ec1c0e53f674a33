//! The simulate study: a motion, what a perfect and a real IMU deliver along it, and measurements beside them.

pub(crate) mod aiding;
mod figures;
mod kf_gins;
mod recorded;
#[cfg(test)]
mod tests;
mod track;

use schuler_frames::{Euler, Geodetic};
use schuler_imu::{Imu, Motion, Sample, Stream};
use schuler_strapdown::Pva;

use crate::{
    Context, Diagnostic, Error, Scenario,
    log::Content,
    record::{Cell, Record, Table, columns},
    scenario::Simulate,
    trajectory::{Moment, Truth},
};

/// Samples between two reports of progress.
const REPORT: u64 = 10_000;

/// Rows of `imu.csv` and `imu_ideal.csv`, of seven numbers each.
const MOST_ROWS: u64 = 10_000_000;

/// Runs the study. The record has `truth` (rows of `output.every`), `imu_ideal` and `imu` (every sample, in the form of
/// `output.imu`), one table for each kind of aiding, and the track as KML and GeoJSON. All of it is in the form
/// that `navigate` reads.
///
/// # Errors
/// More samples than can be kept; the IMU refuses its list of sources.
pub fn run(scenario: &Scenario, study: &Simulate, context: &Context) -> Result<Record, Error> {
    if study.samples > MOST_ROWS {
        return Err(Diagnostic::new(&scenario.file, "more samples than can be kept")
            .path("duration")
            .expected(format!("at most {MOST_ROWS} samples: a shorter duration or a lower rate"))
            .found(format!("{} samples", study.samples))
            .into());
    }
    let rate = study.imu.rate;
    let dt = 1.0 / rate;
    let duration = study.samples as f64 / rate;
    let (trajectory, residual) = recorded::trajectory(scenario, study, &study.motion, context)?;
    let truth = Truth::boxed(trajectory, study.gravity);
    let mut imu = Imu::new(&study.imu.spec, Stream { seed: scenario.seed, run: 0 })?;
    let content = scenario.output.imu;
    let names = match content {
        Content::Increments => columns::INCREMENTS,
        Content::Rates => columns::RATES,
    };
    let mut ideal = Table::new("imu_ideal", &names, &[]);
    let mut measured = Table::new("imu", &names, &[]);
    let mut states = Table::new("truth", &columns::TRUTH, &[]);
    let mut aids = aiding::Aids::new(&study.aiding, scenario.seed);
    let stride = scenario.output.every.map_or(1, |every| (every * rate).round() as u64).max(1);
    states.push(&state(0.0, &truth.moment(0.0)));

    context.progress.begin("samples", study.samples);
    for k in 0..study.samples {
        let (begin, end) = (k as f64 / rate, (k + 1) as f64 / rate);
        let motion = truth.imu_truth(begin, dt);
        let motion = match &study.imu.temperature {
            None => motion,
            Some(temperature) => motion.at_temperature(&temperature.profile(), begin, dt),
        };
        let sample = imu.step(dt, &motion);
        ideal.push(&row(end, exact(&motion.motion, content, dt)));
        measured.push(&row(end, measurement(&sample, content)));
        let last = k + 1 == study.samples;
        let kept = (k + 1).is_multiple_of(stride) || last;
        if kept || aids.due(k + 1) {
            let moment = truth.moment(end);
            if kept {
                states.push(&state(end, &moment));
            }
            aids.measure(k + 1, end, &moment, duration, |t| truth.moment(t));
        }
        if (k + 1).is_multiple_of(REPORT) {
            context.progress.advance(REPORT);
        }
    }

    let mut record = Record::new(scenario, summary(&states));
    record.figures = figures::figures(scenario, study, &states);
    record.texts = track::texts(&scenario.title, &states);
    record.tables = vec![states, ideal, measured];
    record.tables.extend(aids.tables());
    if scenario.output.kf_gins {
        record.texts.extend(kf_gins::texts(&record.tables, dt));
        record.notes.push(
            "imu.txt, gnss.txt and truth.nav are in the text formats of KF-GINS; the GNSS week is 0, the second the time".into(),
        );
    }
    record.notes.push(format!(
        "imu_ideal.csv and imu.csv hold {} over the interval that ends at t_s",
        match content {
            Content::Increments => "integrals",
            Content::Rates => "means",
        }
    ));
    record.notes.extend(residual.as_ref().map(recorded::note));
    Ok(record)
}

/// The true motion as a row of a log.
fn exact(motion: &Motion, content: Content, dt: f64) -> [[f64; 3]; 2] {
    match (*motion, content) {
        (Motion::Increments { dtheta, dv }, Content::Increments) => [dtheta, dv],
        (Motion::Rates { omega, f }, Content::Rates) => [omega, f],
        (Motion::Increments { dtheta, dv }, Content::Rates) => [dtheta, dv].map(|x| x.map(|x| x / dt)),
        (Motion::Rates { omega, f }, Content::Increments) => [omega, f].map(|x| x.map(|x| x * dt)),
    }
}

fn measurement(sample: &Sample, content: Content) -> [[f64; 3]; 2] {
    match content {
        Content::Increments => [sample.dtheta, sample.dv],
        Content::Rates => [sample.omega(), sample.f()],
    }
}

fn row(t: f64, [gyro, accel]: [[f64; 3]; 2]) -> [Cell<'static>; 7] {
    [t, gyro[0], gyro[1], gyro[2], accel[0], accel[1], accel[2]].map(Cell::Number)
}

fn state(t: f64, moment: &Moment) -> [Cell<'static>; 16] {
    let Pva { position, v_t, c_tb } = moment.pva;
    let attitude = c_tb.as_euler();
    let ([n, e, d], [x, y, z]) = (v_t.as_array(), moment.omega_ib_b.as_vec3().as_array());
    let [f_x, f_y, f_z] = moment.f_b.as_array();
    let Euler { roll, pitch, yaw } = attitude;
    let Geodetic { lat, lon, h } = position;
    [t, lat, lon, h, n, e, d, roll, pitch, yaw, x, y, z, f_x, f_y, f_z].map(Cell::Number)
}

/// The ends of the motion, and the largest of what an instrument must stand.
fn summary(states: &Table) -> Table {
    let mut table = Table::new("summary", &["quantity", "start", "end", "largest"], &["quantity"]);
    for column in &states.columns[1..] {
        let values = states.numbers(column.name()).unwrap_or_default();
        let largest = values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let [first, last] = [values.first(), values.last()].map(|x| x.copied().unwrap_or(f64::NAN));
        table.push(&[column.name().into(), first.into(), last.into(), largest.into()]);
    }
    table
}
