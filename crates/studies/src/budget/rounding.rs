//! Rounding of integrals (`quantization`): no process in continuous time, but a linear one from sample to sample.

use nalgebra::{Matrix3, SVector, Vector3};
use schuler_imu::{Component, Instrument, Spec, Truth as Seen};
use schuler_strapdown::Vertical;

use super::alignment;
use super::passage::{Drive, Sample, attitude};
use super::scene::Scene;
use super::source::{Joint, Nine};
use super::stepper::Step;

/// The first of its states, e at the end of the last sample; then e before.
const NOW: usize = 9;
const BEFORE: usize = 10;

/// The integral of a coefficient is delivered with an independent error e, of standard deviation q, at the end of each sample, so
/// that a sample k is wrong by e_k - e_(k-1). With g what a unit of that does to the nine errors,
///
/// ```text
/// x_k = Phi_k x_(k-1) + g_k (e_k - e_(k-1)):   e_(k-1) does in all (Phi_k g_(k-1) - g_k) to x_k
/// ```
///
/// which is small: what it leaves are tilts for a sample, and the velocity that comes of them.
pub struct Rounding {
    drive: Drive,
    q: f64,
}

/// An interval so far.
struct Gathered {
    phi: Nine,
    q: Nine,
    /// What the e before the interval does, and the last two within it.
    of_start: SVector<f64, 9>,
    before: SVector<f64, 9>,
    now: SVector<f64, 9>,
    samples: u64,
}

impl Rounding {
    /// e at the end of the last sample and of the one before.
    pub const STATES: usize = 2;

    /// Of the standard deviation `q` of one coefficient of the list `spec`.
    pub fn new(component: Component, q: f64, spec: &Spec) -> Rounding {
        Rounding { drive: Drive::of_truth(component, spec), q }
    }

    /// Second moment at t = 0, after the alignment where there is one: over its window the mean error is that of the last e
    /// and the first.
    pub fn start(&self, scene: &Scene) -> Joint {
        let square = self.q * self.q;
        let mut p = Joint::zeros();
        (p[(NOW, NOW)], p[(BEFORE, BEFORE)]) = (square, square);
        if scene.study.alignment > 0 {
            let (instrument, column) = self.drive.error(&scene.at_rest(scene.dt), scene.dt);
            let mean = (column / alignment::window(scene)).into();
            let phi = SVector::from(alignment::Law::new(scene).phi(instrument, mean));
            p.fixed_view_mut::<3, 3>(6, 6).copy_from(&(phi * phi.transpose() * (2.0 * square)));
            p.fixed_view_mut::<3, 1>(6, NOW).copy_from(&(phi * square));
            p.fixed_view_mut::<1, 3>(NOW, 6).copy_from(&(phi.transpose() * square));
        }
        p
    }

    /// Along a motion.
    pub fn along(&self, scene: &Scene, begin: u64, samples: &[Sample]) -> Step {
        let mut gathered = Gathered::new();
        for (k, sample) in samples.iter().enumerate() {
            let middle = scene.time(begin + k as u64) + 0.5 * scene.dt;
            let (phi, g) = self.sample(scene, middle, &sample.seen, &sample.mean());
            self.add(&mut gathered, &phi, &g);
        }
        self.end(&gathered)
    }

    /// At rest.
    pub fn at_rest(&self, scene: &Scene, count: u64) -> Step {
        let mut gathered = Gathered::new();
        let c = attitude(&scene.moment(0.0).0);
        let (phi, g) = self.sample(scene, 0.0, &scene.seen(0, 1), &c);
        (0..count).for_each(|_| self.add(&mut gathered, &phi, &g));
        self.end(&gathered)
    }

    /// A sample: transition of the nine errors, of second order, and what a unit of its e does.
    fn sample(&self, scene: &Scene, t: f64, seen: &Seen, c: &Matrix3<f64>) -> (Nine, SVector<f64, 9>) {
        let (pva, f_b) = scene.moment(t);
        let f = scene.dynamics().system(&pva, f_b).f * scene.dt;
        let (instrument, column) = self.drive.error(seen, scene.dt);
        let mut g = SVector::<f64, 9>::zeros();
        let w = c * column;
        match instrument {
            Instrument::Gyro => g.fixed_rows_mut::<3>(6).copy_from(&-w),
            Instrument::Accel => {
                let free = Vector3::new(1.0, 1.0, if scene.vertical == Vertical::Held { 0.0 } else { 1.0 });
                g.fixed_rows_mut::<3>(3).copy_from(&w.component_mul(&free));
            }
        }
        // It came over the sample, on average half of it ago.
        (Nine::identity() + f + f * f * 0.5, g + f * g * 0.5)
    }

    fn add(&self, gathered: &mut Gathered, phi: &Nine, g: &SVector<f64, 9>) {
        let before = phi * gathered.now - g;
        gathered.phi = phi * gathered.phi;
        gathered.of_start = phi * gathered.of_start;
        gathered.q = phi * gathered.q * phi.transpose();
        if gathered.samples == 0 {
            gathered.of_start -= g;
        } else {
            gathered.q += before * before.transpose() * (self.q * self.q);
        }
        (gathered.before, gathered.now) = (before, *g);
        gathered.samples += 1;
    }

    fn end(&self, gathered: &Gathered) -> Step {
        let square = self.q * self.q;
        let (mut phi, mut q) = (Joint::identity(), Joint::zeros());
        phi.fixed_view_mut::<9, 9>(0, 0).copy_from(&gathered.phi);
        phi.fixed_view_mut::<9, 1>(0, NOW).copy_from(&gathered.of_start);
        (phi[(NOW, NOW)], phi[(BEFORE, BEFORE)]) = (0.0, 0.0);
        let now = gathered.now * square;
        q.fixed_view_mut::<9, 9>(0, 0).copy_from(&(gathered.q + now * gathered.now.transpose()));
        let mut fresh = |state: usize, with: SVector<f64, 9>| {
            q[(state, state)] = square;
            q.fixed_view_mut::<9, 1>(0, state).copy_from(&with);
            q.fixed_view_mut::<1, 9>(state, 0).copy_from(&with.transpose());
        };
        fresh(NOW, now);
        if gathered.samples > 1 {
            fresh(BEFORE, gathered.before * square);
        } else {
            phi[(BEFORE, NOW)] = 1.0;
        }
        Step::Rounded(Box::new([phi, q]))
    }

    /// Error of the gyro along body axes in the last sample by a unit of a state.
    pub fn gyro(&self, state: usize, seen: &Seen, dt: f64) -> [f64; 3] {
        match self.drive.error(seen, dt) {
            (Instrument::Gyro, column) if state == NOW => (column / dt).into(),
            (Instrument::Gyro, column) => (-column / dt).into(),
            (Instrument::Accel, _) => [0.0; 3],
        }
    }
}

impl Gathered {
    fn new() -> Gathered {
        let none = SVector::zeros();
        let (phi, q) = (Nine::identity(), Nine::zeros());
        Gathered { phi, q, of_start: none, before: none, now: none, samples: 0 }
    }
}
