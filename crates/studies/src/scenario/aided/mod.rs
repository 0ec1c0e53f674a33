//! `study: navigate` with a `filter`: from the written to the valid form.

pub mod valid;
pub mod written;

use schuler_imu::{Spec, Unit};
use schuler_strapdown::Coning;
use schuler_strapdown::filter::Form;

use super::{
    alignment::written::Form as WrittenForm,
    de::At,
    document::{Document, Spot},
    quantity::Range,
    recorded::column,
    schema::Title,
    sources,
    valid::{Align, Frame, Mechanization, Start, Vertical},
    written::{Quantity, Scenario},
};
use crate::{
    Diagnostic,
    log::{ColumnRef, Layout, LogSpec},
    record::columns,
};
use valid::{Aided, Condition, ConditionKind, Detect, Measured, MeasuredKind, Reference};

const SPEED: Unit = Unit::METRE.over(Unit::SECOND);

/// Columns of a file and their signs.
type Signed = (Vec<ColumnRef>, Vec<f64>);

/// What navigation has with and without a filter.
pub struct Common {
    pub log: LogSpec,
    pub start: Start,
    pub align: Option<Align>,
    pub mechanization: Mechanization,
    pub duration: Option<f64>,
}

impl Document {
    pub(super) fn aided(
        &self,
        w: &Scenario,
        filter: &At<written::AidedFilter>,
        common: Common,
    ) -> Result<Aided, Diagnostic> {
        let Common { log, start, align, mechanization, duration } = common;
        let node = w.mechanization.as_ref().map_or(filter.node, |m| m.node);
        let unfit = |problem: &str, example: &str| {
            Err(self.diagnostic(Spot::Node(node), problem).expected(example).example(example))
        };
        if mechanization.frame != Frame::T || mechanization.coning != Coning::One {
            return unfit(
                "a filter goes with a navigator in frame `t` that takes each sample as an update",
                "mechanization: { frame: t, vertical: free, gravity: normal }",
            );
        }
        if matches!(mechanization.vertical, Vertical::Damped(_)) {
            return unfit(
                "a filter estimates the vertical channel or leaves it held; it does not go with a damped one",
                "mechanization: { frame: t, vertical: free, gravity: normal }",
            );
        }
        let held = mechanization.vertical == Vertical::Held;
        let f = &filter.value;
        let mut spec = Spec::new();
        sources::add(self, &mut spec, &f.gyro.value, &f.accel.value)?;
        let position = self.each_axis(&f.position, Unit::METRE, Range::NonNegative)?;
        let velocity = self.each_axis(&f.velocity, SPEED, Range::NonNegative)?;
        let tilt = self.quantity(&f.tilt, Unit::RADIAN, Range::Positive)?;
        let heading = self.quantity(&f.heading, Unit::RADIAN, Range::Positive)?;
        let ([pn, pe, pd], [vn, ve, vd]) = (position, velocity);
        let m = &f.measurements.value;
        let mut measured = Vec::new();
        for (kind, list) in [
            (MeasuredKind::Position, &m.position),
            (MeasuredKind::Velocity, &m.velocity),
            (MeasuredKind::Height, &m.height),
            (MeasuredKind::Heading, &m.heading),
        ] {
            if let Some(list) = list {
                if held && kind == MeasuredKind::Height {
                    return Err(self
                        .diagnostic(Spot::Node(list.node), "a height where the vertical channel is held")
                        .expected("`vertical: free`, or no height"));
                }
                measured.push(self.measured(kind, list)?);
            }
        }
        let mut conditions = Vec::new();
        for (kind, condition) in [
            (ConditionKind::ZeroVelocity, &m.zero_velocity),
            (ConditionKind::ZeroRate, &m.zero_rate),
            (ConditionKind::NonHolonomic, &m.non_holonomic),
        ] {
            if let Some(condition) = condition {
                conditions.push(self.condition(kind, condition, log.rate)?);
            }
        }
        if measured.is_empty() && conditions.is_empty() {
            return Err(self
                .diagnostic(Spot::Node(f.measurements.node), "a filter that measures nothing")
                .expected("one of `position`, `velocity`, `height`, `heading`, `zero_velocity`, `zero_rate`, `non_holonomic`")
                .example("measurements: { position: { file: position.csv } }"));
        }
        Ok(Aided {
            log,
            start,
            align,
            mechanization,
            duration,
            spec,
            sigma: [pn, pe, pd, vn, ve, vd, tilt, tilt, heading],
            form: match f.form {
                Some(WrittenForm::Psi) => Form::Psi,
                Some(WrittenForm::Phi) | None => Form::Phi,
            },
            gate: f.gate.as_ref().map(|gate| self.probability(gate)).transpose()?,
            measured,
            conditions,
            reference: f.reference.as_ref().map(|reference| self.reference(reference)).transpose()?,
        })
    }

