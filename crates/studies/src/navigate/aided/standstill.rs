//! A standstill, told from the IMU alone.

use std::collections::VecDeque;

use schuler_frames::{B, Vec3};

use crate::scenario::Detect;

/// What of the mean of the ratio belongs to each of the two instruments: three axes.
const AXES: f64 = 3.0;

/// The samples of a window and what they say.
///
/// With specific force f_k and angular rate omega_k (that of the Earth and the errors known taken out) of W samples, and the mean
/// force f, the generalized likelihood ratio of a standstill under white noise is (Skog, Händel, Nilsson, Rantakokko, IEEE Trans.
/// Biomed. Eng. 57, 2010)
///
/// ```text
/// T = 1/W Σ ( |f_k - g f/|f||² / sigma_a² + |omega_k|² / sigma_w² )
/// ```
///
/// whose mean is 6 - 2/W where the noise is as stated; it grows with every force beyond gravity and every turn.
#[derive(Clone, Debug)]
pub struct Standstill {
    detect: Detect,
    samples: VecDeque<(Vec3<B>, Vec3<B>)>,
}

impl Standstill {
    pub fn new(detect: Detect) -> Self {
        Standstill { detect, samples: VecDeque::with_capacity(detect.window) }
    }

    /// A sample: angular rate omega_eb^b (rad/s) and specific force (m/s²).
    #[inline]
    pub fn push(&mut self, omega: Vec3<B>, f: Vec3<B>) {
        if self.samples.len() == self.detect.window {
            self.samples.pop_front();
        }
        self.samples.push_back((omega, f));
    }

    /// Whether the window is full and shows a standstill where gravity is `g` (m/s²), and `speed` (m/s) does not speak against it.
    pub fn holds(&self, g: f64, speed: f64) -> bool {
        let slow = self.detect.speed.is_none_or(|limit| speed < limit);
        slow && self.ratio(g).is_some_and(|ratio| ratio < self.detect.threshold)
    }

    /// T/6, `None` until the window is full.
    pub fn ratio(&self, g: f64) -> Option<f64> {
        let count = self.samples.len();
        if count < self.detect.window {
            return None;
        }
        let sum = self.samples.iter().fold(Vec3::<B>::ZERO, |sum, (_, f)| sum + *f);
        let down = sum * (g / sum.norm());
        let square = |v: Vec3<B>| v.dot(v);
        let (mut forces, mut turns) = (0.0, 0.0);
        for (omega, f) in &self.samples {
            forces += square(*f - down);
            turns += square(*omega);
        }
        let Detect { gyro, accel, .. } = self.detect;
        let t = forces / (accel * accel) + turns / (gyro * gyro);
        Some(t / (2.0 * AXES * count as f64))
    }
}

#[cfg(test)]
mod tests {
    use schuler_imu::{Stream, random::Draws};

    use super::*;

    const DETECT: Detect = Detect { window: 50, gyro: 2e-3, accel: 0.03, threshold: 2.0, speed: Some(3.0) };
    const G: f64 = 9.81;

    /// The ratio of white noise of the deviations stated times `times`, tilted, turning at `turn` and pushed by `push`.
    fn ratio(seed: u64, times: f64, turn: f64, push: f64) -> f64 {
        let draws = Draws::new(Stream { seed, run: 0 }, &"standstill");
        let mut standstill = Standstill::new(DETECT);
        for k in 0..DETECT.window as u64 {
            assert_eq!(standstill.ratio(G), None);
            let [a, b] = [0, 1].map(|half| {
                let [x, y, z, ..] = draws.normals(2 * k + half);
                Vec3::<B>::new(x, y, z)
            });
            let down = Vec3::new(0.3 * G, -0.1 * G, -(1.0f64 - 0.1).sqrt() * G);
            standstill.push(
                a * (times * DETECT.gyro) + Vec3::new(0.0, 0.0, turn),
                b * (times * DETECT.accel) + down * (1.0 + push / G),
            );
        }
        standstill.ratio(G).unwrap()
    }

    /// 300 - 2 squares of standard normals, divided by 300: the mean of 40 windows is 1 - 2/300 with deviation
    /// sqrt(2/298/40) = 0.013.
    #[test]
    fn noise_as_stated_gives_one() {
        let mean = (0..40).map(|seed| ratio(seed, 1.0, 0.0, 0.0)).sum::<f64>() / 40.0;
        assert!((mean - (1.0 - 2.0 / 300.0)).abs() < 4.0 * 0.013, "{mean}");
        let more = (0..40).map(|seed| ratio(seed, 3.0, 0.0, 0.0)).sum::<f64>() / 40.0;
        assert!((more / mean - 9.0).abs() < 1e-3, "{}", more / mean);
    }

    /// A turn adds (omega/sigma)²/6, a force along gravity (a/sigma)²/6.
    #[test]
    fn motion_adds_its_energy() {
        let turn = ratio(1, 1e-6, 0.01, 0.0);
        assert!((turn - (0.01f64 / DETECT.gyro).powi(2) / 6.0).abs() < 1e-4, "{turn}");
        let push = ratio(1, 1e-6, 0.0, 0.1);
        assert!((push - (0.1 / DETECT.accel).powi(2) / 6.0).abs() < 1e-4, "{push}");
    }

    #[test]
    fn speed_speaks_against_it() {
        let mut standstill = Standstill::new(DETECT);
        for _ in 0..DETECT.window {
            standstill.push(Vec3::ZERO, Vec3::new(0.0, 0.0, -G));
        }
        assert!(standstill.holds(G, 2.9) && !standstill.holds(G, 3.1));
    }
}
