//! Sources that one stands for.

use super::super::covariance;
use super::super::shared::Shared;
use super::super::source::Source;
use super::aided::driven;
use super::*;

/// Every kind of process twice, the second three times as large (a value in place of a standard deviation, another time constant and
/// another axis are no others' copies): rows of one's own walker and of the shared one are the same, and no walker is new.
#[test]
fn an_added_source_of_a_known_kind_costs_no_walker() {
    use Instrument::{Accel, Gyro};
    let both = |name: &str, by: f64| {
        vec![
            source(Gyro, "bias", "constant", name, (1e-7 * by).into()),
            source(Gyro, "bias", "white", "density", (3e-7 * by).into()),
            source(Accel, "bias", "random_walk", "density", (1e-6 * by).into()),
            source(Accel, "scale_factor", "constant", "sigma", (1e-4 * by).into()),
            source(Gyro, "bias", "ramp", "sigma", (1e-11 * by).into()),
        ]
    };
    let one = Spec::from_sources(both("sigma", 1.0)).unwrap();
    let two = Spec::from_sources(both("sigma", 1.0).into_iter().chain(both("value", 3.0))).unwrap();
    let study = Budget {
        filter: None,
        imu: scenario::Imu { rate: 20.0, spec: two, temperature: None },
        ..driven(1.0, 20.0)
    };
    let all = sources(&study);
    let shared = Shared::new(&all);
    assert_eq!(shared.firsts.len(), one.components().count());
    assert_eq!(all.len(), 2 * shared.firsts.len());
    let scene = Scene::new(&study, Some(20.0));
    let made = linear(&scene, &all).unwrap();
    let own = covariance::covariance(&scene, &all);
    let back = covariance::adjoint(&scene, &all);
    for (k, own) in own.iter().enumerate() {
        let said = |way| made[k].of(way).unwrap();
        assert!(apart(said(Way::Covariance), own) < 1e-11, "{}", all[k].name);
        assert!(apart(said(Way::Adjoint), &back[k..=k]) < 1e-11, "{}", all[k].name);
    }
    let thrice = shared.of.iter().filter(|(_, times)| (times - 3.0).abs() < 1e-9).count();
    assert_eq!(thrice, shared.firsts.len());
}

/// Other axes, instruments, terms and time constants are their own.
#[test]
fn what_differs_is_not_shared() {
    use Instrument::{Accel, Gyro};
    let markov = |tau: f64| {
        Imu::named(Gyro, "bias", "gauss_markov", &[("sigma", 1e-7.into()), ("tau", tau.into())]).unwrap()
    };
    let spec = Spec::from_sources([
        markov(100.0),
        markov(200.0),
        source(Gyro, "bias", "constant", "sigma", 1e-7.into()),
        source(Accel, "bias", "constant", "sigma", 1e-7.into()),
        source(Gyro, "scale_factor", "constant", "sigma", 1e-7.into()),
    ])
    .unwrap();
    let all: Vec<Source> = sources(&budget(45.0, 1.0, 60.0, spec, initial(1.0)));
    assert_eq!(Shared::new(&all).firsts.len(), all.len());
}
