//! Budgets with a filter running.

use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use schuler_imu::{Instrument, Spec};
use schuler_strapdown::filter::{
    Accumulator, Dual, Filter, Form, Model, NavStates, Now, Propagation, Velocity,
};

use super::super::aided::nominal::{Nominal, Passed};
use super::super::passage::samples;
use super::super::scene::Scene;
use super::super::source::{Kind, sources};
use super::super::{TOTAL, Way, linear, monte_carlo, report};
use super::*;
use crate::scenario::{Aid, Aiding, BudgetFilter, MeasuredKind};
use schuler_frames::Vec3;
use schuler_strapdown::filter::measurement::{HORIZONTAL, Measurement};

fn aid(stride: u64, sigma: f64) -> Aid {
    Aid { stride, sigma: [sigma; 3], lever_arm: [0.0; 3], outages: Vec::new(), phase: 0.0, offset: 0.0 }
}

/// Ten minutes at rest with zero velocity; the filter is as the truth.
fn at_rest(spec: Spec) -> Budget {
    at_rest_with(spec, 1.0, 600.0)
}

/// The same at `rate` (Hz) for a time (s), every sample a measurement, of the same density.
fn at_rest_with(spec: Spec, rate: f64, duration: f64) -> Budget {
    let mut initial = initial(20.0);
    initial.truncate(5);
    let aiding = Aiding { velocity: Some(aid(1, 0.01 * rate.sqrt())), ..Aiding::default() };
    let mut sigma = [0.0; 9];
    for i in &initial {
        for (all, one) in sigma.iter_mut().zip([i.position, i.velocity, i.phi].as_flattened()) {
            *all += one;
        }
    }
    let filter = BudgetFilter { spec: spec.clone(), sigma, believed: aiding.clone(), aiding };
    Budget { filter: Some(filter), ..budget(45.0, rate, duration, spec, initial) }
}

fn few() -> Spec {
    use Instrument::{Accel, Gyro};
    Spec::from_sources([
        source(Gyro, "bias", "constant", "sigma", (0.01 * DEG_PER_HOUR).into()),
        source(Gyro, "bias", "white", "density", (0.003 * PI / 180.0 / 60.0).into()),
        source(Accel, "bias", "constant", "sigma", (50.0 * UG).into()),
        source(Accel, "bias", "white", "density", (10.0 * UG).into()),
    ])
    .unwrap()
}

/// Where the filter believes what is true, the rows sum to its own covariance, but for what its transitions leave out of an
/// interval of a second (two Schuler rates, 1.5e-6), which at 45 deg after ten minutes is 4.142 arcmin of heading (tests/data/static_theory/align_kf_cov.csv, 4.152 from a heading
/// that is not known at all).
#[test]
fn rows_of_a_right_filter_sum_to_its_own_covariance() {
    let study = at_rest(few());
    let scene = Scene::new(&study, Some(60.0));
    let all = linear(&scene, &sources(&study)).unwrap();
    let (total, own) = (said(&all, TOTAL, Way::Covariance), said(&all, TOTAL, Way::Sigma));
    assert!(apart(total, own) < 2e-5, "{:e}", apart(total, own));
    let heading = report::sigma(total.last().unwrap(), 8) / ARCMIN;
    assert!((heading - 4.148).abs() < 0.008, "{heading}");
    // Responses of constants through the gains are the same by another way.
    let mut compared = 0;
    for c in &all {
        if let Some(columns) = c.of(Way::Columns) {
            let x = apart(columns, c.of(Way::Covariance).unwrap());
            // Positions of micrometres, which nothing measures, agree to a tenth of that.
            assert!(x < 1e-3, "{}: {x:e}", c.name);
            compared += 1;
        }
    }
    assert_eq!(compared, 11);
}

