//! Units as text and in their algebra.

use schuler_imu::Unit;

#[test]
fn text_is_si() {
    let cases = [
        (Unit::ONE, "1"),
        (Unit::RATE, "rad/s"),
        (Unit::FORCE, "m/s^2"),
        (Unit::RATE.times_half_seconds(1), "rad/sqrt(s)"),
        (Unit::RATE.times_half_seconds(-1), "rad/s/sqrt(s)"),
        (Unit::FORCE.times_half_seconds(1), "m/s/sqrt(s)"),
        (Unit::SECOND / Unit::METRE, "s/m"),
        (Unit::ONE / Unit::KELVIN, "1/K"),
        (Unit::RATE / (Unit::FORCE * Unit::FORCE), "rad*s^3/m^2"),
    ];
    for (unit, text) in cases {
        assert_eq!(unit.to_string(), text);
    }
}

#[test]
fn an_angle_serves_as_pure_number_but_a_rate_is_no_frequency() {
    assert!(Unit::ONE.accepts(Unit::RADIAN));
    assert!(!Unit::RADIAN.accepts(Unit::ONE));
    assert!(!Unit::RATE.accepts(Unit::HERTZ));
    assert!(!Unit::FORCE.accepts(Unit::RATE));
}
