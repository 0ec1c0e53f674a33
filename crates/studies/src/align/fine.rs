//! Fine alignment: a navigator at a known place whose velocity errors tell its attitude errors.

use schuler_frames::{B, Rot, T, Vec3};
use schuler_imu::process::LinearModel;
use schuler_imu::{Instrument, Truth};
use schuler_strapdown::filter::{
    Accumulator, Filter, Measurement, Model, NavState, NavStates, Now, Observation, Outcome, Position,
    Velocity, measurement::HORIZONTAL,
};
use schuler_strapdown::{ErrorDynamics, Increments, LocalLevel, Mechanization, Pva, Samples};

use super::adaptation::Adaptation;
use super::method::Found;
use super::place::Place;
use crate::scenario::FilterSettings;

/// Room for states: five or seven navigation errors and what the sources need.
pub const ROOM: usize = 48;

/// The three attitude errors.
const PHI: [NavState; 3] = [NavState::AttitudeN, NavState::AttitudeE, NavState::AttitudeD];

/// A closed-loop error-state filter beside a navigator.
pub struct Fine {
    filter: Filter<ROOM>,
    settings: FilterSettings,
    /// States of the correlated noise, north and east.
    coloured: Option<[usize; 2]>,
    adaptation: Adaptation<ROOM>,
    running: Option<Running>,
    last: Option<Outcome>,
}

/// What there is once the coarse attitude is.
struct Running {
    place: Place,
    navigator: LocalLevel,
    samples: Samples,
    accumulator: Accumulator<ROOM>,
    /// What the sensors saw last, freed of the errors known, and its interval (s).
    seen: (Truth, f64),
}

impl Fine {
    pub fn new(settings: &FilterSettings) -> Result<Fine, String> {
        let nav = if settings.position { NavStates::HELD } else { NavStates::LEVEL };
        let mut model = Model::new(settings.form, nav, &settings.spec).map_err(|e| e.to_string())?;
        let mut coloured = None;
        if let Some((sigma, tau)) = settings.coloured {
            // Stationary: x' = -x/tau + w, of density 2 sigma²/tau.
            let process = LinearModel::scalar(-1.0 / tau, 2.0 * sigma * sigma / tau, 0.0, sigma * sigma);
            let mut add = |name| model.add_extra(name, &process).map_err(|e| e.to_string());
            coloured = Some([add("noise_n")?, add("noise_e")?]);
        }
        let FilterSettings { tilt, heading, velocity, .. } = *settings;
        let position = settings.noise;
        let sigma = [position, position, 0.0, velocity, velocity, 0.0, tilt, tilt, heading];
        let filter = Filter::new(model, &sigma).map_err(|e| e.to_string())?;
        let adaptation = Adaptation::new(settings.strategy.kind);
        let mut fine =
            Fine { coloured, filter, settings: settings.clone(), adaptation, running: None, last: None };
        let states = fine.states();
        match (settings.strategy.cap, settings.bound, &mut fine.filter.cap) {
            (false, _, cap) => *cap = None,
            (true, Some([tilt, heading]), Some(cap)) => {
                for (state, sigma) in states.into_iter().zip([tilt, tilt, heading]) {
                    cap[state] = sigma * sigma;
                }
            }
            _ => {}
        }
        Ok(fine)
    }

    pub fn begin(&mut self, c_tb: Rot<T, B>, place: &Place) {
        let pva = Pva { position: place.position, v_t: Vec3::ZERO, c_tb };
        let dynamics = ErrorDynamics { gravity: place.gravity, vertical: place.vertical };
        self.running = Some(Running {
            place: *place,
            navigator: LocalLevel::new(&pva, place.gravity, place.vertical),
            samples: Samples::new(place.coning),
            accumulator: Accumulator::new(self.filter.model(), dynamics, &pva),
            seen: (Truth::rates([0.0; 3], [0.0; 3]), 1.0),
        });
    }

