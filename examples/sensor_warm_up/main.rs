//! How long must a gyroscope warm up before its bias is good for a day?

use std::error::Error;

use schuler_imu::Instrument::Gyro;
use schuler_imu::{Imu, Source, Spec, Stream, Temperature, Truth};
use schuler_studies::figure::{Axis, Figure, Panel, Series};

const DEG_H: f64 = std::f64::consts::PI / 180.0 / 3600.0;
const DEG_SQRT_H: f64 = std::f64::consts::PI / 180.0 / 60.0;
const ZERO_C: f64 = 273.15;
const DT: f64 = 0.1;
const DURATION: f64 = 7200.0;

fn main() -> Result<(), Box<dyn Error>> {
    // Calibrated warm, at 45 °C: what is left there is noise.
    let mut spec = Spec::from_sources([
        Source::named(Gyro, "bias", "white", &[("density", (0.01 * DEG_SQRT_H).into())])?,
        Source::named(Gyro, "thermal", "constant", &[("value", (0.02 * DEG_H).into())])?,
        Source::named(Gyro, "thermal_2", "constant", &[("value", (5e-4 * DEG_H).into())])?,
        // 10 deg/h per K/s times a kelvin a minute is 0.17 deg/h.
        Source::named(Gyro, "thermal_rate", "constant", &[("value", (10.0 * DEG_H).into())])?,
    ])?;
    spec.calibration_temperature = ZERO_C + 45.0;
    let temperature = Temperature::WarmUp { start: ZERO_C + 5.0, end: ZERO_C + 45.0, tau: 1200.0 };
    temperature.validate()?;

    let mut imu = Imu::new(&spec, Stream { seed: 3, run: 0 })?;
    let names = [
        "gyro.bias.white.x",
        "gyro.thermal.constant.x",
        "gyro.thermal_2.constant.x",
        "gyro.thermal_rate.constant.x",
    ];
    let mut curves = [(); 4].map(|()| Vec::new());
    let mut sums = [0.0; 4];
    println!("{:>10}{:>12}{:>16}{:>16}", "t (min)", "T (°C)", "error (deg/h)", "angle (deg)");
    let (mut angle, steps, minute) = (0.0, (DURATION / DT) as usize, (60.0 / DT) as usize);
    for k in 0..steps {
        let t = k as f64 * DT;
        let truth = Truth::rates([0.0; 3], [0.0, 0.0, -9.81]).at_temperature(&temperature, t, DT);
        angle += imu.step(DT, &truth).dtheta[0];
        for (component, error) in imu.ledger() {
            if let Some(which) = names.iter().position(|n| component.to_string() == *n) {
                sums[which] += error[0] / minute as f64;
            }
        }
        if (k + 1) % minute == 0 {
            let end = t + DT;
            if (k + 1) % (10 * minute) == 0 {
                let error = sums.iter().sum::<f64>() / DEG_H;
                let celsius = temperature.at(end) - ZERO_C;
                println!("{:10.0}{celsius:12.2}{error:16.4}{:16.5}", end / 60.0, angle.to_degrees());
            }
            for (curve, sum) in curves.iter_mut().zip(&mut sums) {
                curve.push([end, *sum / DEG_H]);
                *sum = 0.0;
            }
        }
    }
    let mut panel = Panel::new(Axis::linear("rate error, means of a minute (deg/h)"));
    for (name, curve) in names.iter().zip(curves) {
        panel = panel.with(Series::line(*name, curve));
    }
    let warm = (0..=120).map(|m| 60.0 * f64::from(m)).map(|t| [t, temperature.at(t) - ZERO_C]);
    Figure::new("Warming up a gyroscope", Axis::time("time"))
        .subtitle("contribution of each source by the ledger")
        .panel(panel)
        .panel(Panel::new(Axis::linear("temperature (°C)")).with(Series::line("temperature", warm)))
        .write_svg("examples/sensor_warm_up/figure.svg".as_ref())?;
    Ok(())
}
