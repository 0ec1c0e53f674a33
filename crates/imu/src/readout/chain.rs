use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4};

use super::axes::{Axes, axes, load, round, store};
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
    bits: Axes,
    /// One such bit, and the range, per axis.
    size: Axes,
    low: Axes,
    high: Axes,
}

/// What changes in a readout from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ChainState {
    started: bool,
    filter: [Axes; 2],
    window: Window,
    remainder: Axes,
    last: Axes,
    stuck: u32,
}

impl ChainState {
    pub const START: ChainState = ChainState {
        started: false,
        filter: [[0.0; 4]; 2],
        window: Window::START,
        remainder: [0.0; 4],
        last: [0.0; 4],
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
        for i in 0..3 {
            self.filter.iter_mut().for_each(|of| each(&mut of[i]));
        }
        self.remainder[..3].iter_mut().for_each(&mut each);
        self.last[..3].iter_mut().for_each(&mut each);
        self.window.visit(&mut each);
    }
}

impl Chain {
    pub fn new(channel: Channel) -> Chain {
        let size = axes(channel.lsb.map_or([0.0; 3], |lsb| lsb.size));
        let range = channel.range.unwrap_or_default();
        Chain {
            channel,
            low_pass: None,
            faults: Thresholds::new(&channel.faults),
            bits: size.map(|size| if size == 0.0 { 0.0 } else { 1.0 / size }),
            size,
            low: axes(range.map(|r| r.0)),
            high: axes(range.map(|r| r.1)),
        }
    }

    /// Prepares for steps of `dt` seconds.
    pub fn discretise(&mut self, dt: f64) {
        self.low_pass = self.channel.bandwidth.map(|b| LowPass::new(b, self.channel.sampling, dt));
    }

    /// Turns the mean input over a step with all its errors into the increment that is put out, the axes in lanes.
    #[inline(always)]
    pub fn step<S: Simd>(
        &self,
        state: &mut ChainState,
        dt: f64,
        mut mean: f64x4<S>,
        [jitter, fault]: [f64; DRAWS],
    ) -> (f64x4<S>, Status) {
        let (c, simd, first) = (&self.channel, mean.simd, !state.started);
        state.started = true;
        if let Some(low_pass) = &self.low_pass {
            if first {
                // Settled on its first input.
                state.filter = [*mean, [0.0; 4]];
            }
            mean = low_pass.step(simd, &mut state.filter, mean);
        }
        let mut duration = dt;
        let mut x = mean * dt;
        if !c.timing.is_ideal() {
            (x, duration) = state.window.sample(&c.timing, dt, mean, jitter, first);
        }
        let mut status = Status::default();
        if c.range.is_some() {
            let (low, high) = (load(simd, &self.low) * duration, load(simd, &self.high) * duration);
            let (below, above) = (x.simd_lt(low), x.simd_gt(high));
            let beyond = (below | above).to_bitmask();
            for (i, saturated) in status.saturated.iter_mut().enumerate() {
                *saturated = beyond >> i & 1 == 1;
            }
            x = above.select(high, below.select(low, x));
        }
        if c.output == Output::Rates {
            // A device that puts out rates divides by the window that it believes in or has measured; over
            // an empty window it repeats itself.
            x = if duration > 0.0 { x / duration } else { load(simd, &state.last) };
        }
        if let Some(lsb) = &c.lsb {
            let wanted = if lsb.carry { x + load(simd, &state.remainder) } else { x + 0.0 };
            x = round(wanted * load(simd, &self.bits)) * load(simd, &self.size);
            store(wanted - x, &mut state.remainder);
        }
        let fault = self.faults.decide(fault);
        if state.stuck > 0 || fault != Fault::None {
            let mut failed = *x;
            self.fail(state, fault, &mut failed, &mut status);
            x = load(simd, &failed);
        }
        if !status.dropped {
            store(x, &mut state.last);
        }
        (if c.output == Output::Rates { x * dt } else { x }, status)
    }

    /// What a fault makes of the sample `x`.
    #[cold]
    fn fail(&self, state: &mut ChainState, fault: Fault, x: &mut Axes, status: &mut Status) {
        match fault {
            _ if state.stuck > 0 => {
                state.stuck -= 1;
                (status.stuck, *x) = (true, state.last);
            }
            Fault::None => {}
            Fault::Drop => (status.dropped, *x) = (true, [0.0; 4]),
            Fault::Repeat => (status.repeated, *x) = (true, state.last),
            Fault::Stick => {
                state.stuck = self.channel.faults.stuck_samples.saturating_sub(1);
                (status.stuck, *x) = (true, state.last);
            }
        }
    }
}
