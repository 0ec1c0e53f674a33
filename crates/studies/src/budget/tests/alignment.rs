//! Starts that hang together with the sensor errors that caused them.

use schuler_frames::{T, Vec3};
use schuler_imu::{Instrument, Source as Imu, Spec};
use schuler_strapdown::static_base::{Drivers, Site, exact};
use schuler_strapdown::{align::Limits, filter::Model};

use super::super::scene::Scene;
use super::super::source::{ROOM, sources};
use super::super::{TOTAL, Way, alignment, linear, monte_carlo, report};
use super::*;

/// Constants, a ramp and noises, aligned for ten minutes.
fn aligned(lat: f64, duration: f64, spec: Spec) -> Budget {
    Budget { alignment: 600, ..budget(lat, 1.0, duration, spec, Vec::new()) }
}

/// All ways agree on every row, and what the alignment makes equilibria does nothing: gyro and accelerometer errors to the
/// east (1.3e-9 of what they would do alone).
#[test]
fn ways_agree_after_an_alignment() {
    for lat in [0.0, 45.0, -75.0] {
        let study = aligned(lat, 36_000.0, mixed(1.0));
        let scene = Scene::new(&study, Some(1800.0));
        let all = linear(&scene, &sources(&study)).unwrap();
        let mut exact = 0;
        let unit = said(&all, TOTAL, Way::Covariance);
        // Of rows that cancel, what is left is rounding of what they would have done.
        let off = |a: &[Nine], b: &[Nine]| {
            let mut largest = 0.0f64;
            for k in [0, 1, 3, 4, 6, 7, 8] {
                let scale = unit.iter().map(|p| p[(k, k)]).fold(0.0, f64::max);
                for (a, b) in a.iter().zip(b) {
                    largest = largest.max((a[(k, k)] - b[(k, k)]).abs() / scale);
                }
            }
            largest
        };
        for c in all.iter().filter(|c| c.name != TOTAL) {
            let covariance = c.of(Way::Covariance).unwrap();
            for way in [Way::Columns, Way::Exact] {
                if let Some(rows) = c.of(way) {
                    let x = off(covariance, rows);
                    assert!(x < 2e-9, "lat {lat} {} {way:?}: {x:e}", c.name);
                    exact += 1;
                }
            }
            let x = off(&covariance[covariance.len() - 1..], c.of(Way::Adjoint).unwrap());
            assert!(x < 2e-9, "lat {lat} {} adjoint: {x:e}", c.name);
        }
        assert!(exact > 30, "{exact}");
        for name in ["gyro.bias.constant.y", "accel.bias.constant.y"] {
            for way in [Way::Columns, Way::Exact] {
                let rows = said(&all, name, way);
                let largest = rows.iter().map(|p| horizontal(p).trace().sqrt()).fold(0.0, f64::max);
                assert!(largest < 1e-6, "lat {lat} {name} {way:?}: {largest:e} m");
            }
        }
    }
}

/// A north accelerometer error, levelled out, leaves what the gyro errors -Ω sin L nabla/g to the north and -Ω cos L nabla/g
/// down would do (theory of static alignment: the tilt is an equilibrium with these).
#[test]
fn a_north_accelerometer_error_leaves_gyro_errors() {
    use Instrument::Accel;
    let nabla = 100.0 * UG;
    let spec =
        Spec::from_sources([source(Accel, "bias", "constant", "value", Value::Each(&[nabla, 0.0, 0.0]))]);
    let study = aligned(45.0, 86_400.0, spec.unwrap());
    let scene = Scene::new(&study, Some(3600.0));
    let found = linear(&scene, &sources(&study)).unwrap();
    let site = Site::new(study.start.position, study.mechanization.gravity);
    let tilt = nabla / site.g;
    let eps = Vec3::new(-site.omega_ie * site.sin_lat * tilt, 0.0, -site.omega_ie * site.cos_lat * tilt);
    let left = exact(&site, &Drivers { eps, ..Drivers::default() });
    let mut largest = 0.0f64;
    for (&k, p) in scene.rows.iter().zip(said(&found, "accel.bias.constant.x", Way::Columns)) {
        let dr = left.at(scene.time(k)).dr;
        let size = dr[0].hypot(dr[1]);
        assert!((horizontal(p).trace().sqrt() - size).abs() < 1e-6, "{k}: {p} {size}");
        largest = largest.max(size);
    }
    // At its largest 1292 m, at some time between the rows.
    assert!((1000.0..1293.0).contains(&largest), "{largest}");
}

