use super::bandwidth::LowPass;
use super::faults::Fault;
use super::window::Window;
use super::{Channel, Output, Status};

/// Normals that a channel needs for each sample: jitter and fault.
pub(crate) const DRAWS: usize = 2;

/// The readout of one instrument, prepared for a step length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chain {
    channel: Channel,
    low_pass: Option<LowPass>,
}

/// What changes in a readout from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ChainState {
    started: bool,
    filter: [[f64; 2]; 3],
    window: Window,
    remainder: [f64; 3],
    last: [f64; 3],
    stuck: u32,
}

impl ChainState {
    pub const START: ChainState = ChainState {
        started: false,
        filter: [[0.0; 2]; 3],
        window: Window::START,
        remainder: [0.0; 3],
        last: [0.0; 3],
        stuck: 0,
    };
}

#[cfg(feature = "serde")]
impl ChainState {
    /// How many numbers [`ChainState::visit`] hands out.
    pub const NUMBERS: usize = 2 + 6 + Window::NUMBERS + 3 + 3;

    /// Hands every number to `each`, to be read or replaced.
    pub fn visit(&mut self, mut each: impl FnMut(&mut f64)) {
        let mut started = f64::from(u8::from(self.started));
        each(&mut started);
        self.started = started != 0.0;
        let mut stuck = f64::from(self.stuck);
        each(&mut stuck);
        self.stuck = stuck as u32;
        self.filter.as_flattened_mut().iter_mut().for_each(&mut each);
        self.remainder.iter_mut().for_each(&mut each);
        self.last.iter_mut().for_each(&mut each);
        self.window.visit(&mut each);
    }
}

impl Chain {
    pub fn new(channel: Channel) -> Chain {
        Chain { channel, low_pass: None }
    }

    /// Prepares for steps of `dt` seconds.
    pub fn discretise(&mut self, dt: f64) {
        self.low_pass = self.channel.bandwidth.map(|b| LowPass::new(b, self.channel.sampling, dt));
    }

    /// The increments put out over a step in which the mean input with all its errors was `mean`.
    pub fn step(
        &self,
        state: &mut ChainState,
        dt: f64,
        mut mean: [f64; 3],
        [jitter, fault]: [f64; DRAWS],
    ) -> ([f64; 3], Status) {
        let (c, first) = (&self.channel, !state.started);
        state.started = true;
        if let Some(low_pass) = &self.low_pass {
            for (filter, m) in state.filter.iter_mut().zip(&mut mean) {
                if first {
                    // Settled on its first input.
                    *filter = [*m, 0.0];
                }
                *m = low_pass.step(filter, *m);
            }
        }
        let mut duration = dt;
        let mut increment = mean.map(|m| m * dt);
        if !c.timing.is_ideal() {
            (increment, duration) = state.window.sample(&c.timing, dt, mean, jitter, first);
        }
        let mut status = Status::default();
        if let Some(range) = &c.range {
            for i in 0..3 {
                let (low, high) = (range[i].0 * duration, range[i].1 * duration);
                status.saturated[i] = increment[i] < low || increment[i] > high;
                increment[i] = increment[i].clamp(low, high);
            }
        }
        // A device that puts out rates divides by the window that it believes in or has measured; over
        // an empty window it repeats itself.
        let mut out = match c.output {
            Output::Increments => increment,
            Output::Rates if duration > 0.0 => increment.map(|d| d / duration),
            Output::Rates => state.last,
        };
        if let Some(lsb) = &c.lsb {
            for i in 0..3 {
                let wanted = out[i] + if lsb.carry { state.remainder[i] } else { 0.0 };
                out[i] = libm::round(wanted / lsb.size[i]) * lsb.size[i];
                state.remainder[i] = wanted - out[i];
            }
        }
        match c.faults.decide(fault) {
            _ if state.stuck > 0 => {
                state.stuck -= 1;
                (status.stuck, out) = (true, state.last);
            }
            Fault::None => {}
            Fault::Drop => (status.dropped, out) = (true, [0.0; 3]),
            Fault::Repeat => (status.repeated, out) = (true, state.last),
            Fault::Stick => {
                state.stuck = c.faults.stuck_samples.saturating_sub(1);
                (status.stuck, out) = (true, state.last);
            }
        }
        if !status.dropped {
            state.last = out;
        }
        match c.output {
            Output::Increments => (out, status),
            Output::Rates => (out.map(|m| m * dt), status),
        }
    }
}
