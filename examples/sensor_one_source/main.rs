//! What does each error source alone do to a gyroscope that stands still?

use std::error::Error;

use schuler_imu::Instrument::Gyro;
use schuler_imu::{Imu, Source, Spec, Stream, Truth, Value};
use schuler_studies::figure::{Axis, Figure, Panel, Series};

const DEG_H: f64 = std::f64::consts::PI / 180.0 / 3600.0;
/// 1 deg/sqrt(h) in rad/sqrt(s).
const DEG_SQRT_H: f64 = std::f64::consts::PI / 180.0 / 60.0;
/// Sample interval, s, and number of samples: half an hour.
const DT: f64 = 0.01;
const SAMPLES: usize = 180_000;

/// Term and process with its numbers, of the size of a tactical sensor.
type Case<'a> = (&'a str, &'a str, &'a [(&'a str, Value<'a>)]);

fn main() -> Result<(), Box<dyn Error>> {
    let cases: [Case<'_>; 8] = [
        ("bias", "constant", &[("value", (1.0 * DEG_H).into())]),
        ("bias", "white", &[("density", (0.1 * DEG_SQRT_H).into())]),
        ("bias", "random_walk", &[("density", (2.0 * DEG_H / 60.0).into())]),
        ("bias", "gauss_markov", &[("sigma", (1.0 * DEG_H).into()), ("tau", 300.0.into())]),
        (
            "bias",
            "flicker",
            &[("instability", (1.0 * DEG_H).into()), ("tau_min", 1.0.into()), ("tau_max", 1e4.into())],
        ),
        ("bias", "ramp", &[("rate", (2.0 * DEG_H / 3600.0).into())]),
        ("bias", "quantization", &[("q", 1e-5.into())]),
        ("scale_factor", "constant", &[("value", 500e-6.into())]),
    ];
    println!(
        "{:34}{:>16}{:>16}{:>16}{:>16}",
        "source alone", "sd (deg/h)", "Allan 1 s", "Allan 100 s", "angle (deg)"
    );
    let mut panel = Panel::new(Axis::linear("angle error (deg)"));
    for (term, process, given) in cases {
        let spec = Spec::from_sources([Source::named(Gyro, term, process, given)?])?;
        let mut imu = Imu::new(&spec, Stream { seed: 1, run: 0 })?;
        // Still, but for the Earth's rotation along the axis.
        let truth = Truth::rates([7.292115e-5, 0.0, 0.0], [0.0, 0.0, -9.81]);
        let (mut angle, mut squares, mut curve) = (0.0, 0.0, Vec::new());
        for k in 0..SAMPLES {
            let error = imu.step(DT, &truth).omega_error[0];
            angle += error * DT;
            squares += error * error;
            if k % 1000 == 999 {
                curve.push([(k + 1) as f64 * DT, angle.to_degrees()]);
            }
        }
        let name = spec.sources().next().ok_or("no source")?.name().to_string();
        let component = spec.components().next().ok_or("no component")?;
        let allan = |tau: f64| component.evolution().allan_variance(tau).sqrt() / DEG_H;
        let deviation = (squares / SAMPLES as f64).sqrt() / DEG_H;
        if term == "bias" {
            println!(
                "{name:34}{deviation:16.4}{:16.4}{:16.4}{:16.5}",
                allan(1.0),
                allan(100.0),
                angle.to_degrees()
            );
        } else {
            println!("{name:34}{deviation:16.4}{:>16}{:>16}{:16.5}", "-", "-", angle.to_degrees());
        }
        panel = panel.with(Series::line(name, curve));
    }
    Figure::new("A gyroscope that stands still", Axis::time("time"))
        .subtitle("angle error of each source alone, one run")
        .panel(panel)
        .write_svg("examples/sensor_one_source/figure.svg".as_ref())?;
    Ok(())
}
