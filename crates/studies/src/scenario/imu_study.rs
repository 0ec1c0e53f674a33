//! `study: imu`: its motion and what is drawn of it.

use schuler_frames::Gravity;

use super::{
    de::At,
    document::{Document, Spot},
    valid::{ImuStudy, Temperature},
    valid_motion::Motion,
    written, written_motion,
};
use crate::Diagnostic;

/// Samples that an Allan picture keeps in memory, six numbers each.
const MAX_ALLAN: u64 = 20_000_000;

impl Document {
    pub(super) fn imu_study(&self, w: &written::Scenario) -> Result<ImuStudy, Diagnostic> {
        let motion = self.required(&w.motion, "motion", "imu", "motion: zero_truth")?;
        let needs_start = !matches!(motion.value, written_motion::Motion::ZeroTruth);
        let start = match &w.start {
            None if needs_start => Some(self.required_start(w, "imu")?),
            start => start.as_ref().map(|s| self.start(s)).transpose()?,
        };
        let imu = self.imu(self.required(&w.imu, "imu", "imu", "imu: { rate: 100 Hz }")?)?;
        let samples = self.samples(w, "imu", imu.rate)?;
        let duration = samples as f64 / imu.rate;
        let written = motion;
        let motion = self.motion(written, start.as_ref(), Some(duration))?;
        if motion.file().is_some() {
            return Err(self
                .diagnostic(Spot::Node(written.node), "the study `imu` reads no trajectory")
                .help("choose another motion, or `study: simulate`"));
        }
        if let Some(start) = &start {
            let trajectory = motion
                .trajectory(start, Gravity::Somigliana, samples, 1.0 / imu.rate)
                .map_err(|fault| self.impossible(written, &fault))?;
            let end = trajectory.and_then(|trajectory| trajectory.duration()).unwrap_or(f64::INFINITY);
            if duration > end * (1.0 + 1e-9) {
                let node = w.duration.as_ref().map_or(written.node, |d| d.node);
                return Err(self
                    .diagnostic(Spot::Node(node), "the motion ends before the duration")
                    .expected(format!("{end:.3} s or less"))
                    .found(format!("{duration} s")));
            }
        }
        let allan = w.output.as_ref().and_then(|output| output.value.allan.as_ref()).filter(|a| a.value);
        if let Some(allan) = allan {
            self.unchanging(allan, &motion, imu.temperature.as_ref(), samples)?;
        }
        Ok(ImuStudy { motion, start, samples, imu, allan: allan.is_some() })
    }

    /// Theory has Allan deviations of errors under an input that stays as it is.
    fn unchanging(
        &self,
        allan: &At<bool>,
        motion: &Motion,
        temperature: Option<&Temperature>,
        samples: u64,
    ) -> Result<(), Diagnostic> {
        let fault = |problem: &str| self.diagnostic(Spot::Node(allan.node), problem);
        if !matches!(motion, Motion::ZeroTruth | Motion::Static) {
            return Err(fault("no Allan deviation of a motion")
                .expected("an instrument that stands still")
                .example("motion: static"));
        }
        if !matches!(temperature, None | Some(Temperature::Constant(_))) {
            return Err(fault("no Allan deviation of a temperature that changes")
                .expected("a constant temperature")
                .example("temperature: { constant: 35 degC }"));
        }
        if samples > MAX_ALLAN {
            return Err(fault("an Allan picture of more than 20 million samples")
                .expected("a shorter duration or a lower rate")
                .found(format!("{samples} samples")));
        }
        Ok(())
    }
}
