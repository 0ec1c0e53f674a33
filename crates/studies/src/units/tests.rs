use core::f64::consts::PI;

use proptest::prelude::*;
use schuler_imu::Unit;

use super::{UnitError, describe, example, expected, parse_quantity, parse_unit, symbols::SYMBOLS};

fn si(text: &str) -> (f64, Unit) {
    let q = parse_quantity(text).unwrap_or_else(|e| panic!("{text}: {e}"));
    (q.value, q.unit)
}

#[track_caller]
fn near(text: &str, value: f64, unit: Unit) {
    let (v, u) = si(text);
    assert_eq!(u, unit, "{text}");
    assert!((v - value).abs() <= 4.0 * f64::EPSILON * value.abs(), "{text}: {v} is not {value}");
}

const DEG: f64 = PI / 180.0;
const G: f64 = 9.80665;

#[test]
fn units_of_the_field() {
    near("0.01 deg/h", 0.01 * DEG / 3600.0, Unit::RATE);
    near("15.041°/h", 15.041 * DEG / 3600.0, Unit::RATE);
    // sqrt(3600) = 60: 1 deg/sqrt(h) is DEG/60 rad/sqrt(s).
    near("0.003 deg/sqrt(h)", 0.003 * DEG / 60.0, Unit::new(0, 1, -1, 0));
    near("0.003 deg/√h", 0.003 * DEG / 60.0, Unit::new(0, 1, -1, 0));
    near("1 ug", 9.80665e-6, Unit::FORCE);
    near("1 µg", 9.80665e-6, Unit::FORCE);
    near("1 μg", 9.80665e-6, Unit::FORCE);
    near("2 mg", 2e-3 * G, Unit::FORCE);
    near("100 ppm", 1e-4, Unit::ONE);
    near("10 arcsec", 10.0 * DEG / 3600.0, Unit::RADIAN);
    near("1 arcmin", DEG / 60.0, Unit::RADIAN);
    near("3 mrad", 3e-3, Unit::RADIAN);
    near("24 h", 86_400.0, Unit::SECOND);
    near("100 Hz", 100.0, Unit::HERTZ);
    near("20 ug/sqrt(Hz)", 20e-6 * G, Unit::new(1, 0, -3, 0));
    near("0.06 m/s/sqrt(h)", 1e-3, Unit::new(1, 0, -3, 0));
    // 1 ug/g² = 1e-6/g.
    near("10 ug/g^2", 10e-6 / G, Unit::new(-1, 0, 4, 0));
    near("1 deg/h/g", DEG / 3600.0 / G, Unit::RATE / Unit::FORCE);
    near("0.2 m/s^2", 0.2, Unit::FORCE);
    near("0.2 m/s²", 0.2, Unit::FORCE);
    near("0.2 m s^-2", 0.2, Unit::FORCE);
    near("1 nmi/h", 1852.0 / 3600.0, Unit::new(1, 0, -2, 0));
    near("1 kn", 1852.0 / 3600.0, Unit::new(1, 0, -2, 0));
    near("2 km", 2000.0, Unit::METRE);
    near("0.1 deg/h/degC", 0.1 * DEG / 3600.0, Unit::RATE / Unit::KELVIN);
    near("5 counts", 5.0, Unit::ONE);
    near("1e-3", 1e-3, Unit::ONE);
    near("-.5e1rad", -5.0, Unit::RADIAN);
    near("10 ppm/(deg/s)", 1e-5 / DEG, Unit::ONE / Unit::RATE);
    near("0.001 deg/h/sqrt(h)", 0.001 * DEG / 216_000.0, Unit::new(0, 1, -3, 0));
}

#[test]
fn what_is_no_quantity() {
    let error = |text| parse_quantity(text).expect_err(text);
    assert_eq!(error("deg/h"), UnitError::NoNumber);
    assert_eq!(error(""), UnitError::NoNumber);
    assert_eq!(error("NaN deg"), UnitError::NoNumber);
    assert_eq!(error("1e999 deg"), UnitError::NotFinite);
    assert_eq!(error("1 dge/h"), UnitError::UnknownSymbol { symbol: "dge".into(), similar: Some("deg") });
    assert_eq!(error("1 furlong"), UnitError::UnknownSymbol { symbol: "furlong".into(), similar: None });
    assert_eq!(error("1 deg/"), UnitError::Syntax { rest: "end".into() });
    assert_eq!(error("1 deg/sqrt(h"), UnitError::Syntax { rest: "end".into() });
    assert_eq!(error("1 deg)"), UnitError::Syntax { rest: ")".into() });
    assert_eq!(error("1 m^x"), UnitError::Syntax { rest: "x".into() });
    // A root of a root of time, and of a length, measure nothing here.
    assert_eq!(error("1 √√s"), UnitError::Power);
    assert_eq!(error("1 sqrt(m)"), UnitError::Power);
    assert_eq!(error("1 m^99*m^99"), UnitError::Power);
    assert!(matches!(error(&format!("1 {}", "(".repeat(100_000))), UnitError::Syntax { .. }));
}

#[test]
fn examples_of_messages_parse() {
    for (unit, text) in expected::examples() {
        assert_eq!(si(text).1, unit, "{text}");
        assert_eq!(example(unit), text);
        assert!(!describe(unit).is_empty());
    }
}

proptest! {
    #[test]
    fn the_si_text_of_every_unit_parses_back(metre in -4i8..5, radian in -4i8..5, half in -9i8..10, kelvin in -3i8..4) {
        let unit = Unit::new(metre, radian, half, kelvin);
        prop_assert_eq!(parse_unit(&unit.to_string()), Ok((1.0, unit)));
    }

    #[test]
    fn a_number_keeps_its_value(value in proptest::num::f64::NORMAL | proptest::num::f64::ZERO) {
        prop_assert_eq!(si(&format!("{value:e} m/s")).0, value);
        prop_assert_eq!(si(&format!("{value} s")).0, value);
    }

    #[test]
    fn factors_multiply(a in 0..SYMBOLS.len(), b in 0..SYMBOLS.len(), value in -1e6..1e6f64) {
        let (a, b) = (SYMBOLS[a], SYMBOLS[b]);
        let (fa, fb) = (a.1 / a.2, b.1 / b.2);
        let close = |x: f64, y: f64| (x - y).abs() <= 1e-14 * y.abs();
        let (product, quotient) = (si(&format!("{value} {} {}", a.0, b.0)), si(&format!("{value} {}/{}", a.0, b.0)));
        prop_assert_eq!(product.1, a.3 * b.3);
        prop_assert_eq!(quotient.1, a.3 / b.3);
        prop_assert!(close(product.0, value * fa * fb) && close(quotient.0, value * fa / fb));
    }

    #[test]
    fn no_text_panics(text in "[ 0-9a-z.²³√()/*^·µ°+-]{0,24}") {
        let _ = parse_quantity(&text);
    }
}