    fn probability(&self, gate: &Quantity) -> Result<f64, Diagnostic> {
        let p = self.quantity(gate, Unit::ONE, Range::Positive)?;
        if p < 1.0 {
            return Ok(p);
        }
        Err(self
            .diagnostic(Spot::Node(gate.node), "no probability of refusing a good measurement")
            .expected("above 0 and below 1")
            .found(p.to_string())
            .example("gate: 0.1 %"))
    }

    fn measured(&self, kind: MeasuredKind, w: &At<written::Measured>) -> Result<Measured, Diagnostic> {
        let m = &w.value;
        let (names, unit): (&[&str], Unit) = match kind {
            MeasuredKind::Position => (&columns::POSITION_AID, Unit::METRE),
            MeasuredKind::Velocity => (&columns::VELOCITY_AID, SPEED),
            MeasuredKind::Height => (&columns::HEIGHT_AID, Unit::METRE),
            MeasuredKind::Heading => (&columns::HEADING_AID, Unit::RADIAN),
        };
        let (standard, of_sigma) = names.split_at(1 + kind.parts().len());
        let name = |name: &&str| ColumnRef::Name(name.to_string());
        let (mut columns, signs) = self.signed(m.columns.as_ref(), standard)?;
        let mut sigma_columns: Vec<_> = of_sigma.iter().map(name).collect();
        let mut angle = self.angle_count(&m.angle)?;
        let mut layout = Layout::default();
        if let Some(format) = &m.format {
            self.format_alone(&m.columns, &m.angle)?;
            let (what, deviations): (&[usize], &[usize]) = match kind {
                MeasuredKind::Position => (&[1, 2, 3, 4], &[5, 6, 7]),
                MeasuredKind::Height => (&[1, 4], &[7]),
                MeasuredKind::Velocity | MeasuredKind::Heading => {
                    return Err(self
                        .diagnostic(Spot::Node(format.node), format!("this format has no {}", kind.name()))
                        .expected("a position or a height, or `columns`"));
                }
            };
            [columns, sigma_columns] =
                [what, deviations].map(|n| n.iter().map(|n| ColumnRef::Number(*n)).collect());
            (angle, layout) = (1f64.to_radians(), Layout { week: true, fields: Some(7) });
        }
        if let (MeasuredKind::Heading, Some(arm)) = (kind, &m.lever_arm) {
            return Err(self
                .diagnostic(Spot::Node(arm.node), "a heading has no lever arm")
                .help("take it out"));
        }
        let seconds = |q: &Option<Quantity>, range| {
            q.as_ref().map_or(Ok(0.0), |q| self.quantity(q, Unit::SECOND, range))
        };
        Ok(Measured {
            kind,
            file: m.file.value.clone(),
            columns,
            signs,
            layout,
            sigma_columns,
            angle,
            sigma: m.sigma.as_ref().map(|s| self.each_axis(s, unit, Range::Positive)).transpose()?,
            offset: seconds(&m.offset, Range::Any)?,
            every: seconds(&m.every, Range::Positive)?,
            lever_arm: self.arm(&m.lever_arm)?,
            outages: self.intervals(&m.outages)?.unwrap_or_default(),
        })
    }

    fn condition(
        &self,
        kind: ConditionKind,
        w: &At<written::Condition>,
        rate: f64,
    ) -> Result<Condition, Diagnostic> {
        let c = &w.value;
        if let (true, Some(arm)) = (kind != ConditionKind::NonHolonomic, &c.lever_arm) {
            return Err(self
                .diagnostic(Spot::Node(arm.node), format!("`{}` has no lever arm", kind.name()))
                .help("take it out"));
        }
        if let (ConditionKind::NonHolonomic, Some(detect)) = (kind, &c.detect) {
            return Err(self
                .diagnostic(Spot::Node(detect.node), "`non_holonomic` holds at a standstill and on the way")
                .help("take it out, or state `windows`"));
        }
        let unit = if kind == ConditionKind::ZeroRate { Unit::RATE } else { SPEED };
        let every = c.every.as_ref().map_or(Ok(1.0), |q| self.quantity(q, Unit::SECOND, Range::Positive))?;
        let samples = every * rate;
        if samples.round() < 1.0 || (samples - samples.round()).abs() > 1e-6 * samples {
            let node = c.every.as_ref().map_or(w.node, |q| q.node);
            return Err(self
                .diagnostic(Spot::Node(node), "the interval is not a whole number of IMU samples")
                .found(format!("{samples} samples at {rate} Hz"))
                .example("every: 1 s"));
        }
        Ok(Condition {
            kind,
            sigma: self.quantity(&c.sigma, unit, Range::Positive)?,
            stride: samples.round() as u64,
            windows: self.intervals(&c.windows)?,
            detect: c.detect.as_ref().map(|detect| self.detect(detect, rate)).transpose()?,
            lever_arm: self.arm(&c.lever_arm)?,
        })
    }

