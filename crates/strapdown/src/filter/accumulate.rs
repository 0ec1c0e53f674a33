//! Transition and process noise gathered over several IMU steps.

use fearless_simd::{Level, dispatch};
use nalgebra::{Matrix3, Vector3};
use schuler_imu::{Instrument, Truth};

use super::block::Block;
use super::body::Body;
use super::gather::{Columns, gather};
use super::propagation::SourceStates;
use super::small_process::SmallStep;
use super::waiting::{STEPS, Waiting, middles};
use super::{Model, Propagation};
use crate::{ErrorDynamics, Increments, Pva};

/// Gathers what the transition over an interval needs, IMU step by IMU step, for a fraction of the cost of a time update.
///
/// In the error dynamics, three things are fast: attitude, specific force and sensor axes turn with the body,
///
/// ```text
/// dr' = dv,   dv' = f_t × phi + C nabla,   phi' = -C eps
/// ```
///
/// and these are nilpotent: their transition is a set of plain sums over the steps, in the order of time (the same sums as
/// in the preintegration of IMU samples). All else, S (Earth and transport rate, Coriolis, gravity gradient, metric,
/// damping), is slow and taken in the middle of the interval, with its slope as the velocity changes:
///
/// ```text
/// Phi = F(T, 0) + ∫ F(T, t) S(t) F(t, 0) dt + the terms with two S,   F the fast part
/// ```
///
/// What is left out grows with T² and does not add up to much: after 20 steps of 10 ms at a time, standard deviations differ
/// from those of the product over the steps by 4e-10 at most after 21 s of cruise, of a turn of 1.3 g or of shaking, by 1e-9
/// after a minute.
///
/// Source states that fade slowly (in 50 s or more) are taken as a line over the interval, which asks for sums over C and f
/// alone, however many they are; beside one that fades faster all are followed through the steps.
///
/// Intervals of up to a second are meant; for constant dynamics over longer ones there is [`Propagation::exact`].
#[derive(Clone, Debug)]
pub struct Accumulator<const N: usize> {
    pub(super) dynamics: ErrorDynamics,
    pub(super) start: Pva,
    pub(super) end: Pva,
    /// The last steps, not yet gathered.
    waiting: Waiting,
    /// Length so far.
    pub(super) t: f64,
    /// What the body has done.
    pub(super) body: Body,
    /// Integrals of the densities of white noise in t, gyro and accelerometer, where they depend on the attitude.
    pub(super) white: [Matrix3<f64>; 2],
    /// White densities that are the same along all axes and whatever the input.
    pub(super) isotropic: [Option<f64>; 2],
    /// Source states, from the first of them on.
    pub(super) columns: Columns<N>,
    /// Direction in t in which each source state has entered, integrated, where that depends on the input; else zero.
    pub(super) way: [[f64; N]; 3],
    /// The same times the time since the start of the interval.
    pub(super) way_by_time: [[f64; N]; 3],
    /// Coefficient of its block that a unit of each state at the start makes now; not kept for blocks that the kernel fades.
    weight: [f64; N],
    /// What each state pushes in the first step.
    push_at_start: [[f64; N]; 3],
    /// Columns of blocks that change with the input, blocks of two states, white noise that is not the same on all axes:
    /// whether there are any. Steps are then gathered one by one.
    pub(super) special: bool,
    /// Whether there are source states that fade so fast or are so special that they are followed through the steps; else
    /// what the body does says all.
    pub(super) followed: bool,
    /// A source state over the interval as `a + b t`, as it enters.
    pub(super) over: [[f64; N]; 2],
    /// Column of each source state where that is always the same.
    pub(super) enters: [[f64; N]; 3],
    /// Covariance of each source state, over one interval, with those integrals of its coefficient that enter position,
    /// velocity and attitude.
    pub(super) with_integrals: [[f64; N]; 3],
    /// Source states by themselves over one interval, and the runs of driven ones that behave the same.
    pub(super) sources: SourceStates<N>,
    pub(super) runs: [Option<Run>; N],
    /// Each block over one step, and over one interval, of the lengths that came last.
    of_step: [Option<SmallStep>; N],
    dt: f64,
    pub(super) of_interval: [Option<SmallStep>; N],
    pub(super) interval: f64,
    pub(super) level: Level,
}

