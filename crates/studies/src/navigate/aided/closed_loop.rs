//! A navigator and an error-state filter, closed after every measurement.

use schuler_frames::{B, Gravity, Vec3, earth::omega_ie_t};
use schuler_imu::{Instrument, Truth};
use schuler_strapdown::filter::{
    Accumulator, Filter, FilterError, Form, Gate, Measurement, Model, NavStates, Now, Outcome,
};
use schuler_strapdown::{ErrorDynamics, Increments, LocalLevel, NavError, Pva, Vertical};

use super::{gathered::Gathered, sensors::SensorErrors};
use crate::scenario::Aided;

/// Longest interval over which a transition is gathered, s.
const LONGEST: f64 = 1.0;

/// A local-level navigator whose errors a filter with room for `N` states takes out.
///
/// Between measurements [`ClosedLoop::advance`] takes the increments of the IMU, freed of the sensor errors estimated so
/// far, and gathers the transition; a measurement within a sample is met by advancing with a part of its increments.
#[derive(Clone, Debug)]
pub struct ClosedLoop<const N: usize> {
    filter: Filter<N>,
    navigator: LocalLevel,
    accumulator: Accumulator<N>,
    /// What the accumulator has not seen yet.
    gathered: Gathered,
    errors: SensorErrors,
    /// Whether the filter knows more than `errors` does.
    stale: bool,
    gravity: Gravity,
    vertical: Vertical,
    /// What the sensors measured last, the same freed of the errors known, and its interval (s).
    measured: Option<Increments>,
    seen: (Increments, f64),
}

impl<const N: usize> ClosedLoop<N> {
    /// Starts at `pva` with the settings of `aided`.
    ///
    /// # Errors
    /// The sources need more than `N` states, or a deviation is not one.
    pub fn new(aided: &Aided, pva: &Pva, vertical: Vertical) -> Result<Self, FilterError> {
        let nav = if vertical == Vertical::Held { NavStates::HELD } else { NavStates::ALL };
        let mut filter = Filter::new(Model::new(aided.form, nav, &aided.spec)?, &aided.sigma)?;
        if let Some(p) = aided.gate {
            filter.gate = Gate::vector(p);
        }
        Ok(ClosedLoop::with(filter, pva, aided.mechanization.gravity, vertical))
    }

    /// Starts at `pva` with a filter at its start.
    pub fn with(filter: Filter<N>, pva: &Pva, gravity: Gravity, vertical: Vertical) -> Self {
        let accumulator = Accumulator::new(filter.model(), ErrorDynamics { gravity, vertical }, pva);
        ClosedLoop {
            errors: SensorErrors::new(&filter),
            stale: false,
            filter,
            navigator: LocalLevel::new(pva, gravity, vertical),
            accumulator,
            gathered: Gathered::default(),
            gravity,
            vertical,
            measured: None,
            seen: (Increments { dtheta: Vec3::ZERO, dv: Vec3::ZERO }, 1.0),
        }
    }

    /// Goes on by the increments measured over `dt` (s).
    #[inline]
    pub fn advance(&mut self, measured: &Increments, dt: f64) {
        if self.stale {
            self.errors.refresh(&self.filter);
            self.stale = false;
        }
        let freed = self.freed(measured, dt);
        self.navigator.step(&freed, dt);
        self.gathered.push(&freed, dt);
        self.measured = Some(*measured);
        self.seen = (freed, dt);
        if self.gathered.is_full(dt) {
            self.gather();
            if self.accumulator.elapsed() > LONGEST - 0.5 * dt {
                self.close();
            }
        }
    }

    /// `measured` over `dt` (s), freed of the sensor errors known.
    #[inline]
    fn freed(&self, measured: &Increments, dt: f64) -> Increments {
        let (dtheta, dv) = (measured.dtheta.as_array(), measured.dv.as_array());
        let [gyro, accel] = self.errors.integrated(&self.filter, dtheta, dv, dt);
        Increments { dtheta: measured.dtheta - Vec3::claim(gyro), dv: measured.dv - Vec3::claim(accel) }
    }

    /// Hands the samples gathered to the accumulator.
    fn gather(&mut self) {
        if self.gathered.t > 0.0 {
            let (increments, t) = self.gathered.take();
            self.accumulator.step(self.filter.model(), &self.navigator.pva(), &increments, t);
        }
    }

