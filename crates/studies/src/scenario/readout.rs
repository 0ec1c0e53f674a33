//! The readout of an instrument. What makes sense is decided by the error model; here it gets a place.

use schuler_imu::{
    Error, Instrument, Readout, Unit,
    readout::{Bandwidth, Channel, Faults, Lsb, Output, Sampling, Timing},
};

use super::{
    de::At,
    document::{Document, NodeId, Spot, Value},
    quantity::Range,
    schema::Scalar,
    written,
};
use crate::Diagnostic;

impl Document {
    pub(super) fn readout(&self, w: &written::Readout) -> Result<Readout, Diagnostic> {
        let channel = |instrument, channel: &Option<At<written::Channel>>| match channel {
            Some(channel) => self.channel(instrument, channel),
            None => Ok(Channel::default()),
        };
        Ok(Readout {
            gyro: channel(Instrument::Gyro, &w.gyro)?,
            accel: channel(Instrument::Accel, &w.accel)?,
        })
    }

    fn channel(&self, instrument: Instrument, written: &At<written::Channel>) -> Result<Channel, Diagnostic> {
        let w = &written.value;
        let output = match w.output.as_ref().map(|o| o.value) {
            Some(written::Content::Rates) => Output::Rates,
            Some(written::Content::Increments) | None => Output::Increments,
        };
        let channel = Channel {
            bandwidth: w.bandwidth.as_ref().map(|b| self.bandwidth(&b.value)).transpose()?,
            sampling: match w.sampling.as_ref().map(|s| s.value) {
                Some(written::Sampling::Point) => Sampling::Point,
                Some(written::Sampling::Mean) | None => Sampling::Mean,
            },
            timing: w.timing.as_ref().map_or(Ok(Timing::default()), |t| self.timing(&t.value))?,
            range: self.range(instrument, w)?,
            lsb: w.lsb.as_ref().map(|lsb| self.lsb(instrument, output, &lsb.value)).transpose()?,
            output,
            faults: w.faults.as_ref().map_or(Ok(Faults::default()), |f| self.faults(&f.value))?,
        };
        let alone = match instrument {
            Instrument::Gyro => Readout { gyro: channel, ..Readout::default() },
            Instrument::Accel => Readout { accel: channel, ..Readout::default() },
        };
        alone.validate().map_err(|error| self.readout_fault(written.node, &error))?;
        Ok(channel)
    }

    fn bandwidth(&self, w: &written::Bandwidth) -> Result<Bandwidth, Diagnostic> {
        Ok(Bandwidth {
            natural_frequency: self.quantity(&w.natural_frequency, Unit::HERTZ, Range::Positive)?,
            damping: self.quantity(&w.damping, Unit::ONE, Range::Positive)?,
        })
    }

    fn timing(&self, w: &written::Timing) -> Result<Timing, Diagnostic> {
        let delay = self.or_zero(&w.delay, Unit::SECOND)?;
        Ok(Timing { delay, jitter: self.or_zero(&w.jitter, Unit::SECOND)? })
    }

    fn range(
        &self,
        instrument: Instrument,
        w: &written::Channel,
    ) -> Result<Option<[(f64, f64); 3]>, Diagnostic> {
        let unit = instrument.unit();
        match (&w.range, &w.range_low) {
            (None, None) => Ok(None),
            (None, Some(low)) => Err(self
                .diagnostic(Spot::Node(low.node), "a lower end of the range without an upper one")
                .expected("`range` beside `range_low`")),
            (Some(high), None) => {
                Ok(Some(self.each_axis(high, unit, Range::Positive)?.map(|high| (-high, high))))
            }
            (Some(high), Some(low)) => {
                let high = self.each_axis(high, unit, Range::Any)?;
                let ends = self.each_axis(low, unit, Range::Any)?;
                if (0..3).any(|i| ends[i] >= high[i]) {
                    return Err(self
                        .diagnostic(Spot::Node(low.node), "the range is empty")
                        .expected("the smallest input, on each axis below `range`"));
                }
                Ok(Some([0, 1, 2].map(|i| (ends[i], high[i]))))
            }
        }
    }

    fn lsb(&self, instrument: Instrument, output: Output, w: &written::Lsb) -> Result<Lsb, Diagnostic> {
        let unit = match output {
            Output::Increments => instrument.unit() * Unit::SECOND,
            Output::Rates => instrument.unit(),
        };
        Ok(Lsb { size: self.each_axis(&w.size, unit, Range::Positive)?, carry: w.carry.unwrap_or(false) })
    }

    fn faults(&self, w: &written::Faults) -> Result<Faults, Diagnostic> {
        Ok(Faults {
            drop: self.or_zero(&w.drop, Unit::ONE)?,
            repeat: self.or_zero(&w.repeat, Unit::ONE)?,
            stick: self.or_zero(&w.stick, Unit::ONE)?,
            stuck_samples: match &w.stuck_samples {
                None => 0,
                Some(count) => u32::try_from(count.value).map_err(|_| {
                    self.diagnostic(Spot::Node(count.node), "more samples than there are")
                        .expected("a count below 4 294 967 296")
                        .example("stuck_samples: 50")
                })?,
            },
        })
    }

    fn or_zero(&self, written: &Option<At<Scalar>>, unit: Unit) -> Result<f64, Diagnostic> {
        written.as_ref().map_or(Ok(0.0), |w| self.quantity(w, unit, Range::NonNegative))
    }

    /// Errors of the model name the number by its keys, `faults.stuck_samples`; where the file does not have the
    /// last of them, the one above is shown.
    fn readout_fault(&self, channel: NodeId, error: &Error) -> Diagnostic {
        let &Error::Readout { name, value, need } = error else {
            return self.diagnostic(Spot::Node(channel), error.to_string());
        };
        let mut node = channel;
        for step in name.split('.') {
            let Value::Map(entries) = &self.node(node).value else { break };
            let Some((_, below)) = entries.iter().find(|(key, _)| key.name == step) else { break };
            node = *below;
        }
        let example = self.example_near(node, None);
        let found = match name {
            "sampling" => "`point` and no `bandwidth`".into(),
            _ => value.to_string(),
        };
        self.diagnostic(Spot::Node(node), format!("the readout's `{name}` makes no sense"))
            .expected(need.strip_prefix("of ").unwrap_or(need))
            .found(found)
            .example(example)
    }
}