/// Source states with this correlation time (s) or a longer one are a straight line over an interval of up to a second.
const SLOW: f64 = 50.0;

impl<const N: usize> Accumulator<N> {
    /// An interval that begins with the navigator at `pva`.
    pub fn new(model: &Model<N>, dynamics: ErrorDynamics, pva: &Pva) -> Self {
        let driving = || model.blocks().filter(|b| b.instrument().is_some());
        let is_special = driving().any(|b| b.len == 2 || b.column.is_none());
        let mut new = Accumulator {
            dynamics,
            start: *pva,
            end: *pva,
            waiting: Waiting::new(pva.c_tb.as_quaternion()),
            t: 0.0,
            body: Body::NONE,
            white: [Matrix3::zeros(); 2],
            isotropic: Instrument::ALL.map(|instrument| model.isotropic(instrument)),
            columns: Columns::NONE,
            way: [[0.0; N]; 3],
            way_by_time: [[0.0; N]; 3],
            weight: [0.0; N],
            push_at_start: [[0.0; N]; 3],
            special: is_special || Instrument::ALL.iter().any(|i| model.isotropic(*i).is_none()),
            followed: is_special || driving().any(|b| b.a[0][0].abs() * SLOW > 1.0),
            over: [[0.0; N]; 2],
            enters: [[0.0; N]; 3],
            with_integrals: [[0.0; N]; 3],
            sources: SourceStates::identity(model),
            runs: [None; N],
            of_step: [None; N],
            dt: 0.0,
            of_interval: [None; N],
            interval: 0.0,
            level: schuler_imu::random::best_level(),
        };
        let first = model.nav_len();
        for block in model.blocks() {
            for s in block.states() {
                new.columns.gyro[s - first] =
                    if block.instrument() == Some(Instrument::Gyro) { 1.0 } else { 0.0 };
                if let (Some(column), Some(_)) = (block.column, block.instrument()) {
                    for axis in 0..3 {
                        new.enters[axis][s - first] = column[axis];
                    }
                }
            }
        }
        new.begin(model, pva);
        new
    }

    /// Begins anew with the navigator at `pva`: after a correction of it.
    pub fn begin(&mut self, model: &Model<N>, pva: &Pva) {
        (self.start, self.end) = (*pva, *pva);
        self.waiting.begin(pva.c_tb.as_quaternion());
        self.t = 0.0;
        self.body = Body::NONE;
        if self.followed {
            self.columns.begin(&self.push_at_start);
        }
        if self.special {
            self.white = [Matrix3::zeros(); 2];
            (self.way, self.way_by_time) = ([[0.0; N]; 3], [[0.0; N]; 3]);
            for block in model.blocks() {
                for (k, s) in block.states().enumerate() {
                    self.weight[s] = block.c[k];
                }
            }
        }
    }

    /// Sets what the states of `block` push in this step.
    #[inline]
    fn set_push(&mut self, block: &Block, first: usize, column: [f64; 3], step: &SmallStep) {
        let mean = carried(block, &self.weight, &step.average);
        for (s, mean) in block.states().zip(mean) {
            for axis in 0..3 {
                self.columns.push[axis][s - first] = column[axis] * mean;
            }
        }
    }

    /// Length of the interval so far, s.
    pub fn elapsed(&self) -> f64 {
        self.t
    }

    /// One IMU step of `dt` (s), after which the navigator is at `pva`. `increments` are what it was fed with.
    #[inline]
    pub fn step(&mut self, model: &Model<N>, pva: &Pva, increments: &Increments, dt: f64) {
        self.advance(model, pva, None, increments, dt);
    }

