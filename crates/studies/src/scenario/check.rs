//! From the written to the valid form.

use schuler_frames::Gravity;
use schuler_imu::Unit;
use schuler_strapdown::Coning;

use super::{
    aided::Common,
    de::At,
    document::{Document, NodeId, Spot},
    quantity::Range,
    recorded::content,
    valid::{
        Align, Damping, Drift, Formats, Frame, Mechanization, Navigate, Output, Scenario, Start, Study,
        Vertical,
    },
    written::{self, StudyKind},
    written_motion::Motion,
};
use crate::{Diagnostic, log::Content};

/// A year at 300 Hz: a typing error beyond it. What is kept in memory is the rows, which each study limits.
const MAX_SAMPLES: f64 = 1e10;

impl Document {
    pub(super) fn scenario(&self, w: &written::Scenario) -> Result<Scenario, Diagnostic> {
        if w.schuler.value != 1 {
            return Err(self
                .diagnostic(Spot::Node(w.schuler.node), format!("unknown format version {}", w.schuler.value))
                .expected("1")
                .example("schuler: 1"));
        }
        self.only_used_keys(w)?;
        let study = match w.study.value {
            StudyKind::Imu => Study::Imu(self.imu_study(w)?),
            StudyKind::Drift => Study::Drift(self.drift(w)?),
            StudyKind::Navigate => self.navigate(w)?,
            StudyKind::Align => Study::Align(self.align_study(w)?),
            StudyKind::Simulate => Study::Simulate(Box::new(self.simulate(w)?)),
            StudyKind::Budget => Study::Budget(Box::new(self.budget(w)?)),
            StudyKind::MonteCarlo => Study::MonteCarlo(Box::new(self.monte_carlo(w)?)),
            StudyKind::Allan => Study::Allan(self.log(self.required_log(w, "allan")?)?),
        };
        let rate = match &study {
            Study::Imu(s) => s.imu.rate,
            Study::Drift(s) => s.imu.rate,
            Study::Navigate(s) => s.log.rate,
            Study::Aided(s) => s.log.rate,
            Study::Allan(log) => log.rate,
            Study::Align(s) => s.rate(),
            Study::Simulate(s) => s.imu.rate,
            Study::Budget(s) => s.imu.rate,
            Study::MonteCarlo(s) => s.imu.rate,
        };
        let output = self.output(w.output.as_ref(), rate)?;
        self.whole_updates(w, &study, &output, rate)?;
        let expect = w.expect.iter().map(|e| self.expect(e, w.study.value)).collect::<Result<_, _>>()?;
        let seed = w.seed.as_ref().map_or(1, |s| s.value);
        let file = self.file().into();
        // The debug form of the valid scenario is canonical: SI, defaults filled in, shortest digits that
        // read back. What only names or shows things is left out.
        let canonical = format!("{study:?} {:?} {:?} {seed}", output.every, output.imu);
        let hash = blake3::hash(canonical.as_bytes()).to_hex().to_string();
        Ok(Scenario { file, title: w.title.clone(), study, output, expect, seed, hash })
    }

