//! Presets: figures as printed against numbers and units, and the specifications that they make.

use schuler_imu::preset::{DEVICES, GRADES, Kind, Role, preset, presets};
use schuler_imu::{Imu, Instrument, Spec, Stream, Truth};

/// Size of a printed unit, worked out from its parts, apart from the table of the crate.
fn size(text: &str) -> f64 {
    let part = |p: &str| -> f64 {
        match p {
            "deg" => std::f64::consts::PI / 180.0,
            "mdeg" => std::f64::consts::PI / 180e3,
            "arcsec" => std::f64::consts::PI / 648e3,
            "mrad" => 1e-3,
            "h" => 3600.0,
            "sqrt(h)" => 60.0,
            "s" | "s^2" | "sqrt(Hz)" | "K" | "m" => 1.0,
            "g" => 9.80665,
            "mg" => 9.80665e-3,
            "ug" => 9.80665e-6,
            "g^2" => 9.80665 * 9.80665,
            "mGal" => 1e-5,
            "ft" => 0.3048,
            "ppm" => 1e-6,
            "%" => 1e-2,
            other => panic!("unknown part {other}"),
        }
    };
    let mut parts = text.split('/');
    parts.by_ref().take(1).map(part).product::<f64>() / parts.map(part).product::<f64>()
}

#[test]
fn si_values_follow_from_the_printed_text() {
    for p in presets() {
        assert!(!p.figures.is_empty() && !p.source.is_empty(), "{}", p.name);
        for f in p.figures {
            let (number, unit) = f.printed.split_once(' ').unwrap();
            let number: f64 = number.trim_start_matches(['±', '<']).parse().unwrap();
            assert_eq!((number, unit), (f.number, f.unit.name), "{} {}", p.name, f.printed);
            let expected = number * size(unit);
            assert!((f.si() - expected).abs() < 1e-14 * expected, "{} {}", p.name, f.printed);
        }
    }
}

/// The dimension of every figure is that of the coefficient that it becomes.
#[test]
fn dimensions_fit_what_figures_become() {
    for p in presets() {
        for f in p.figures {
            let source = f.as_source().unwrap();
            assert_eq!(source.is_none(), matches!(f.role, Role::Shown(_)));
            let Some(source) = source else { continue };
            let parameter =
                source.process().kind().forms()[usize::from(source.process().kind().name() == "constant")][0];
            assert!(parameter.accepts(source.unit(), f.dimension()), "{} {}", p.name, f.printed);
        }
    }
}

#[test]
fn every_preset_runs() {
    let mut names: Vec<_> = presets().map(|p| p.name).collect();
    for p in presets() {
        let mut imu = Imu::new(&p.spec().unwrap(), Stream::default()).unwrap();
        let sample = imu.step(0.01, &Truth::rates([0.1; 3], [9.8; 3]));
        assert!(sample.dtheta.iter().chain(&sample.dv).all(|x| x.is_finite()), "{}", p.name);
        assert_eq!(preset(p.name), Some(p));
    }
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), DEVICES.len() + GRADES.len());
    assert!(GRADES.iter().all(|g| g.kind == Kind::Grade));
}

/// STIM300, worked out by hand: 0.15 deg/sqrt(h) = 4.3633e-5 rad/sqrt(s), 0.06 m/s/sqrt(h) = 1e-3
/// m/s/sqrt(s), 0.5 deg/h = 2.4241e-6 rad/s at the lowest point of the Allan deviation.
#[test]
fn stim300_by_hand() {
    let spec: Spec = preset("stim300").unwrap().spec().unwrap();
    let allan = |name: &str, tau: f64| spec.component(name).unwrap().evolution().allan_variance(tau).sqrt();
    let close = |found: f64, expected: f64, tolerance: f64| {
        assert!((found / expected - 1.0).abs() < tolerance, "{found} {expected}");
    };
    close(allan("gyro.bias.white.x", 1.0), 4.363_323e-5, 1e-6);
    close(allan("accel.bias.white.z", 1.0), 1e-3, 1e-12);
    close(allan("gyro.bias.flicker.y", 300.0), 2.424_068e-6, 0.01);
    assert!(spec.sources().any(|s| s.instrument() == Instrument::Gyro && s.term().name() == "g_sensitivity"));
}

#[test]
fn grades_come_in_order() {
    let order = ["consumer", "industrial", "tactical", "navigation", "strategic"];
    assert_eq!(GRADES.iter().map(|g| g.name).collect::<Vec<_>>(), order);
}