/// The joint covariance of attitude and bias after the alignment, of a Gauss-Markov gyro error: with u = T/τ,
/// mean square 2 σ² (u - 1 + e^-u)/u², covariance of mean and end σ² (1 - e^-u)/u. And of white noise N / (Ω cos L √T).
#[test]
fn noise_leaves_its_closed_forms() {
    use Instrument::Gyro;
    let (sigma, tau) = (0.02 * DEG_PER_HOUR, 400.0);
    let markov = Imu::named(Gyro, "bias", "gauss_markov", &[("sigma", sigma.into()), ("tau", tau.into())]);
    let n = 0.003 * PI / 180.0 / 60.0;
    let white = source(Gyro, "bias", "white", "density", n.into());
    let study = aligned(45.0, 600.0, Spec::from_sources([markov.unwrap(), white]).unwrap());
    let scene = Scene::new(&study, Some(600.0));
    let limits = Limits::new(Site::new(study.start.position, study.mechanization.gravity));
    let slope = limits.bias(Vec3::<T>::new(0.0, 1.0, 0.0), Vec3::ZERO)[2];
    let all = sources(&study);
    let start = |name: &str| {
        let source = all.iter().find(|s| s.name == name).unwrap();
        let model: Model<ROOM> = source.model(&study.imu.spec);
        source.start(&scene, &model)
    };
    let p = start("gyro.bias.gauss_markov.y");
    let u = 600.0 / tau;
    let mean = 2.0 * (u - 1.0 + (-u).exp()) / (u * u);
    let with_end = (1.0 - (-u).exp()) / u;
    for (found, expected) in [
        (p[(8, 8)], (slope * sigma).powi(2) * mean),
        (p[(8, 9)], slope * sigma * sigma * with_end),
        (p[(9, 9)], sigma * sigma),
    ] {
        assert!((found / expected - 1.0).abs() < 1e-9, "{found:e} {expected:e}");
    }
    let p = start("gyro.bias.white.y");
    assert!((p[(8, 8)].sqrt() / limits.heading_triad(n, 600.0) - 1.0).abs() < 1e-9);
    assert_eq!(alignment::window(&scene), 600.0);
}

/// Runs that align by their own samples against the covariance, noises that last through the alignment included.
#[test]
fn runs_that_align_meet_the_covariance() {
    use Instrument::{Accel, Gyro};
    let markov = |i, sigma: f64| {
        Imu::named(i, "bias", "gauss_markov", &[("sigma", sigma.into()), ("tau", 900.0.into())]).unwrap()
    };
    let spec = Spec::from_sources([
        source(Gyro, "bias", "constant", "sigma", (0.01 * DEG_PER_HOUR).into()),
        source(Gyro, "bias", "white", "density", (0.003 * PI / 180.0 / 60.0).into()),
        markov(Gyro, 0.01 * DEG_PER_HOUR),
        markov(Accel, 50.0 * UG),
    ]);
    let mut study = aligned(45.0, 1800.0, spec.unwrap());
    (study.imu.rate, study.alignment, study.samples) = (0.5, 300, 900);
    study.runs = 300;
    let scene = Scene::new(&study, Some(1800.0));
    let track = monte_carlo::Track::new(&scene).unwrap();
    let list = sources(&study);
    let all = linear(&scene, &list).unwrap();
    let found = monte_carlo::covariance(&scene, &track, &list, 11).unwrap();
    let theory = said(&all, TOTAL, Way::Covariance);
    let sigma = (2.0 / study.runs as f64).sqrt();
    for (row, p) in theory.iter().enumerate() {
        for k in [0, 1, 3, 4, 6, 7, 8].into_iter().filter(|&k| report::sigma(p, k) > 0.0) {
            let ratio = found[row][(k, k)] / p[(k, k)];
            assert!((ratio - 1.0).abs() < 4.0 * sigma, "row {row} error {k}: {ratio}");
        }
    }
}