/// What the transitions of a filter leave out falls with the square of the time between measurements: at 50 Hz nothing is left.
#[test]
fn rows_of_a_right_filter_sum_to_its_own_covariance_the_better_the_more_often_it_measures() {
    let [coarse, fine] = [10.0, 50.0].map(|rate| {
        let study = at_rest_with(few(), rate, 60.0);
        let all = linear(&Scene::new(&study, Some(10.0)), &sources(&study)).unwrap();
        apart(said(&all, TOTAL, Way::Covariance), said(&all, TOTAL, Way::Sigma))
    });
    assert!(fine < 2e-9 && (20.0..30.0).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
}

/// Rows of a wrong filter sum to one dual-state covariance of everything at once, written for the whole errors: that one
/// takes small differences of large numbers (of velocities of metres a second), and its filter has exact transitions.
#[test]
fn rows_of_a_wrong_filter_sum_to_one_covariance() {
    const RATE: f64 = 10.0;
    let mut study = at_rest_with(few(), RATE, 600.0);
    let believed = few().scaled(0.2);
    let settings = study.filter.as_mut().unwrap();
    settings.spec = believed.clone();
    let settings = settings.clone();
    let scene = Scene::new(&study, Some(60.0));
    let all = linear(&scene, &sources(&study)).unwrap();
    let truth = Model::<24>::new(Form::Phi, NavStates::ALL, &study.imu.spec).unwrap();
    let filter =
        Filter::new(Model::<16>::new(Form::Phi, NavStates::HELD, &believed).unwrap(), &settings.sigma)
            .unwrap();
    let (pva, f_b) = scene.moment(0.0);
    let system = Form::Phi.system(&scene.dynamics(), &pva, f_b);
    let seen = scene.seen(0, 1);
    let steps = (
        Propagation::exact(&truth, &system, &seen, 1.0 / RATE),
        Propagation::exact(filter.model(), &system, &seen, 1.0 / RATE),
    );
    let mut dual = Dual::new(truth, &settings.sigma, filter).unwrap();
    let now = Now { pva, seen, dt: 1.0 / RATE };
    let zero =
        Velocity { v_t: Vec3::ZERO, sigma: [0.01 * RATE.sqrt(); 3], lever: Vec3::ZERO, axes: HORIZONTAL };
    for k in 1..=6000 {
        dual.propagate(&steps.0, &steps.1);
        dual.update(&zero.observe(&now), &now, [1e-4 * RATE; 3], &[]).unwrap();
        if k % 600 == 0 {
            let p = said(&all, TOTAL, Way::Covariance)[k / 600];
            // North and east of position and velocity, attitude: the states of the filter.
            let full = [0, 1, 3, 4, 6, 7, 8];
            let together = SMatrix::<f64, 7, 7>::from_fn(|i, j| dual.error_covariance(i, j));
            for (i, a) in full.into_iter().enumerate() {
                for (j, b) in full.into_iter().enumerate() {
                    let unit = (together[(i, i)] * together[(j, j)]).sqrt();
                    let off = (p[(a, b)] - together[(i, j)]).abs() / unit;
                    assert!(off < 2e-6, "{k} s: {a} {b}: {off:e}");
                }
            }
        }
    }
    let (true_sigma, own) = (said(&all, TOTAL, Way::Covariance), said(&all, TOTAL, Way::Sigma));
    let ratio = report::sigma(true_sigma.last().unwrap(), 8) / report::sigma(own.last().unwrap(), 8);
    assert!(ratio > 3.0, "a fifth of the sigmas must be seen: {ratio}");
}

/// A vehicle that moves and turns, with positions and a baro height, a lever arm and an outage.
pub fn driven(size: f64, rate: f64) -> Budget {
    use Instrument::{Accel, Gyro};
    let spec = Spec::from_sources([
        source(Gyro, "bias", "constant", "sigma", (5.0 * DEG_PER_HOUR * size).into()),
        source(Gyro, "scale_factor", "constant", "sigma", (1e-3 * size).into()),
        source(Accel, "bias", "constant", "sigma", (500.0 * UG * size).into()),
        source(Gyro, "bias", "white", "density", (0.1 * PI / 180.0 / 60.0 * size).into()),
        source(Accel, "bias", "white", "density", (50.0 * UG * size).into()),
    ])
    .unwrap();
    let known = spec.keep(|c| c.term().name() == "bias");
    let mut study = budget(47.0, rate, 60.0, spec, Vec::new());
    study.start.velocity = [15.0, 0.0, 0.0];
    study.motion = Motion::Shaken(Box::new(Motion::ConstantVelocity), Default::default());
    let turning = crate::trajectory::Sine { amplitude: 0.6, omega: 2.0 * PI / 20.0, phase: 0.0 };
    if let Motion::Shaken(_, axes) = &mut study.motion {
        axes.yaw = vec![turning];
    }
    study.mechanization.vertical = Vertical::Free;
    let position = Aid { lever_arm: [1.0, 0.5, -1.0], outages: vec![[40.0, 50.0]], ..aid(rate as u64, 1.0) };
    let velocity = Aid { lever_arm: [1.0, 0.5, -1.0], ..aid(2 * rate as u64, 0.1) };
    let aiding = Aiding {
        position: Some(position),
        velocity: Some(velocity),
        height: Some(aid(rate as u64 / 2, 0.5)),
        heading: Some(aid(rate as u64, 0.02)),
    };
    let sigma = [2.0, 2.0, 2.0, 0.2, 0.2, 0.2, 3e-3, 3e-3, 1e-2];
    study.filter = Some(BudgetFilter { spec: known, sigma, believed: aiding.clone(), aiding });
    study
}

/// Aided runs with every noise against the dual-state covariance, which the filter's own is not.
#[test]
fn aided_runs_meet_the_dual_covariance() {
    let mut study = driven(1.0, 20.0);
    study.runs = 200;
    study.initial_sigmas = initial(1.0);
    let scene = Scene::new(&study, Some(20.0));
    let track = monte_carlo::Track::new(&scene).unwrap();
    let list = sources(&study);
    let all = linear(&scene, &list).unwrap();
    let theory = said(&all, TOTAL, Way::Covariance);
    let found = monte_carlo::covariance(&scene, &track, &list, 5).unwrap();
    let sigma = (2.0 / study.runs as f64).sqrt();
    for (row, (p, q)) in theory.iter().zip(&found).enumerate().skip(1) {
        for k in 0..9 {
            let ratio = q[(k, k)] / p[(k, k)];
            assert!((ratio - 1.0).abs() < 4.5 * sigma, "row {row} error {k}: {ratio}");
        }
    }
    // Noises have rows of their own: three positions, three velocities, height and heading.
    let noises = list.iter().filter(|s| matches!(s.kind, Kind::Noise(_))).count();
    assert_eq!(noises, 8);
}

/// The covariance at each row of everything at once: r, the states of all sources and b, updated by
/// (I - k h') P (I - k h')' + k r k'.
fn together(study: &Budget, scene: &Scene) -> Vec<Nine> {
    const ALL: usize = 64;
    let filter = study.filter.as_ref().unwrap();
    let mut nominal = Nominal::<24>::new(scene, filter, &[]).unwrap();
    let model = Model::<ALL>::new(Form::Phi, NavStates::ALL, &study.imu.spec).unwrap();
    let (truth, first) = (model.len(), scene.moment(0.0).0);
    let all = truth + nominal.estimated();
    let mut p = DMatrix::<f64>::zeros(all, all);
    let states = model.p0(&[0.0; 9]).unwrap();
    p.view_mut((0, 0), (truth, truth)).copy_from(&states.view((0, 0), (truth, truth)));
    for source in sources(study) {
        for (k, sigma) in source.initial().into_iter().enumerate() {
            p[(k, k)] += sigma * sigma;
        }
    }
    let mut rows = vec![Nine::from_fn(|i, j| p[(i, j)])];
    let mut accumulator = Accumulator::new(&model, scene.dynamics(), &first);
    let (pva, f_b) = scene.moment(0.0);
    let system = Form::Phi.system(&scene.dynamics(), &pva, f_b);
    for interval in super::super::aided::schedule(scene, filter) {
        let samples = samples(scene, interval.begin, interval.end);
        let mut passed: Vec<Passed> = Vec::new();
        nominal.pass(&interval, &samples, &mut passed).unwrap();
        for passed in passed {
            let some = (passed.begin - interval.begin) as usize..(passed.end - interval.begin) as usize;
            let step = if scene.steady {
                let count = some.len() as u64;
                Propagation::exact(&model, &system, &scene.seen(0, count), scene.time(count))
            } else {
                for s in samples[some].iter().flat_map(|s| &s.parts) {
                    accumulator.step_seen(&model, &s.pva, &s.seen, &s.increments, s.dt);
                }
                accumulator.close(&model)
            };
            let mut a = DMatrix::<f64>::identity(all, all);
            a.view_mut((0, 0), (truth, truth)).copy_from(&step.phi().view((0, 0), (truth, truth)));
            a.view_mut((0, 0), (9, 9)).copy_from(&passed.phi_nn);
            a.view_mut((0, truth), (9, all - truth)).copy_from(&-&passed.phi_nb);
            if let Some(phi_bb) = &passed.phi_bb {
                a.view_mut((truth, truth), (all - truth, all - truth)).copy_from(phi_bb);
            }
            p = &a * p * a.transpose();
            let mut of_truth = p.view_mut((0, 0), (truth, truth));
            of_truth += step.q().view((0, 0), (truth, truth));
            for gain in &passed.gains {
                let (mut h, mut k) = (DVector::zeros(all), DVector::zeros(all));
                h.rows_mut(0, 9).copy_from(&gain.h_n);
                k.rows_mut(0, 9).copy_from(&gain.k_n);
                h.rows_mut(truth, all - truth).copy_from(&-&gain.h_b);
                k.rows_mut(truth, all - truth).copy_from(&-&gain.k_b);
                for state in 9..truth {
                    let mut unit = SVector::<f64, ALL>::zeros();
                    unit[state] = 1.0;
                    let e = model.sensor_error(Instrument::Gyro, &unit, &passed.seen, scene.dt);
                    h[state] = (0..3).map(|axis| gain.h_gyro[axis] * e[axis]).sum();
                }
                let aid = match gain.kind {
                    MeasuredKind::Position => &filter.aiding.position,
                    MeasuredKind::Velocity => &filter.aiding.velocity,
                    MeasuredKind::Height => &filter.aiding.height,
                    MeasuredKind::Heading => &filter.aiding.heading,
                };
                let left = DMatrix::identity(all, all) - &k * h.transpose();
                let r = aid.as_ref().unwrap().sigma[gain.axis].powi(2);
                p = &left * p * left.transpose() + &k * k.transpose() * r;
            }
            if scene.rows.contains(&passed.end) {
                rows.push(Nine::from_fn(|i, j| p[(i, j)]));
            }
        }
    }
    rows
}

/// Rows sum to the covariance of everything at once, forward and back from the last row, through right and wrong filters, at
/// rest and on the move.
#[test]
fn rows_through_a_filter_sum_to_one_covariance() {
    let mut wrong = at_rest(few());
    wrong.filter.as_mut().unwrap().spec = few().scaled(0.2);
    let mut moving = driven(1.0, 20.0);
    moving.initial_sigmas = initial(1.0);
    for study in [at_rest(few()), wrong, moving] {
        let scene = Scene::new(&study, Some(20.0));
        let all = linear(&scene, &sources(&study)).unwrap();
        let whole = together(&study, &scene);
        let x = apart(said(&all, TOTAL, Way::Covariance), &whole);
        let last = &whole[whole.len() - 1..];
        let y = apart(said(&all, TOTAL, Way::Adjoint), last);
        assert!(x < 1e-9 && y < 1e-12, "{x:e} {y:e}");
        for c in &all {
            // Of the largest that the row has been: what the filter takes out of it leaves rounding of that.
            let forward = c.of(Way::Covariance).unwrap();
            let mut other = forward.to_vec();
            other[forward.len() - 1] = c.of(Way::Adjoint).unwrap()[0];
            let x = apart(&other, forward);
            assert!(x < 4e-9, "{}: adjoint {x:e}", c.name);
        }
    }
}