    pub fn advance(&mut self, increments: &Increments, dt: f64) {
        let Some(run) = &mut self.running else { return };
        let measured = Truth::increments(increments.dtheta.as_array(), increments.dv.as_array());
        let error = |instrument| Vec3::claim(self.filter.sensor_error(instrument, &measured, dt));
        let freed = Increments {
            dtheta: increments.dtheta - error(Instrument::Gyro) * dt,
            dv: increments.dv - error(Instrument::Accel) * dt,
        };
        if let Some(motion) = run.samples.add(&freed) {
            run.navigator.advance(&motion, dt);
        }
        let pva = run.navigator.pva();
        run.accumulator.step(self.filter.model(), &pva, &freed, dt);
        run.seen = (Truth::increments(freed.dtheta.as_array(), freed.dv.as_array()), dt);
    }

    /// The base has this velocity (north, east, m/s), or stays where it is.
    pub fn measure(&mut self, velocity: [f64; 2]) -> Result<(), String> {
        let Some(run) = &mut self.running else { return Ok(()) };
        let step = run.accumulator.close(self.filter.model());
        let pva = run.navigator.pva();
        let now = Now { pva, seen: run.seen.0, dt: run.seen.1 };
        let observation = observation(&self.settings, self.coloured, &run.place, velocity, &now)?;
        let cycle = self.filter.cycle(&mut self.adaptation, &step, &observation, &now);
        self.last = Some(cycle.map_err(|e| e.to_string())?);
        let mut pva = self.filter.feedback(&pva);
        if !self.settings.position {
            // Without states for it the position would go its way.
            pva.position = run.place.position;
        }
        run.navigator = LocalLevel::new(&pva, run.place.gravity, run.place.vertical);
        run.accumulator.begin(self.filter.model(), &pva);
        Ok(())
    }

    /// What it sees when the base has this velocity (north, east, m/s).
    pub fn observation(&self, place: &Place, velocity: [f64; 2], now: &Now) -> Result<Observation, String> {
        observation(&self.settings, self.coloured, place, velocity, now)
    }

    /// What the last update did.
    pub fn last(&self) -> Option<&Outcome> {
        self.last.as_ref()
    }

    /// The filter.
    pub fn filter(&self) -> &Filter<ROOM> {
        &self.filter
    }

    pub fn found(&self) -> Result<Found, String> {
        let run = self.running.as_ref().ok_or("the coarse attitude is not there yet")?;
        let sigma = self.states().map(|k| self.filter.sigma(k));
        Ok(Found { c_tb: run.navigator.pva().c_tb, sigma: Some(sigma) })
    }

    /// Covariance of phi north and down, rad².
    pub fn cross(&self) -> f64 {
        let [north, _, down] = self.states();
        self.filter.p[(north, down)]
    }

    pub fn sensor_errors(&self) -> [[f64; 3]; 2] {
        let Some(run) = &self.running else { return [[0.0; 3]; 2] };
        Instrument::ALL.map(|i| self.filter.sensor_error(i, &run.seen.0, run.seen.1))
    }

    pub fn nees(&self, phi: Vec3<T>) -> Option<f64> {
        self.running.as_ref()?;
        self.filter.nees(&self.states(), &phi.as_array())
    }

    /// Numbers of the attitude states.
    fn states(&self) -> [usize; 3] {
        PHI.map(|state| {
            self.filter.model().nav_index(state).expect("invariant: every choice here has attitude")
        })
    }
}

/// The base has this velocity, or stays where it is, by what the filter measures.
fn observation(
    settings: &FilterSettings,
    coloured: Option<[usize; 2]>,
    place: &Place,
    velocity: [f64; 2],
    now: &Now,
) -> Result<Observation, String> {
    let sigma = [settings.noise; 3];
    let seen = if settings.position {
        Position { position: place.position, sigma, lever: Vec3::ZERO, axes: HORIZONTAL }.observe(now)
    } else {
        let v_t = Vec3::new(velocity[0], velocity[1], 0.0);
        Velocity { v_t, sigma, lever: Vec3::ZERO, axes: HORIZONTAL }.observe(now)
    };
    let Some([n, e]) = coloured else { return Ok(seen) };
    // Computed minus measured: the noise counts the other way.
    let with = seen.with_extra(n, [-1.0, 0.0, 0.0]).and_then(|o| o.with_extra(e, [0.0, -1.0, 0.0]));
    with.map_err(|e| e.to_string())
}