    fn detect(&self, w: &At<written::Detect>, rate: f64) -> Result<Detect, Diagnostic> {
        let d = &w.value;
        let window = (self.quantity(&d.window, Unit::SECOND, Range::Positive)? * rate).round();
        if !(2.0..=1e6).contains(&window) {
            return Err(self
                .diagnostic(Spot::Node(d.window.node), "no window that shows a standstill")
                .expected("two samples of the IMU at least, and a million at most")
                .found(format!("{window} samples at {rate} Hz"))
                .example("window: 0.5 s"));
        }
        Ok(Detect {
            window: window as usize,
            gyro: self.quantity(&d.gyro, Unit::RATE, Range::Positive)?,
            accel: self.quantity(&d.accel, Unit::FORCE, Range::Positive)?,
            threshold: d
                .threshold
                .as_ref()
                .map_or(Ok(2.0), |q| self.quantity(q, Unit::ONE, Range::Positive))?,
            speed: d.speed.as_ref().map(|q| self.quantity(q, SPEED, Range::Positive)).transpose()?,
        })
    }

    fn reference(&self, w: &At<written::Reference>) -> Result<Reference, Diagnostic> {
        let r = &w.value;
        let (mut columns, signs) = self.signed(r.columns.as_ref(), &columns::TRAJECTORY)?;
        let mut angle = self.angle_count(&r.angle)?;
        let mut layout = Layout::default();
        if r.format.is_some() {
            self.format_alone(&r.columns, &r.angle)?;
            columns = (2..=11).map(ColumnRef::Number).collect();
            (angle, layout) = (1f64.to_radians(), Layout { week: true, fields: Some(11) });
        }
        let offset = r.offset.as_ref().map_or(Ok(0.0), |q| self.quantity(q, Unit::SECOND, Range::Any))?;
        Ok(Reference { file: r.file.value.clone(), columns, signs, layout, angle, offset })
    }

    /// A format says what columns and angles are.
    fn format_alone(
        &self,
        columns: &Option<At<Vec<Title>>>,
        angle: &Option<Quantity>,
    ) -> Result<(), Diagnostic> {
        let said = [("columns", columns.as_ref().map(|x| x.node)), ("angle", angle.as_ref().map(|x| x.node))];
        match said.into_iter().find_map(|(key, node)| Some((key, node?))) {
            None => Ok(()),
            Some((key, node)) => Err(self
                .diagnostic(Spot::Node(node), format!("the format says what `{key}` is"))
                .help("take it out, or `format`")),
        }
    }

    /// Columns as given, or the standard ones; a name may have a sign before it.
    fn signed(&self, given: Option<&At<Vec<Title>>>, standard: &[&str]) -> Result<Signed, Diagnostic> {
        let Some(given) = given else {
            let names = standard.iter().map(|name| ColumnRef::Name(name.to_string())).collect();
            return Ok((names, vec![1.0; standard.len()]));
        };
        if given.value.len() != standard.len() {
            return Err(self
                .diagnostic(Spot::Node(given.node), format!("the list has {} entries", given.value.len()))
                .expected(format!("{} columns, as in {}", standard.len(), standard.join(", ")))
                .example(format!("columns: [{}]", standard.join(", "))));
        }
        let one = |title: &Title| match column(title) {
            ColumnRef::Name(name) => match name.strip_prefix('-') {
                Some(name) => (ColumnRef::Name(name.trim().into()), -1.0),
                None => (ColumnRef::Name(name), 1.0),
            },
            number => (number, 1.0),
        };
        Ok(given.value.iter().map(one).unzip())
    }

    fn angle_count(&self, angle: &Option<Quantity>) -> Result<f64, Diagnostic> {
        angle.as_ref().map_or(Ok(1.0), |angle| self.quantity(angle, Unit::RADIAN, Range::Positive))
    }

    fn arm(&self, arm: &Option<At<[Quantity; 3]>>) -> Result<[f64; 3], Diagnostic> {
        arm.as_ref().map_or(Ok([0.0; 3]), |arm| self.quantities(arm, Unit::METRE))
    }

    fn intervals(
        &self,
        list: &Option<At<Vec<At<[Quantity; 2]>>>>,
    ) -> Result<Option<Vec<[f64; 2]>>, Diagnostic> {
        let Some(list) = list else { return Ok(None) };
        let mut intervals = Vec::new();
        for interval in &list.value {
            let [begin, end] = self.quantities(interval, Unit::SECOND)?;
            if begin >= end {
                return Err(self
                    .diagnostic(Spot::Node(interval.node), "a time that ends before it begins")
                    .expected("begin and end")
                    .example("[100 s, 160 s]"));
            }
            intervals.push([begin, end]);
        }
        Ok(Some(intervals))
    }
}