    /// Keys that the study does not use are a mistake somewhere.
    fn only_used_keys(&self, w: &written::Scenario) -> Result<(), Diagnostic> {
        fn node<T>(key: &Option<At<T>>) -> Option<NodeId> {
            key.as_ref().map(|k| k.node)
        }
        use StudyKind::{Align, Allan, Budget, Drift, Imu, MonteCarlo, Navigate, Simulate};
        let keys: [(Option<NodeId>, &[StudyKind]); 14] = [
            (node(&w.motion), &[Imu, Drift, Simulate, Align, Budget, MonteCarlo]),
            (node(&w.imu), &[Imu, Drift, Simulate, Align, Budget, MonteCarlo]),
            (node(&w.gravity), &[Simulate]),
            (node(&w.aiding), &[Simulate, Budget]),
            (node(&w.initial_errors), &[Drift]),
            (node(&w.mechanization), &[Drift, Navigate, Align, Budget, MonteCarlo]),
            (node(&w.log), &[Navigate, Allan, Align]),
            (node(&w.align), &[Navigate]),
            (node(&w.filter), &[Navigate]),
            (node(&w.alignment), &[Align]),
            (node(&w.budget), &[Budget]),
            (node(&w.monte_carlo), &[MonteCarlo]),
            (w.output.as_ref().and_then(|output| node(&output.value.allan)), &[Imu]),
            (w.output.as_ref().and_then(|output| node(&output.value.logs)), &[Simulate]),
        ];
        for (node, studies) in keys {
            if let Some(node) = node.filter(|_| !studies.contains(&w.study.value)) {
                let study = match w.study.value {
                    MonteCarlo => "monte_carlo".into(),
                    study => format!("{study:?}").to_lowercase(),
                };
                return Err(self
                    .diagnostic(Spot::Node(node), format!("the study `{study}` does not use this key"))
                    .help("take it out, or choose another study"));
            }
        }
        Ok(())
    }

