//! Responses along flights against half the difference of full runs of the opposite sign.

use schuler_imu::{Instrument, Source as Imu, Spec, Stream};

use super::super::scene::Scene;
use super::super::source::{Kind, Source, sources};
use super::super::{columns, monte_carlo};
use super::aided::driven;
use super::*;
use crate::trajectory::{Segment, Sharpness, Turn};

/// What a unit of a source does, by full runs: half the difference D of those with plus and minus a size h of it. Of the
/// third order D(h) has h², which (4 D(h) - D(2h)) / 3 has not, so that h may be large and rounding small.
pub fn half_difference(
    scene: &Scene,
    track: &monte_carlo::Track,
    source: &Source,
    size: f64,
) -> Vec<[f64; 9]> {
    let [fine, coarse] = [size, 2.0 * size].map(|size| of_size(scene, track, source, size));
    let both = fine.iter().zip(&coarse);
    both.map(|(f, c)| std::array::from_fn(|k| (4.0 * f[k] - c[k]) / 3.0)).collect()
}

fn of_size(scene: &Scene, track: &monte_carlo::Track, source: &Source, size: f64) -> Vec<[f64; 9]> {
    let mut value = match (&source.kind, source.size()) {
        (Kind::Sensor(c), Some(s)) => {
            let mut values = vec![0.0; c.term().len()];
            values[c.coefficient()] = s.value * size;
            let value = [("value", Value::Each(&values))];
            let fixed = Imu::named(c.instrument(), c.term().name(), "constant", &value);
            Spec::from_sources([fixed.unwrap()]).unwrap()
        }
        _ => Spec::new(),
    };
    value.calibration_temperature = scene.study.imu.spec.calibration_temperature;
    let stream = Stream { seed: 1, run: 0 };
    let [plus, minus] = [1.0, -1.0].map(|sign| {
        let initial = source.initial().map(|x| sign * size * x);
        let spec = &value.scaled(sign);
        monte_carlo::Run { track, sources: &[], spec, initial, stream }.navigate(scene).unwrap()
    });
    let half = |(p, m): (&[f64; 9], &[f64; 9])| std::array::from_fn(|k| 0.5 * (p[k] - m[k]) / size);
    plus.iter().zip(&minus).map(half).collect()
}

/// The largest difference of two responses in position, velocity and attitude, in units of the largest of `b` there; of what
/// is below `floor` (m, m/s, rad) there is rounding and nothing else.
pub fn off(a: &[[f64; 9]], b: &[[f64; 9]], floor: [f64; 3]) -> [f64; 3] {
    assert_eq!(a.len(), b.len());
    [0, 1, 2].map(|group| {
        let errors = 3 * group..3 * group + 3;
        let largest = b.iter().flat_map(|r| &r[errors.clone()]).fold(0.0f64, |m, x| m.max(x.abs()));
        if largest < floor[group] {
            return 0.0;
        }
        let both = a.iter().zip(b).flat_map(|(a, b)| errors.clone().map(|k| (a[k] - b[k]).abs()));
        both.fold(0.0, f64::max) / largest
    })
}

pub fn missile(rate: f64) -> Budget {
    use Instrument::{Accel, Gyro};
    let spec = Spec::from_sources([
        source(Gyro, "bias", "constant", "sigma", DEG_PER_HOUR.into()),
        source(Accel, "bias", "constant", "sigma", (1e3 * UG).into()),
        source(Gyro, "scale_factor", "constant", "sigma", 3e-4.into()),
        source(Accel, "misalignment", "constant", "sigma", 2e-4.into()),
        source(Accel, "quadratic", "constant", "sigma", 1e-5.into()),
    ])
    .unwrap();
    let mut study = budget(35.0, rate, 100.0, spec, initial(1.0));
    study.start.position.h = 6000.0;
    study.start.velocity = [200.0, 150.0, 0.0];
    study.mechanization.vertical = Vertical::Free;
    study.mechanization.gravity = Gravity::Normal;
    let turn = |rate: f64| Turn { sharpness: Sharpness::Rate(rate), ramp: 2.0, flat: false };
    study.motion = Motion::Segments(vec![
        Segment::Straight { duration: 2.0 },
        Segment::Accelerate { to: 800.0, duration: 18.0 },
        Segment::Turn { angle: 1.0, turn: turn(0.05) },
        Segment::Straight { duration: 10.0 },
        Segment::Turn { angle: -0.5, turn: turn(0.07) },
        Segment::Turn { angle: 0.5, turn: turn(0.07) },
        Segment::Straight { duration: 60.0 },
    ]);
    study
}