    /// As [`Accumulator::step`] where thermal and other terms need to know what else the sensors have `seen`.
    pub fn step_seen(&mut self, model: &Model<N>, pva: &Pva, seen: &Truth, increments: &Increments, dt: f64) {
        self.advance(model, pva, Some(seen), increments, dt);
    }

    #[inline]
    fn advance(
        &mut self,
        model: &Model<N>,
        pva: &Pva,
        seen: Option<&Truth>,
        increments: &Increments,
        dt: f64,
    ) {
        // A clock that jitters by a millionth fades nothing by another amount.
        if (dt - self.dt).abs() > 1e-6 * dt {
            self.gather(model);
            self.fit_to(model, dt);
        }
        self.end = *pva;
        self.t += dt;
        self.waiting.push(pva.c_tb.as_quaternion(), increments.dv.as_array(), dt);
        if self.special {
            self.specials(model, seen, increments, dt);
        } else if self.waiting.count == STEPS {
            self.gather(model);
        }
    }

    /// Gathers the steps that wait.
    fn gather(&mut self, model: &Model<N>) {
        let (level, sources) = (self.level, model.len() - model.nav_len());
        let (waiting, columns, body) = (&mut self.waiting, &mut self.columns, &mut self.body);
        let sources = if self.followed { sources } else { 0 };
        dispatch!(level, simd => {
            middles(simd, waiting);
            body.add(simd, waiting);
            gather(simd, columns, waiting, sources);
        });
        self.waiting.done();
    }

    /// Makes ready for steps of another length.
    #[cold]
    fn fit_to(&mut self, model: &Model<N>, dt: f64) {
        self.dt = dt;
        let first = model.nav_len();
        for (number, block) in model.blocks().enumerate() {
            let step = SmallStep::new(block, dt);
            for (k, s) in block.states().enumerate() {
                self.columns.decay[s - first] = if block.len == 1 { step.phi[0][0] } else { 1.0 };
                self.weight[s] = block.c[k];
            }
            if let Some(column) = block.column {
                self.set_push(block, first, column, &step);
                for s in block.states() {
                    for axis in 0..3 {
                        self.push_at_start[axis][s - first] = self.columns.push[axis][s - first];
                    }
                }
            }
            if self.t > 0.0 {
                // In the middle of an interval: the weights are what they have become.
                let next = carried(block, &self.weight, &SmallStep::new(block, self.t).phi);
                for (s, next) in block.states().zip(next) {
                    self.weight[s] = next;
                }
                if let Some(column) = block.column {
                    self.set_push(block, first, column, &step);
                }
            }
            self.of_step[number] = Some(step);
        }
    }

    /// A step, which waits alone, where something depends on the input or on the attitude by itself: columns, and white noise
    /// that is not the same on all axes.
    #[inline(never)]
    fn specials(&mut self, model: &Model<N>, seen: Option<&Truth>, increments: &Increments, dt: f64) {
        let seen = seen
            .copied()
            .unwrap_or_else(|| Truth::increments(increments.dtheta.as_array(), increments.dv.as_array()));
        let inputs = model.inputs(&seen, dt);
        let (level, waiting) = (self.level, &mut self.waiting);
        dispatch!(level, simd => middles(simd, waiting));
        let c_dt = Matrix3::from_fn(|i, j| 2.0 * self.waiting.half[i][0][j]);
        for (k, instrument) in Instrument::ALL.into_iter().enumerate() {
            if self.isotropic[k].is_none() {
                self.white[k] += c_dt * model.white(instrument, &inputs) * c_dt.transpose() * (1.0 / dt);
            }
        }
        for (number, block) in model.blocks().enumerate().filter(|(_, b)| b.column.is_none()) {
            let column = block.column(&inputs);
            let direction = c_dt * Vector3::from(column);
            for s in block.states().map(|s| s - model.nav_len()) {
                for axis in 0..3 {
                    self.way[axis][s] += direction[axis];
                    self.way_by_time[axis][s] += direction[axis] * (self.t - 0.5 * dt);
                }
            }
            if let Some(step) = self.of_step[number] {
                self.set_push(block, model.nav_len(), column, &step);
            }
        }
        self.gather(model);
        self.fade_pairs(model, model.nav_len());
    }