    pub(super) fn required<'w, T>(
        &self,
        key: &'w Option<T>,
        name: &str,
        study: &str,
        example: &str,
    ) -> Result<&'w T, Diagnostic> {
        key.as_ref().ok_or_else(|| {
            self.diagnostic(Spot::Node(self.root()), format!("the key `{name}` is missing"))
                .expected(format!("`{name}` in a scenario of `study: {study}`"))
                .example(example)
        })
    }

    fn drift(&self, w: &written::Scenario) -> Result<Drift, Diagnostic> {
        let motion = self.required(&w.motion, "motion", "drift", "motion: static")?;
        if !matches!(motion.value, Motion::Static) {
            return Err(self
                .diagnostic(Spot::Node(motion.node), "the drift study stands still")
                .expected("`static`")
                .example("motion: static"));
        }
        let start = self.required_start(w, "drift")?;
        if start.velocity != [0.0; 3] {
            let velocity = w.start.as_ref().and_then(|s| s.value.velocity.as_ref());
            let node = velocity.map_or(self.root(), |v| v.node);
            return Err(self
                .diagnostic(Spot::Node(node), "a velocity on a static base")
                .expected("zero velocity")
                .help("an error of the computed velocity belongs to `initial_errors: { velocity: […] }`"));
        }
        let written = self.required(&w.imu, "imu", "drift", "imu: { rate: 100 Hz }")?;
        let imu = self.imu(written)?;
        self.linear_and_unchanging(&written.value)?;
        Ok(Drift {
            start,
            samples: self.samples(w, "drift", imu.rate)?,
            imu,
            initial_errors: self.initial_errors(w.initial_errors.as_ref())?,
            mechanization: self.mechanization(w, "drift")?,
        })
    }

    fn navigate(&self, w: &written::Scenario) -> Result<Study, Diagnostic> {
        let log = self.imu_log(self.required_log(w, "navigate")?)?;
        let duration =
            w.duration.as_ref().map(|d| self.quantity(d, Unit::SECOND, Range::Positive)).transpose()?;
        let start = self.required_start(w, "navigate")?;
        let mechanization = self.mechanization(w, "navigate")?;
        if let Some(filter) = &w.filter {
            if w.align.is_none() && w.start.as_ref().is_some_and(|start| start.value.attitude.is_none()) {
                return Err(self
                    .diagnostic(Spot::Node(filter.node), "the attitude at the start is not known")
                    .expected(
                        "`attitude` below `start`, or `align`: no navigator and no lever arm goes without",
                    )
                    .example("align: { method: triad, window: [0 s, 300 s] }"));
            }
            let align = w.align.as_ref().map(|align| self.align_window(align)).transpose()?;
            let common = Common { log, start, align, mechanization, duration };
            return Ok(Study::Aided(Box::new(self.aided(w, filter, common)?)));
        }
        let example = "align: { method: triad, window: [0 s, 300 s] }";
        let align = self.align_window(self.required(&w.align, "align", "navigate", example)?)?;
        Ok(Study::Navigate(Navigate { log, start, align, mechanization, duration }))
    }

    fn align_window(&self, align: &At<written::Align>) -> Result<Align, Diagnostic> {
        let written::Method::Triad = align.value.method.value;
        let window = self.quantities(&align.value.window, Unit::SECOND)?;
        if !(0.0 <= window[0] && window[0] < window[1]) {
            return Err(self
                .diagnostic(
                    Spot::Node(align.value.window.node),
                    "the window is empty or begins before the log",
                )
                .expected("begin and end in seconds from the first sample")
                .example("[0 s, 300 s]"));
        }
        Ok(Align { window })
    }

    fn required_log<'w>(
        &self,
        w: &'w written::Scenario,
        study: &str,
    ) -> Result<&'w At<written::Log>, Diagnostic> {
        self.required(&w.log, "log", study, "log: { file: imu.csv, rate: 100 Hz, … }")
    }

    pub(super) fn required_start(&self, w: &written::Scenario, study: &str) -> Result<Start, Diagnostic> {
        let example = "start: { position: { lat: 45 deg, lon: 0 deg, h: 0 m } }";
        self.start(self.required(&w.start, "start", study, example)?)
    }

    /// A whole number of samples.
    pub(super) fn samples(&self, w: &written::Scenario, study: &str, rate: f64) -> Result<u64, Diagnostic> {
        let duration = self.required(&w.duration, "duration", study, "duration: 24 h")?;
        let samples = self.quantity(duration, Unit::SECOND, Range::Positive)? * rate;
        let whole = samples.round();
        let problem = if whole < 1.0 || (samples - whole).abs() > 1e-9 * samples.max(1e3) {
            "the duration is not a whole number of samples"
        } else if whole > MAX_SAMPLES {
            "the duration has more than ten thousand million samples"
        } else {
            return Ok(whole as u64);
        };
        let found = format!("{samples} samples at {rate} Hz");
        Err(self.diagnostic(Spot::Node(duration.node), problem).found(found).example("duration: 24 h"))
    }

    pub(super) fn mechanization(
        &self,
        w: &written::Scenario,
        study: &str,
    ) -> Result<Mechanization, Diagnostic> {
        let example = "mechanization: { frame: t, vertical: held, gravity: somigliana }";
        let w = &self.required(&w.mechanization, "mechanization", study, example)?.value;
        let frame = match w.frame.value {
            written::Frame::T => Frame::T,
            written::Frame::Wander => Frame::Wander,
            written::Frame::E => Frame::E,
            written::Frame::I => Frame::I,
            written::Frame::Euler => Frame::Euler,
        };
        let coning = match w.coning.as_ref().map(|coning| coning.value) {
            None | Some(written::Coning::One) => Coning::One,
            Some(written::Coning::Previous) => Coning::Previous,
            Some(written::Coning::Two) => Coning::Two,
            Some(written::Coning::Three) => Coning::Three,
            Some(written::Coning::Four) => Coning::Four,
        };
        if let (Frame::Euler, Some(written)) = (frame, w.coning.as_ref().filter(|_| coning != Coning::One)) {
            return Err(self
                .diagnostic(Spot::Node(written.node), "the first-order update takes increments as they are")
                .expected("`one`")
                .help("take it out, or choose another frame"));
        }
        let vertical = match &w.vertical.value {
            written::Vertical::Held => Vertical::Held,
            written::Vertical::Free => Vertical::Free,
            written::Vertical::Damped(damping) => Vertical::Damped(Damping {
                order: match damping.order.value {
                    order @ (2 | 3) => order as u8,
                    other => {
                        return Err(self
                            .diagnostic(Spot::Node(damping.order.node), "no such order of the vertical loop")
                            .expected("2 or 3")
                            .found(other.to_string())
                            .example("vertical: { damped: { order: 3, tau: 100 s } }"));
                    }
                },
                tau: self.quantity(&damping.tau, Unit::SECOND, Range::Positive)?,
            }),
        };
        let gravity = match w.gravity.value {
            written::Gravity::Normal => Gravity::Normal,
            written::Gravity::Somigliana => Gravity::Somigliana,
        };
        Ok(Mechanization { frame, vertical, gravity, coning })
    }

    fn output(&self, output: Option<&At<written::Output>>, rate: f64) -> Result<Output, Diagnostic> {
        let Some(w) = output.map(|o| &o.value) else {
            let formats = Formats { csv: true, png: true, svg: false };
            return Ok(Output { every: None, formats, imu: Content::Rates, kf_gins: false });
        };
        let every = w.every.as_ref().map(|every| self.every(every, rate)).transpose()?;
        let formats = w.formats.as_ref().map_or(Formats { csv: true, png: true, svg: false }, |formats| {
            let has = |wanted: fn(written::Format) -> bool| formats.value.iter().any(|f| wanted(f.value));
            Formats {
                csv: has(|f| matches!(f, written::Format::Csv)),
                png: has(|f| matches!(f, written::Format::Png)),
                svg: has(|f| matches!(f, written::Format::Svg)),
            }
        });
        Ok(Output {
            every,
            formats,
            imu: w.imu.map_or(Content::Rates, content),
            kf_gins: w.logs.as_ref().is_some_and(|logs| !logs.value.is_empty()),
        })
    }

    /// Rows are states after whole updates.
    fn whole_updates(
        &self,
        w: &written::Scenario,
        study: &Study,
        output: &Output,
        rate: f64,
    ) -> Result<(), Diagnostic> {
        let (mechanization, samples) = match study {
            Study::Drift(drift) => (&drift.mechanization, Some(drift.samples)),
            Study::Budget(budget) => (&budget.mechanization, Some(budget.samples)),
            Study::MonteCarlo(study) => (&study.mechanization, Some(study.samples)),
            Study::Navigate(navigate) => {
                let last = navigate.duration.map(|duration| (duration * rate).round() as u64);
                (&navigate.mechanization, last)
            }
            _ => return Ok(()),
        };
        let update = mechanization.coning.samples() as u64;
        let every = output.every.map_or(1, |every| (every * rate).round() as u64);
        let node = |key: Option<NodeId>| Spot::Node(key.unwrap_or(self.root()));
        let row = w.output.as_ref().and_then(|o| o.value.every.as_ref()).map(|every| every.node);
        let end = w.duration.as_ref().map(|duration| duration.node);
        for (samples, spot, what) in [
            (Some(every), node(row.or(w.output.as_ref().map(|o| o.node))), "the interval of the rows"),
            (samples, node(end), "the duration"),
        ] {
            if samples.is_some_and(|samples| !samples.is_multiple_of(update)) {
                return Err(self
                    .diagnostic(spot, format!("{what} is not a whole number of updates"))
                    .expected(format!(
                        "a multiple of {} s: an update has {update} samples",
                        update as f64 / rate
                    ))
                    .example(format!("every: {} s", update as f64 / rate * 100.0)));
            }
        }
        Ok(())
    }

    /// An interval of whole samples.
    fn every(&self, every: &written::Quantity, rate: f64) -> Result<f64, Diagnostic> {
        let seconds = self.quantity(every, Unit::SECOND, Range::Positive)?;
        let samples = seconds * rate;
        if samples.round() < 1.0 || (samples - samples.round()).abs() > 1e-6 {
            return Err(self
                .diagnostic(Spot::Node(every.node), "the interval is not a whole number of samples")
                .found(format!("{samples} samples at {rate} Hz"))
                .example("every: 60 s"));
        }
        Ok(seconds)
    }
}
