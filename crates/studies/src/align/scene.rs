//! The truth of a simulated alignment: what the sensors go through, and how the base stands at each row.

use schuler_frames::{B, Geodetic, Gravity, Rot, T, Vec3, phi_between, with_phi};
use schuler_imu::{Input, Instrument, Truth};
use schuler_strapdown::Vertical;

use crate::Diagnostic;
use crate::channel;
use crate::scenario::{AlignStudy, Imu, Motion, Scenario};
use crate::trajectory;

/// Samples of a moving base that are kept in memory.
const MOST_SAMPLES: u64 = 4_000_000;

/// What all runs and methods share.
pub struct Scene {
    pub position: Geodetic,
    pub gravity: Gravity,
    pub vertical: Vertical,
    /// Sample interval, s.
    pub dt: f64,
    /// Samples of the alignment.
    pub samples: u64,
    /// Samples that are navigated after it.
    pub navigate: u64,
    /// Numbers of samples after which a row is kept, alignment and navigation.
    pub rows: Vec<u64>,
    /// The base.
    base: Base,
}

/// What the base does.
struct Base {
    truth: trajectory::Truth,
    /// Input of the sensors, sample by sample; one for all where nothing changes.
    inputs: Vec<Truth>,
    /// After this sample the instrument stands otherwise: the rotation from the old body axes to the new.
    knock: Option<(u64, Rot<B, B>)>,
    temperature: Option<crate::scenario::Temperature>,
}

impl Scene {
    /// The scene of a valid study on a simulated base.
    pub fn new(
        scenario: &Scenario,
        study: &AlignStudy,
        motion: &Motion,
        imu: &Imu,
    ) -> Result<Scene, Diagnostic> {
        let position = study.start.position;
        let gravity = study.mechanization.gravity;
        let dt = 1.0 / study.rate();
        let (samples, navigate) = (study.samples(), study.navigate);
        let stride = scenario.output.every.map_or(1, |every| (every / dt).round().max(1.0) as u64);
        let impossible = |what: String| Diagnostic::new(&scenario.file, what).path("motion");
        let trajectory = motion
            .trajectory(&study.start, gravity, samples, dt)
            .map_err(|fault| impossible(fault.to_string()))?
            .ok_or_else(|| impossible("a motion that is no place on the Earth".into()))?;
        let truth = trajectory::Truth::boxed(trajectory, gravity);
        let steady = matches!(motion, Motion::Static);
        let all = samples + navigate;
        if !steady && all > MOST_SAMPLES {
            return Err(Diagnostic::new(&scenario.file, "more samples of a moving base than can be kept")
                .path("duration")
                .expected(format!("at most {MOST_SAMPLES} samples, or `motion: static`"))
                .found(all.to_string()));
        }
        let input = |k: u64| truth.imu_truth(k as f64 * dt, dt);
        let inputs = if steady { vec![input(0)] } else { (0..all).map(input).collect() };
        let knock = study.knock.map(|knock| {
            // Computed minus true shall jump by phi: the truth jumps by -phi.
            let c_tb = truth.moment(knock.at as f64 * dt).pva.c_tb;
            let moved = with_phi(c_tb, -Vec3::claim(knock.phi));
            (knock.at, moved.inverse() * c_tb)
        });
        Ok(Scene {
            position,
            gravity,
            vertical: channel::vertical(&study.mechanization, position),
            dt,
            samples,
            navigate,
            rows: rows(stride, samples, all),
            base: Base { truth, inputs, knock, temperature: imu.temperature.clone() },
        })
    }

    /// Input of the sensors over sample `k`, from 0.
    pub fn input(&self, k: u64) -> Truth {
        let Base { inputs, knock, temperature, .. } = &self.base;
        let mut input = if inputs.len() == 1 { inputs[0] } else { inputs[k as usize] };
        if let Some((at, turn)) = knock
            && k >= *at
        {
            input = turned(&input, *turn, self.dt);
        }
        match temperature {
            Some(temperature) => input.at_temperature(&temperature.profile(), k as f64 * self.dt, self.dt),
            None => input,
        }
    }

    /// True attitude after `k` samples.
    pub fn c_tb(&self, k: u64) -> Rot<T, B> {
        let c_tb = self.base.truth.moment(k as f64 * self.dt).pva.c_tb;
        match self.base.knock {
            Some((at, turn)) if k >= at => c_tb * turn.inverse(),
            _ => c_tb,
        }
    }

    /// The attitudes of the alignment in which the base stands still from one measurement to the next, `every` so many samples, one
    /// after the other, as the gyros see them: a knock that they miss is none.
    pub fn dwells(&self, every: u64) -> Vec<Rot<T, B>> {
        let at = |k: u64| self.base.truth.moment(k as f64 * self.dt).pva.c_tb;
        let same = |a: Rot<T, B>, b: Rot<T, B>| phi_between(a, b).norm() < 1e-12;
        let mut dwells = vec![at(0)];
        if self.base.inputs.len() > 1 {
            for k in (1..=self.samples / every).map(|n| n * every) {
                let now = at(k);
                if same(now, at(k - every)) && !dwells.last().is_some_and(|last| same(*last, now)) {
                    dwells.push(now);
                }
            }
        }
        dwells
    }

    /// When the knock comes, s.
    pub fn knock(&self) -> Option<f64> {
        self.base.knock.map(|(at, _)| self.time(at))
    }

    /// Position, velocity and attitude after `k` samples.
    pub fn pva(&self, k: u64) -> schuler_strapdown::Pva {
        let pva = self.base.truth.moment(k as f64 * self.dt).pva;
        schuler_strapdown::Pva { c_tb: self.c_tb(k), ..pva }
    }

    /// Error of an attitude after `k` samples.
    pub fn error(&self, c_tb: Rot<T, B>, k: u64) -> Vec3<T> {
        phi_between(c_tb, self.c_tb(k))
    }

    /// Time of a sample's end, s.
    pub fn time(&self, k: u64) -> f64 {
        k as f64 * self.dt
    }
}

/// The same motion as an instrument feels it that is turned by `turn`.
fn turned(input: &Truth, turn: Rot<B, B>, dt: f64) -> Truth {
    let means = Input::new(Instrument::Gyro, input, dt, input.temperature);
    let turn = |v: [f64; 3]| (turn * Vec3::<B>::claim(v)).as_array();
    Truth::rates(turn(means.omega), turn(means.f))
        .with_omega_dot(turn(input.omega_dot))
        .with_vibration(input.vibration)
}

/// Each `stride` samples, the end of the alignment and the last.
fn rows(stride: u64, samples: u64, all: u64) -> Vec<u64> {
    let mut rows: Vec<u64> = (1..=all / stride).map(|k| k * stride).collect();
    for end in [samples, all] {
        if let Err(at) = rows.binary_search(&end) {
            rows.insert(at, end);
        }
    }
    rows
}