/// Ten minutes of an airliner: it accelerates, turns by 90 and by -150 degrees, and flies on.
fn airliner(rate: f64) -> Budget {
    let mut study = Budget { samples: (600.0 * rate) as u64, ..missile(rate) };
    study.start.velocity = [0.0, 150.0, 0.0];
    study.start.position.h = 10_000.0;
    study.mechanization.vertical = Vertical::Held;
    let bank = |bank: f64| Turn { sharpness: Sharpness::Bank(bank), ramp: 5.0, flat: false };
    study.motion = Motion::Segments(vec![
        Segment::Accelerate { to: 230.0, duration: 60.0 },
        Segment::Turn { angle: 1.5, turn: bank(0.4) },
        Segment::Straight { duration: 120.0 },
        Segment::Turn { angle: -2.5, turn: bank(0.45) },
        Segment::Straight { duration: 600.0 },
    ]);
    study
}

/// The largest of all sources' deviations of columns from half-differences.
fn worst(study: &Budget, size: f64, floor: [f64; 3]) -> ([f64; 3], usize) {
    let scene = Scene::new(study, Some(10.0));
    let track = monte_carlo::Track::new(&scene).unwrap();
    let all = sources(study);
    let found = match &study.filter {
        Some(filter) => super::super::aided::linear(&scene, filter, &all).unwrap().columns,
        None => columns::responses(&scene, &all),
    };
    let (mut worst, mut compared) = ([0.0f64; 3], 0);
    for (source, response) in all.iter().zip(&found).filter(|(_, response)| !response.is_empty()) {
        let off = off(&half_difference(&scene, &track, source, size), response, floor);
        compared += off.iter().filter(|off| **off > 0.0).count();
        (0..3).for_each(|k| worst[k] = worst[k].max(off[k]));
    }
    (worst, compared)
}

/// Columns against half-differences along flights with turns: 1e-6 of the largest response. What is left is the navigator's
/// own step, of second order: a quarter of the step leaves a sixteenth (of the missile; of the airliner it is lost in rounding).
#[test]
fn columns_meet_half_differences_in_flight() {
    let floor = [1e-3, 1e-4, 1e-8];
    let (coarse, _) = worst(&missile(100.0), 0.5, floor);
    let (fine, compared) = worst(&missile(400.0), 0.5, floor);
    assert!(compared > 40, "{compared}");
    for (fine, coarse) in fine.into_iter().zip(coarse) {
        assert!(fine < 1e-6 && (14.0..18.0).contains(&(coarse / fine)), "{fine:e} {coarse:e}");
    }
    let (airliner, compared) = worst(&airliner(200.0), 0.5, floor);
    assert!(compared > 40 && airliner.into_iter().all(|x| x < 1e-6), "{compared}: {airliner:?}");
}

/// The same through a filter with measurements of everything but the velocity of an antenna: 1e-6. At the antenna the navigator
/// takes the mean rate of a sample for that at its end, and so finds innovations without errors, by which gains that change
/// with the errors are of first order: half the step leaves half of that.
#[test]
fn columns_through_a_filter_meet_half_differences() {
    let floor = [1e-3, 1e-4, 1e-5];
    let study = |rate: f64, lever: [f64; 3]| {
        let mut study = driven(1.0, rate);
        study.initial_sigmas = initial(1.0);
        let filter = study.filter.as_mut().unwrap();
        for aiding in [&mut filter.aiding, &mut filter.believed] {
            aiding.velocity.as_mut().unwrap().lever_arm = lever;
        }
        study
    };
    let (at_body, compared) = worst(&study(200.0, [0.0; 3]), 5.0, floor);
    assert!(compared > 30 && at_body.into_iter().all(|x| x < 1e-6), "{compared}: {at_body:?}");
    let [coarse, fine] = [100.0, 200.0].map(|rate| worst(&study(rate, [1.0, 0.5, -1.0]), 5.0, floor).0);
    for (fine, coarse) in fine.into_iter().zip(coarse) {
        assert!(fine < 1e-4 && (1.9..2.1).contains(&(coarse / fine)), "{fine:e} {coarse:e}");
    }
}
