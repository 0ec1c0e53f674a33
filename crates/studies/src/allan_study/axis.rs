//! One sensor axis: its samples, its deviations, its error model.

use schuler_allan::{
    AllanError, Curve, Estimator, Fit, Grid, NoiseType, Phase, Point, Pyramid, SunEq3, edf, fit, identify,
    pyramid_edf, sun_eq3, variance_factors,
};
use schuler_imu::Instrument;
use schuler_strapdown::Increments;

use crate::log::{Content, LogSpec};

/// More samples than this are not kept but go into the pyramid: six axes take 200 MB.
pub const KEPT: usize = 1 << 22;
/// Increments that a pyramid takes at a time.
const BLOCK: usize = 4096;
/// Estimates of the overlapping deviation per octave; the fit uses every second.
const PER_OCTAVE: u32 = 4;
const CONFIDENCE: f64 = 0.95;

/// A sensor axis while the log is read.
pub struct Channel {
    name: String,
    instrument: Instrument,
    /// Along x, y or z: 0, 1 or 2.
    axis: usize,
    dt: f64,
    /// What one count is of an increment, as long as all increments are whole counts.
    count: Option<f64>,
    /// Mean rates, as long as they are few.
    kept: Vec<f64>,
    /// How many are few.
    limit: usize,
    /// Takes over where they are many.
    pyramid: Option<Result<Pyramid, AllanError>>,
}

/// A sensor axis with what was found.
pub struct Axis {
    /// `gyro.x`.
    pub name: String,
    pub instrument: Instrument,
    /// What one count is of an increment (rad, m/s), where all increments are whole counts.
    pub count: Option<f64>,
    pub found: Result<Found, AllanError>,
}

/// What a log says about an axis.
pub struct Found {
    /// The overlapping deviation first.
    pub curves: Vec<Vec<Estimate>>,
    /// The error model, or why there is none.
    pub fit: Result<Fit, AllanError>,
    /// What equation (3) of the paper makes of the same points.
    pub sun: Option<SunEq3>,
    /// Whether the log was too long for all samples to be kept.
    pub streamed: bool,
}

/// An estimate with its interval.
#[derive(Clone, Copy)]
pub struct Estimate {
    pub estimator: Estimator,
    pub point: Point,
    /// Equivalent degrees of freedom.
    pub edf: f64,
    /// Ends of the 95 % interval of the deviation.
    pub low: f64,
    pub high: f64,
}

impl Channel {
    /// The body axes that a log has, each with at most `limit` samples kept.
    pub fn all(log: &LogSpec, limit: usize) -> Vec<Channel> {
        let of = |instrument: Instrument, axis: usize| {
            let sensor = log.axes.sensor_axis(axis);
            (sensor < log.columns.of(instrument).len()).then(|| Channel {
                name: format!("{instrument}.{}", ["x", "y", "z"][axis]),
                instrument,
                axis,
                dt: 1.0 / log.rate,
                count: (log.content == Content::Increments).then(|| log.scale.of(instrument)[sensor].abs()),
                kept: Vec::new(),
                limit,
                pyramid: None,
            })
        };
        Instrument::ALL.into_iter().flat_map(|i| (0..3).filter_map(move |axis| of(i, axis))).collect()
    }

    /// Takes the increment of this axis from the next sample.
    pub fn push(&mut self, increments: &Increments) {
        let vector = match self.instrument {
            Instrument::Gyro => increments.dtheta.as_array(),
            Instrument::Accel => increments.dv.as_array(),
        };
        let increment = vector[self.axis];
        self.count = self.count.filter(|count| is_whole(increment / count));
        self.kept.push(increment / self.dt);
        if self.pyramid.is_some() && self.kept.len() >= BLOCK || self.kept.len() >= self.limit {
            self.flush();
        }
    }

    fn flush(&mut self) {
        let pyramid = self.pyramid.get_or_insert_with(|| Pyramid::new(self.dt));
        if let Ok(p) = pyramid
            && let Err(error) = p.push(&self.kept)
        {
            *pyramid = Err(error);
        }
        self.kept.clear();
    }

    /// Estimates and fits.
    pub fn finish(mut self) -> Axis {
        let found = if self.pyramid.is_some() { self.streamed() } else { self.whole() };
        Axis { name: self.name, instrument: self.instrument, count: self.count, found }
    }

    fn streamed(&mut self) -> Result<Found, AllanError> {
        self.flush();
        let pyramid = self.pyramid.take().unwrap_or_else(|| Pyramid::new(self.dt))?;
        let curve = pyramid.curve()?;
        // The noise type, from the slope to the next octave: the samples are gone.
        let noise = |k: usize| {
            let p = &curve.points;
            let (a, b) = if k + 1 < p.len() { (k, k + 1) } else { (k - 1, k) };
            match (p[b].variance / p[a].variance).log2() {
                slope if slope < -1.5 => NoiseType::Quantization,
                slope if slope < -0.5 => NoiseType::White,
                slope if slope < 0.5 => NoiseType::Flicker,
                _ => NoiseType::RandomWalk,
            }
        };
        let edfs: Vec<f64> = (0..curve.points.len())
            .map(|k| pyramid_edf(noise(k), curve.points[k].m, curve.n_phase))
            .collect();
        Ok(Found::of(&curve, vec![with_intervals(&curve, &edfs)?], true))
    }

    fn whole(&self) -> Result<Found, AllanError> {
        let phase = Phase::from_rate(&self.kept, self.dt)?;
        let grid = |e| if e == Estimator::Overlapping { Grid::PerOctave(PER_OCTAVE) } else { Grid::Octave };
        let estimators = [Estimator::Overlapping, Estimator::Modified, Estimator::Hadamard, Estimator::Total];
        let curves = estimators
            .map(|e| Curve::estimate(&phase, e, &grid(e)))
            .into_iter()
            .collect::<Result<Vec<_>, _>>()?;
        let with_intervals = curves.iter().map(|curve| {
            // Where averages are too few to tell, the noise is that of the last time where they were not.
            let mut noise = NoiseType::White;
            let edfs: Vec<f64> = curve
                .points
                .iter()
                .map(|p| {
                    noise = identify(&phase, p.m).unwrap_or(noise);
                    edf(curve.estimator, noise, p.m, curve.n_phase)
                })
                .collect();
            with_intervals(curve, &edfs)
        });
        let with_intervals = with_intervals.collect::<Result<_, _>>()?;
        Ok(Found::of(&curves[0], with_intervals, false))
    }
}

/// Is this a whole number that is no accident? Small fractions are none, and neither are huge numbers.
fn is_whole(x: f64) -> bool {
    let whole = x.round();
    (x - whole).abs() <= 1e-9 * whole.abs() && whole.abs() < 1e8
}

impl Found {
    fn of(overlapping: &Curve, curves: Vec<Vec<Estimate>>, streamed: bool) -> Found {
        let sun = sun_eq3(&overlapping.up_to(4.0)).ok();
        Found { curves, fit: fit(overlapping), sun, streamed }
    }
}

fn with_intervals(curve: &Curve, edfs: &[f64]) -> Result<Vec<Estimate>, AllanError> {
    let estimate = |(point, edf): (&Point, &f64)| {
        let (low, high) = variance_factors(*edf, CONFIDENCE)?;
        let deviation = point.deviation();
        Ok(Estimate {
            estimator: curve.estimator,
            point: *point,
            edf: *edf,
            low: deviation * low.sqrt(),
            high: deviation * high.sqrt(),
        })
    };
    curve.points.iter().zip(edfs).map(estimate).collect()
}