    /// Brings the covariance to the time of the navigator.
    pub fn close(&mut self) {
        self.gather();
        if self.accumulator.elapsed() > 0.0 {
            let step = self.accumulator.close(self.filter.model());
            self.filter.propagate(&step);
            self.stale = true;
        }
    }

    /// Takes a measurement, and its estimates out of navigator and sensors.
    ///
    /// # Errors
    /// Numbers that make no sense.
    pub fn measure(&mut self, measurement: &dyn Measurement) -> Result<Outcome, FilterError> {
        self.close();
        let now = self.now();
        let (pva, outcome) = (now.pva, self.filter.update(measurement, &now)?);
        if outcome.accepted[..outcome.len].contains(&true) {
            let pva = self.filter.feedback(&pva);
            self.navigator = LocalLevel::new(&pva, self.gravity, self.vertical);
            self.accumulator.begin(self.filter.model(), &pva);
            // The next measurement at this time has the rate freed of what is known now, as its row says.
            self.errors.refresh(&self.filter);
            self.stale = false;
            if let Some(measured) = &self.measured {
                self.seen.0 = self.freed(measured, self.seen.1);
            }
        }
        Ok(outcome)
    }

    /// Where the navigator is, as a measurement would meet it.
    pub fn now(&self) -> Now {
        Now { pva: self.navigator.pva(), seen: self.truth(), dt: self.seen.1 }
    }

    /// The filter, at the time of the last [`ClosedLoop::close`].
    pub fn filter(&self) -> &Filter<N> {
        &self.filter
    }

    /// Time since the last [`ClosedLoop::close`], whoever asked for it, s: zero right after it.
    pub fn since_close(&self) -> f64 {
        self.accumulator.elapsed() + self.gathered.t
    }

    /// Angular rate omega_eb^b (rad/s) and specific force (m/s²) of the last step, freed of the errors known.
    pub fn motion(&self) -> (Vec3<B>, Vec3<B>) {
        let (Increments { dtheta, dv }, rate) = (self.seen.0, 1.0 / self.seen.1);
        let pva = self.navigator.pva();
        let (s, c) = libm::sincos(pva.position.lat);
        let earth = pva.c_tb.inverse() * omega_ie_t(s, c).as_vec3();
        (dtheta * rate - earth, dv * rate)
    }

    fn truth(&self) -> Truth {
        Truth::increments(self.seen.0.dtheta.as_array(), self.seen.0.dv.as_array())
    }

    /// State of the navigator.
    pub fn pva(&self) -> Pva {
        self.navigator.pva()
    }

    /// Standard deviations of the nine navigation errors, zero where the vertical channel is held. Those of the last
    /// [`ClosedLoop::close`].
    pub fn sigma(&self) -> [f64; 9] {
        use schuler_strapdown::filter::NavState;
        NavState::ALL.map(|state| self.filter.model().nav_index(state).map_or(0.0, |k| self.filter.sigma(k)))
    }

    /// Errors of gyros and accelerometers along body axes as estimated, rad/s and m/s².
    pub fn sensor_errors(&self) -> [[f64; 3]; 2] {
        let seen = self.truth();
        Instrument::ALL.map(|i| self.filter.sensor_error(i, &seen, self.seen.1))
    }

    /// Name, estimate and standard deviation of each state of the error sources.
    pub fn states(&self) -> impl Iterator<Item = (String, f64, f64)> {
        let model = self.filter.model();
        let estimate = self.filter.estimate();
        (model.nav_len()..model.len())
            .map(move |k| (model.name(k).to_string(), estimate[k], self.filter.sigma(k)))
    }

    /// Normalized error squared of the navigation errors against their true value `error`, and its degrees of freedom.
    pub fn nees(&self, error: &NavError) -> Option<(f64, usize)> {
        let x = nalgebra::SVector::<f64, 9>::from(error.as_array());
        let x = Form::from_phi(self.filter.model().form(), &self.pva()) * x;
        let mut states = Vec::new();
        let mut truth = Vec::new();
        for (k, state) in schuler_strapdown::filter::NavState::ALL.into_iter().enumerate() {
            if let Some(index) = self.filter.model().nav_index(state) {
                states.push(index);
                truth.push(x[k]);
            }
        }
        Some((self.filter.nees(&states, &truth)?, states.len()))
    }
}