    /// The weights after a step, of blocks that the kernel does not fade.
    fn fade_pairs(&mut self, model: &Model<N>, first: usize) {
        for (number, block) in model.blocks().enumerate().filter(|(_, b)| b.len == 2 || b.column.is_none()) {
            let Some(step) = self.of_step[number] else { continue };
            let next = carried(block, &self.weight, &step.phi);
            for (s, next) in block.states().zip(next) {
                self.weight[s] = next;
            }
            if let (2, Some(column)) = (block.len, block.column) {
                self.set_push(block, first, column, &step);
            }
        }
    }

    /// Ends the interval: its transition and process noise. The next one begins where this one ends.
    pub fn close(&mut self, model: &Model<N>) -> Propagation<N> {
        let mut out = Propagation::identity(model);
        self.close_into(model, &mut out);
        out
    }

    /// As [`Accumulator::close`], into a propagation that was made for the same model.
    pub fn close_into(&mut self, model: &Model<N>, out: &mut Propagation<N>) {
        if self.t > 0.0 {
            self.gather(model);
            if (self.t - self.interval).abs() > 1e-12 * self.t {
                self.fit_interval(model);
            }
            self.finish(model, out);
        } else {
            *out = Propagation::identity(model);
        }
        let end = self.end;
        self.begin(model, &end);
    }
}

impl<const N: usize> Accumulator<N> {
    /// Makes ready for intervals of another length.
    #[cold]
    fn fit_interval(&mut self, model: &Model<N>) {
        self.interval = self.t;
        let first = model.nav_len();
        self.runs = [None; N];
        let (mut count, mut before) = (0, None);
        for (number, block) in model.blocks().enumerate() {
            let step = SmallStep::new(block, self.t);
            for (k, s) in block.states().enumerate() {
                for l in 0..block.len {
                    self.sources.set(s, l, block.len == 2, step.phi[k][l], step.q[(3 + k, 3 + l)]);
                }
            }
            if block.len == 1 {
                let [_, z2, z1] = step.integrals;
                let b = (z1 * self.t - 2.0 * z2) * 6.0 / (self.t * self.t * self.t);
                self.over[0][block.first - first] = z1 / self.t - 0.5 * b * self.t;
                self.over[1][block.first - first] = b;
            }
            if let (Some(instrument), true) = (block.instrument(), block.is_driven()) {
                let z = match instrument {
                    Instrument::Gyro => [0, 1, 2],
                    Instrument::Accel => [1, 2, 2],
                };
                for (k, s) in block.states().enumerate() {
                    for (kind, z) in z.into_iter().enumerate() {
                        self.with_integrals[kind][s - first] = step.q[(z, 3 + k)];
                    }
                }
                let start = block.first - first;
                let now = (instrument, block.len, step.q.fixed_view::<3, 3>(0, 0).into_owned());
                match self.runs[..count].last_mut() {
                    Some(Some(run)) if before == Some(now) && run.end == start => run.end += block.len,
                    _ => {
                        let end = start + block.len;
                        self.runs[count] =
                            Some(Run { instrument, number, first: start, end, len: block.len });
                        count += 1;
                    }
                }
                before = Some(now);
            }
            self.of_interval[number] = Some(step);
        }
    }
}

/// Driven blocks of one instrument, side by side, that behave as the one of that `number`: their source states.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    pub instrument: Instrument,
    pub number: usize,
    pub first: usize,
    pub end: usize,
    /// States of each block.
    pub len: usize,
}

/// The row of weights of a block times a matrix of it.
#[inline]
fn carried<const N: usize>(block: &Block, weight: &[f64; N], m: &[[f64; 2]; 2]) -> [f64; 2] {
    let w = |k: usize| if k < block.len { weight[block.first + k] } else { 0.0 };
    [w(0) * m[0][0] + w(1) * m[1][0], w(0) * m[0][1] + w(1) * m[1][1]]
}
