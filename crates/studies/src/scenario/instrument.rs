//! The instrument: a preset, sources, temperature and readout.

use schuler_imu::{Spec, Unit, preset};

use super::{
    de::At,
    document::{Document, Spot},
    quantity::Range,
    sources,
    valid::Imu,
    written,
};
use crate::Diagnostic;

impl Document {
    pub(super) fn imu(&self, imu: &At<written::Imu>) -> Result<Imu, Diagnostic> {
        let w = &imu.value;
        let rate = self.quantity(&w.rate, Unit::HERTZ, Range::Positive)?;
        let mut spec = w.preset.as_ref().map_or(Ok(Spec::new()), |name| self.preset(name))?;
        sources::add(self, &mut spec, &w.gyro, &w.accel)?;
        if let Some(calibration) = &w.calibration_temperature {
            spec.calibration_temperature = self.absolute_temperature(calibration)?;
        }
        spec.readout = w.readout.as_ref().map(|readout| self.readout(&readout.value)).transpose()?;
        let temperature = w.temperature.as_ref().map(|t| self.temperature(&t.value)).transpose()?;
        Ok(Imu { rate, spec, temperature })
    }

    /// The sources of a preset.
    fn preset(&self, name: &At<String>) -> Result<Spec, Diagnostic> {
        let spot = Spot::Node(name.node);
        let preset = preset::preset(&name.value).ok_or_else(|| {
            let known: Vec<&str> = preset::presets().map(|p| p.name).collect();
            let problem = format!("unknown preset `{}`", name.value);
            sources::unknown(self, spot, &problem, &name.value, &known).example("preset: stim300")
        })?;
        preset.spec().map_err(|e| self.diagnostic(spot, e.to_string()))
    }

    /// The drift study compares ways that hold for a linear instrument under one input.
    pub(super) fn linear_and_unchanging(&self, w: &written::Imu) -> Result<(), Diagnostic> {
        if let Some(readout) = &w.readout {
            return Err(self
                .diagnostic(Spot::Node(readout.node), "the drift study has no readout")
                .expected("an instrument that adds its errors and nothing else: rounding and saturation follow no linear theory")
                .help("take it out, or choose `study: imu`"));
        }
        match &w.temperature {
            Some(At { value: written::Temperature::Constant(_), .. }) | None => Ok(()),
            Some(temperature) => Err(self
                .diagnostic(Spot::Node(temperature.node), "the drift study keeps its temperature")
                .expected(
                    "a constant temperature: its closed forms hold for thermal terms that do not change",
                )
                .example("temperature: { constant: 35 degC }")
                .help("choose `study: imu` for a temperature that changes")),
        }
    }
}
