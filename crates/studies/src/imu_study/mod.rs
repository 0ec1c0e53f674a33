//! The measurement study: what the errors of an IMU look like in its samples, beside what theory expects.

mod allan;
mod figures;
mod normal;
mod profile;
mod statistics;
#[cfg(test)]
mod tests;
mod theory;

use schuler_imu::{Imu, Instrument, Sample, Stream, readout::Status};

use crate::{
    Context, Diagnostic, Error, Scenario,
    log::Content,
    record::{Cell, Record, Table, columns},
    scenario::{ImuStudy, Motion},
};
use profile::Profile;
use statistics::Statistics;
use theory::Theory;

/// Samples between two reports of progress.
const REPORT: u64 = 10_000;

/// Rows of `imu.csv`, of fourteen numbers each with `imu_errors.csv`.
const MOST_ROWS: u64 = 20_000_000;

/// Runs the study: every sample goes through the error model, statistics are over all of them, rows and
/// figures keep those of `output.every`.
///
/// # Errors
/// The IMU refuses its list of sources.
pub fn run(scenario: &Scenario, study: &ImuStudy, context: &Context) -> Result<Record, Error> {
    let stride = scenario.output.every.map_or(1, |every| (every * study.imu.rate).round() as u64);
    if study.samples / stride.max(1) > MOST_ROWS {
        let fault = Diagnostic::new(&scenario.file, "more rows than can be kept")
            .path("output.every")
            .expected(format!("at most {MOST_ROWS} rows"))
            .found(format!("{} samples, every {stride} kept", study.samples))
            .example("every: 1 s");
        return Err(fault.into());
    }
    let dt = 1.0 / study.imu.rate;
    let profile = Profile::new(study);
    let mut imu = Imu::new(&study.imu.spec, Stream { seed: scenario.seed, run: 0 })?;
    let mut theory = Theory::new(&study.imu.spec, dt);
    let mut statistics = [[Statistics::default(); 3]; 2];
    let measured_columns = match scenario.output.imu {
        Content::Increments => columns::INCREMENTS,
        Content::Rates => columns::RATES,
    };
    let mut measured = Table::new("imu", &measured_columns, &[]);
    let mut errors = Table::new("imu_errors", &columns::IMU_ERRORS, &[]);
    let mut flags = Table::new("imu_flags", &columns::IMU_FLAGS, &[]);
    let mut kept = allan::Errors::default();
    let mut flagged = [[0u64; 6]; 2];

    let read_out = study.imu.spec.readout.is_some();
    context.progress.begin("samples", study.samples);
    for k in 0..study.samples {
        let truth = profile.truth(k);
        let sample = imu.step(dt, &truth);
        theory.add(&truth);
        for (statistics, error) in statistics.iter_mut().zip([sample.omega_error, sample.f_error]) {
            for (statistics, error) in statistics.iter_mut().zip(error) {
                statistics.add(error);
            }
        }
        if study.allan {
            kept.push([sample.omega_error, sample.f_error]);
        }
        let status = [sample.gyro, sample.accel].map(numbers);
        for (flagged, flag) in flagged.as_flattened_mut().iter_mut().zip(status.as_flattened()) {
            *flagged += u64::from(*flag);
        }
        if (k + 1).is_multiple_of(stride) {
            let t = (k + 1) as f64 / study.imu.rate;
            measured.push(&row(t, measurement(&sample, scenario.output.imu)));
            errors.push(&row(t, [sample.omega_error, sample.f_error]));
            if read_out {
                let cells = status.as_flattened().iter().map(|flag| Cell::Number(f64::from(u8::from(*flag))));
                flags.push(&std::iter::once(t.into()).chain(cells).collect::<Vec<_>>());
            }
        }
        if (k + 1).is_multiple_of(REPORT) {
            context.progress.advance(REPORT);
        }
    }

    let mut record = Record::new(scenario, summary(&statistics, &theory, read_out));
    record.figures = figures::figures(scenario, study, &errors, &theory);
    record.notes.push(match read_out {
        false => "Low and high bound what theory expects with 99 % probability each; of many numbers some lie outside by chance".into(),
        true => "Expected is what theory says of the sum of the sources; the readout comes after it, so nothing is bounded".into(),
    });
    if read_out {
        record.notes.push(counts(&flagged, study.samples));
    }
    if study.motion == Motion::ZeroTruth {
        record.notes.push(
            "The true input is zero, so only biases act: scale factors and misalignments need a motion that excites them".into(),
        );
    }
    record.tables = vec![measured, errors];
    if read_out {
        record.tables.push(flags);
    }
    if study.allan {
        let table =
            allan::Theory::new(&study.imu.spec, &profile.truth(0), dt).table(&kept, study.samples, dt);
        record.figures.extend(allan::figures(&table, &figures::conditions(scenario, study)));
        record.tables.push(table);
    }
    Ok(record)
}

/// Flags of a status in the order of the columns.
fn numbers(status: Status) -> [bool; 6] {
    let [x, y, z] = status.saturated;
    [x, y, z, status.dropped, status.repeated, status.stuck]
}

/// How many samples the readout touched.
fn counts(flagged: &[[u64; 6]; 2], samples: u64) -> String {
    let of = |instrument: Instrument| {
        let [x, y, z, dropped, repeated, stuck] = flagged[instrument as usize];
        format!(
            "{instrument}: saturated {x}, {y}, {z} (x, y, z), dropped {dropped}, repeated {repeated}, stuck {stuck}"
        )
    };
    format!("Samples of {samples} that the readout flagged: {}", Instrument::ALL.map(of).join("; "))
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

/// Mean, standard deviation and extremes of the error per axis beside theory.
/// After a readout nothing is bounded.
fn summary(statistics: &[[Statistics; 3]; 2], theory: &Theory, read_out: bool) -> Table {
    let names = ["axis", "quantity", "found", "expected", "low", "high", "unit", "inside"];
    let mut table = Table::new("summary", &names, &["axis", "quantity", "unit", "inside"]);
    for (i, instrument) in Instrument::ALL.into_iter().enumerate() {
        let unit = instrument.unit().to_string();
        for (j, axis) in ["x", "y", "z"].into_iter().enumerate() {
            let (found, expected) = (&statistics[i][j], theory.expected(i, j));
            let name = format!("{instrument}.{axis}");
            let mut add = |quantity: &str, found: f64, [expected, low, high]: [f64; 3], unit: &str| {
                let [low, high] = if read_out { [f64::NAN; 2] } else { [low, high] };
                let inside = match () {
                    () if low.is_nan() => "-",
                    () if (low..=high).contains(&found) => "yes",
                    () => "no",
                };
                let cells: [Cell; 8] = [
                    name.as_str().into(),
                    quantity.into(),
                    found.into(),
                    expected.into(),
                    low.into(),
                    high.into(),
                    unit.into(),
                    inside.into(),
                ];
                table.push(&cells);
            };
            let none = [f64::NAN; 3];
            add("mean", found.mean(), expected.mean, &unit);
            add("sd", found.deviation(), expected.deviation, &unit);
            add("min", found.min(), none, &unit);
            add("max", found.max(), none, &unit);
            add("largest/sd", found.largest() / expected.deviation[0], expected.largest, "1");
        }
    }
    table
}
