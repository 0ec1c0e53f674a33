use super::bandwidth::LowPass;
use super::faults::{Fault, Thresholds};
use super::window::Window;
use super::{Channel, Output, Status};

/// Normals that a channel needs for each sample: jitter and fault.
pub(crate) const DRAWS: usize = 2;

/// The readout of one instrument, prepared for a step length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chain {
    channel: Channel,
    low_pass: Option<LowPass>,
    faults: Thresholds,
    /// Least significant bits in a unit of the output, per axis.
    bits: [f64; 3],
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
        let bits = channel.lsb.map_or([0.0; 3], |lsb| lsb.size.map(|size| 1.0 / size));
        Chain { channel, low_pass: None, faults: Thresholds::new(&channel.faults), bits }
    }

    /// Prepares for steps of `dt` seconds.
    pub fn discretise(&mut self, dt: f64) {
        self.low_pass = self.channel.bandwidth.map(|b| LowPass::new(b, self.channel.sampling, dt));
    }

    /// Turns the mean input over a step with all its errors into the increment that is put out.
    #[inline]
    pub fn step(
        &self,
        state: &mut ChainState,
        dt: f64,
        mut mean: [f64; 3],
        [jitter, fault]: [f64; DRAWS],
        out: &mut [f64; 3],
    ) -> Status {
        let (c, first) = (&self.channel, !state.started);
        state.started = true;
        if let Some(low_pass) = &self.low_pass {
            for i in 0..3 {
                if first {
                    // Settled on its first input.
                    state.filter[i] = [mean[i], 0.0];
                }
                mean[i] = low_pass.step(&mut state.filter[i], mean[i]);
            }
        }
        let mut duration = dt;
        let mut x = [mean[0] * dt, mean[1] * dt, mean[2] * dt];
        if !c.timing.is_ideal() {
            (x, duration) = state.window.sample(&c.timing, dt, mean, jitter, first);
        }
        let mut status = Status::default();
        if let Some(range) = &c.range {
            for i in 0..3 {
                let (low, high) = (range[i].0 * duration, range[i].1 * duration);
                status.saturated[i] = x[i] < low || x[i] > high;
                x[i] = if x[i] < low { low } else { x[i] };
                x[i] = if x[i] > high { high } else { x[i] };
            }
        }
        if c.output == Output::Rates {
            // A device that puts out rates divides by the window that it believes in or has measured; over
            // an empty window it repeats itself.
            for i in 0..3 {
                x[i] = if duration > 0.0 { x[i] / duration } else { state.last[i] };
            }
        }
        if let Some(lsb) = &c.lsb {
            for i in 0..3 {
                let wanted = x[i] + if lsb.carry { state.remainder[i] } else { 0.0 };
                x[i] = round(wanted * self.bits[i]) * lsb.size[i];
                state.remainder[i] = wanted - x[i];
            }
        }
        let fault = self.faults.decide(fault);
        if state.stuck > 0 || fault != Fault::None {
            self.fail(state, fault, &mut x, &mut status);
        }
        if !status.dropped {
            state.last = x;
        }
        let scale = if c.output == Output::Rates { dt } else { 1.0 };
        (0..3).for_each(|i| out[i] = x[i] * scale);
        status
    }

    /// What a fault makes of the sample `x`.
    #[cold]
    fn fail(&self, state: &mut ChainState, fault: Fault, x: &mut [f64; 3], status: &mut Status) {
        match fault {
            _ if state.stuck > 0 => {
                state.stuck -= 1;
                (status.stuck, *x) = (true, state.last);
            }
            Fault::None => {}
            Fault::Drop => (status.dropped, *x) = (true, [0.0; 3]),
            Fault::Repeat => (status.repeated, *x) = (true, state.last),
            Fault::Stick => {
                state.stuck = self.channel.faults.stuck_samples.saturating_sub(1);
                (status.stuck, *x) = (true, state.last);
            }
        }
    }
}

/// The nearest integer, and the even one of two, without a branch: numbers from 2^52 on are integers, and
/// adding that number leaves no room for a fraction.
#[inline(always)]
fn round(x: f64) -> f64 {
    const INTEGERS: f64 = 4_503_599_627_370_496.0;
    let size = x.abs();
    if size < INTEGERS { ((size + INTEGERS) - INTEGERS).copysign(x) } else { x }
}
