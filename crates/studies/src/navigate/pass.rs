//! One pass over a log: averages, attitude, navigation.

use schuler_frames::{B, Geodetic, Gravity, I, Rate, Rot, T, Vec3};
use schuler_strapdown::align::triad;
use schuler_strapdown::{Pva, Vertical};

use crate::{log::LogSample, navigator::Navigator, scenario::Mechanization};

/// What is done, in samples of the log.
pub struct Plan {
    /// Where the log was recorded.
    pub position: Geodetic,
    pub gravity: Gravity,
    pub mechanization: Mechanization,
    pub vertical: Vertical,
    /// Sample interval, s.
    pub dt: f64,
    /// The window: samples after the first number up to and with the second.
    pub window: [u64; 2],
    /// Last sample that is navigated, where not all are.
    pub last: Option<u64>,
    /// A row every so many samples, counted from the end of the window.
    pub stride: u64,
}

/// Sums of increments.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mean {
    pub count: u64,
    dtheta: Vec3<B>,
    dv: Vec3<B>,
}

impl Mean {
    pub fn add(&mut self, sample: &LogSample) {
        self.count += 1;
        self.dtheta += sample.increments.dtheta;
        self.dv += sample.increments.dv;
    }

    /// Mean angular rate omega_ib^b, rad/s.
    pub fn omega_b(&self, dt: f64) -> Vec3<B> {
        self.dtheta * (1.0 / (self.count as f64 * dt))
    }

    /// Mean specific force f^b, m/s².
    pub fn f_b(&self, dt: f64) -> Vec3<B> {
        self.dv * (1.0 / (self.count as f64 * dt))
    }
}

/// What the log showed so far.
pub struct Pass<'a> {
    plan: &'a Plan,
    pub whole: Mean,
    pub window: Mean,
    navigator: Option<Navigator>,
    rows: Vec<(f64, Pva)>,
    /// Samples in an update.
    update: u64,
}

/// The aligned attitude and the rows navigated from it.
pub struct Outcome {
    /// Attitude at the end of the window.
    pub c_tb: Rot<T, B>,
    /// Time from the start of the log (s), and state. The first row is the end of the window.
    pub rows: Vec<(f64, Pva)>,
}

/// Why a window gives no attitude.
#[derive(Debug)]
pub struct NoAttitude {
    pub problem: String,
    pub expected: String,
    pub found: String,
}

/// Difference between mean specific force and gravity, relative, beyond which the numbers cannot be those of a
/// vehicle at rest: a wrong scale or a wrong column, not a sensor error.
const FORCE_TOLERANCE: f64 = 0.1;

/// Attitude at rest from the averages of a window of samples of `dt` (s): TRIAD, specific force first.
pub fn attitude(
    window: &Mean,
    dt: f64,
    position: Geodetic,
    gravity: Gravity,
) -> Result<Rot<T, B>, NoAttitude> {
    let f_b = window.f_b(dt);
    let g = gravity.gravity_t(position).norm();
    if (f_b.norm() - g).abs() > FORCE_TOLERANCE * g {
        return Err(NoAttitude {
            problem: "the mean specific force is not that of a vehicle at rest".into(),
            expected: format!("about {g:.4} m/s², gravity at the start"),
            found: format!("{:.6} m/s²", f_b.norm()),
        });
    }
    let omega = Rate::<B, I, B>::claim(window.omega_b(dt));
    triad(f_b, omega, position, gravity).map_err(|e| NoAttitude {
        problem: e.to_string(),
        expected: "an angular rate of about 15 deg/h that has a horizontal part".into(),
        found: format!("{:?} rad/s along body axes", omega.as_vec3().as_array()),
    })
}

impl<'a> Pass<'a> {
    pub fn new(plan: &'a Plan) -> Self {
        Pass {
            plan,
            whole: Mean::default(),
            window: Mean::default(),
            navigator: None,
            rows: Vec::new(),
            update: plan.mechanization.coning.samples() as u64,
        }
    }

    /// The next sample of the log.
    pub fn sample(&mut self, sample: &LogSample) -> Result<(), NoAttitude> {
        self.whole.add(sample);
        let (plan, k) = (self.plan, self.whole.count);
        let [begin, end] = plan.window;
        if k <= end {
            if k > begin {
                self.window.add(sample);
            }
            if k == end {
                let pva = Pva {
                    position: plan.position,
                    v_t: Vec3::ZERO,
                    c_tb: attitude(&self.window, plan.dt, plan.position, plan.gravity)?,
                };
                self.navigator = Some(Navigator::new(&pva, &plan.mechanization, plan.vertical, plan.dt));
                self.rows.push((k as f64 * plan.dt, pva));
            }
        } else if plan.last.is_none_or(|last| k <= last)
            && let Some(navigator) = &mut self.navigator
        {
            navigator.step(&sample.increments);
            if (k - end).is_multiple_of(plan.stride) || plan.last == Some(k) {
                self.rows.push((k as f64 * plan.dt, navigator.pva()));
            }
        }
        Ok(())
    }

    /// The rows, if the log went beyond its window; the last whole update is always one of them.
    pub fn finish(&mut self) -> Option<Outcome> {
        let navigator = self.navigator.as_ref()?;
        let last = self.plan.last.map_or(self.whole.count, |last| last.min(self.whole.count));
        let end = self.plan.window[1];
        let last = last - (last - end) % self.update;
        let t = last as f64 * self.plan.dt;
        if self.rows.last().is_some_and(|row| row.0 < t) {
            self.rows.push((t, navigator.pva()));
        }
        let rows = std::mem::take(&mut self.rows);
        Some(Outcome { c_tb: rows.first()?.1.c_tb, rows })
    }
}
