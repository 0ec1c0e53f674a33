use core::f64::consts::TAU;

use fearless_simd::{Simd, f64x4};
use libm::{exp, sincos, sqrt};

use super::axes::{Axes, load, store};

/// A second-order low pass: x'' + 2 zeta w x' + w² x = w² u with w = 2 pi `natural_frequency`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bandwidth {
    /// Undamped natural frequency, Hz.
    pub natural_frequency: f64,
    /// Damping ratio; 0.7071 puts the -3 dB point at the natural frequency.
    pub damping: f64,
}

/// Whether a sample is a mean over its interval or the value at its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampling {
    /// Mean over the interval, exactly integrated.
    #[default]
    Mean,
    /// Value of the low pass at the end of the interval.
    Point,
}

/// Exact step of a low pass under an input that is constant over the step.
#[derive(Clone, Copy, Debug)]
pub(super) struct LowPass {
    phi: [[f64; 2]; 2],
    /// Interval mean of the deviation from the input, per change of (x, x').
    mean: [f64; 2],
    sampling: Sampling,
}

impl LowPass {
    pub fn new(b: Bandwidth, sampling: Sampling, dt: f64) -> LowPass {
        let (w, zeta) = (TAU * b.natural_frequency, b.damping);
        let (decay, split) = (zeta * w, w * sqrt((1.0 - zeta * zeta).abs()));
        // e^(-decay t) times cos and sin/split, or cosh and sinh/split, or their limits.
        let (c, s) = if zeta < 1.0 {
            let (e, (sin, cos)) = (exp(-decay * dt), sincos(split * dt));
            (e * cos, e * sin / split)
        } else if zeta > 1.0 {
            let (slow, fast) = (exp((split - decay) * dt), exp(-(split + decay) * dt));
            (0.5 * (slow + fast), 0.5 * (slow - fast) / split)
        } else {
            (exp(-decay * dt), dt * exp(-decay * dt))
        };
        LowPass {
            phi: [[c + decay * s, s], [-w * w * s, c - decay * s]],
            mean: [-2.0 * zeta / (w * dt), -1.0 / (w * w * dt)],
            sampling,
        }
    }

    /// Output of the axes over a step with input `u`; moves their states (x, x').
    #[inline(always)]
    pub fn step<S: Simd>(&self, simd: S, [x, v]: &mut [Axes; 2], u: f64x4<S>) -> f64x4<S> {
        let (now, rate) = (load(simd, x), load(simd, v));
        let (z, phi) = (now - u, &self.phi);
        let (z1, v1) = (z * phi[0][0] + rate * phi[0][1], z * phi[1][0] + rate * phi[1][1]);
        let mean = u + (z1 - z) * self.mean[0] + (v1 - rate) * self.mean[1];
        let end = u + z1;
        store(end, x);
        store(v1, v);
        match self.sampling {
            Sampling::Mean => mean,
            Sampling::Point => end,
        }
    }
}
