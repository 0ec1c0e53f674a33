//! Measurements from files, in the order of time.

use schuler_frames::{Geodetic, Vec3};
use schuler_strapdown::filter::measurement::{ALL, HORIZONTAL};
use schuler_strapdown::filter::{
    Heading, Height, Measurement, NonHolonomic, Position, Velocity, ZeroRate, ZeroVelocity,
};

use crate::log::{self, ColumnRef};
use crate::scenario::{Condition, ConditionKind, Measured, MeasuredKind};
use crate::{Context, Diagnostic, Error, Scenario};

/// A measurement and its time.
pub struct Event {
    /// Time of the IMU log, s.
    pub t: f64,
    /// Number of the log it is from.
    pub source: usize,
    pub taken: Taken,
}

/// What was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Taken {
    Position(Position),
    Velocity(Velocity),
    Height(Height),
    Heading(Heading),
}

impl Taken {
    pub fn measurement(&self) -> &dyn Measurement {
        match self {
            Taken::Position(m) => m,
            Taken::Velocity(m) => m,
            Taken::Height(m) => m,
            Taken::Heading(m) => m,
        }
    }
}

/// When a log of measurements begins and ends, in the time of the IMU log, and its name.
pub struct Span {
    pub file: String,
    pub times: [f64; 2],
}

/// Everything that is in the files: the measurements in the order of time, outages left out, and how long each log is.
pub fn read(
    scenario: &Scenario,
    measured: &[Measured],
    held: bool,
    context: &Context,
) -> Result<(Vec<Event>, Vec<Span>), Error> {
    let (mut events, mut spans) = (Vec::new(), Vec::new());
    for (source, m) in measured.iter().enumerate() {
        let key = format!("filter.measurements.{}.file", m.kind.name());
        let file = log::find_named(&m.file, &key, "", context.data.as_deref(), &scenario.file)?;
        let rows = log::rows(&file, &with_sigma(m), m.layout)?;
        let time = |row: &log::Row| m.signs[0] * row[0] + m.offset;
        let mut last = f64::NEG_INFINITY;
        for (k, row) in rows.iter().enumerate() {
            let t = time(row);
            let out = m.outages.iter().any(|[begin, end]| (*begin..*end).contains(&t));
            if out || t - last < m.every * (1.0 - 1e-6) {
                continue;
            }
            last = t;
            let taken = taken(m, row, held).map_err(|(problem, expected)| {
                Diagnostic::new(&file, format!("{problem}, in row {} of the data", k + 1)).expected(expected)
            })?;
            events.push(Event { t, source, taken });
        }
        let ends = [rows.first(), rows.last()].map(|row| row.map_or(f64::NAN, time));
        spans.push(Span { file: file.display().to_string(), times: ends });
    }
    events.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.source.cmp(&b.source)));
    Ok((events, spans))
}

/// The columns that are read: where the scenario states no standard deviation, also those of it.
fn with_sigma(m: &Measured) -> Vec<ColumnRef> {
    let deviations = m.sigma_columns.iter().filter(|_| m.sigma.is_none());
    m.columns.iter().chain(deviations).cloned().collect()
}

/// A row as a measurement; else what is wrong with it and what was expected.
fn taken(m: &Measured, row: &log::Row, held: bool) -> Result<Taken, (&'static str, &'static str)> {
    let value = |k: usize| m.signs[k] * row[k];
    let first = m.columns.len();
    let [a, b, c] = m.sigma.unwrap_or([row[first], row[(first + 1) % 7], row[(first + 2) % 7]]);
    let (lever, axes) = (Vec3::claim(m.lever_arm), if held { HORIZONTAL } else { ALL });
    let (all, one) = (a > 0.0 && b > 0.0 && c > 0.0, a > 0.0);
    let positive = |holds: bool| match holds {
        true => Ok(()),
        false => Err((
            "a standard deviation that is not positive",
            "more than zero: state `sigma` in the scenario",
        )),
    };
    Ok(match m.kind {
        MeasuredKind::Position => {
            positive(all)?;
            let position = Geodetic::new(m.angle * value(1), m.angle * value(2), value(3));
            if position.lat.abs() > std::f64::consts::FRAC_PI_2 {
                return Err((
                    "a latitude beyond 90 deg",
                    "angles in rad; `angle: 1 deg` where they are in degrees",
                ));
            }
            Taken::Position(Position { position, sigma: [a, b, c], lever, axes })
        }
        MeasuredKind::Velocity => {
            positive(all)?;
            let v_t = Vec3::new(value(1), value(2), value(3));
            Taken::Velocity(Velocity { v_t, sigma: [a, b, c], lever, axes })
        }
        MeasuredKind::Height => {
            positive(one)?;
            Taken::Height(Height { h: value(1), sigma: a, lever })
        }
        MeasuredKind::Heading => {
            positive(one)?;
            // A standard deviation that the scenario states has its unit there.
            let sigma = if m.sigma.is_some() { a } else { m.angle * a };
            Taken::Heading(Heading { yaw: m.angle * value(1), sigma })
        }
    })
}

/// What is known of the vehicle without an instrument, as a measurement.
pub fn known(condition: &Condition, held: bool) -> Box<dyn Measurement> {
    let (sigma, axes) = (condition.sigma, if held { HORIZONTAL } else { ALL });
    match condition.kind {
        ConditionKind::ZeroVelocity => Box::new(ZeroVelocity { sigma, axes }),
        ConditionKind::ZeroRate => Box::new(ZeroRate::new(sigma)),
        ConditionKind::NonHolonomic => {
            Box::new(NonHolonomic { sigma: [sigma; 2], lever: Vec3::claim(condition.lever_arm) })
        }
    }
}
