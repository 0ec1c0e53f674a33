//! Pictures of a simulated motion.

use schuler_frames::{Geodetic, position_error};

use crate::{
    Scenario,
    figure::{Axis, Figure, Panel, Quantity, Series},
    record::Table,
    scenario::Simulate,
};

/// Attitude, velocity and height over time, and the track from above.
pub fn figures(scenario: &Scenario, study: &Simulate, states: &Table) -> Vec<(String, Figure)> {
    let column = |name: &str| states.numbers(name).unwrap_or_default();
    let times = column("t_s");
    let conditions = format!(
        "{}, latitude {:.4}°, {} Hz",
        study.motion.words(),
        study.start.position.lat.to_degrees(),
        study.imu.rate
    );
    let figure = |what: &str, x: Axis| {
        Figure::new(format!("{}: {what}", scenario.title), x).subtitle(conditions.clone())
    };
    let line = |name: &str, values: &[f64], factor: f64| {
        Series::line(name, times.iter().zip(values).map(|(t, x)| [*t, x * factor]))
    };

    let degrees = 180.0 / std::f64::consts::PI;
    let mut attitude = figure("attitude", Axis::time("time"));
    for (label, name) in
        [("roll (deg)", "roll_rad"), ("pitch (deg)", "pitch_rad"), ("heading (deg)", "yaw_rad")]
    {
        attitude = attitude.panel(Panel::new(Axis::linear(label)).with(line("", column(name), degrees)));
    }

    let mut motion = figure("velocity and height", Axis::time("time"));
    let velocity = Panel::new(Axis::linear("velocity (m/s)"))
        .with(line("north", column("v_n_mps"), 1.0))
        .with(line("east", column("v_e_mps"), 1.0))
        .with(line("down", column("v_d_mps"), 1.0));
    motion = motion.panel(velocity);
    motion = motion.panel(Panel::new(Axis::linear("height (m)")).with(line("", column("h_m"), 1.0)));

    let mut all = vec![("attitude".to_string(), attitude), ("motion".to_string(), motion)];
    let (lat, lon, h) = (column("lat_rad"), column("lon_rad"), column("h_m"));
    let ways: Vec<[f64; 2]> = lat
        .iter()
        .zip(lon)
        .zip(h)
        .map(|((lat, lon), h)| {
            let way = position_error(Geodetic::new(*lat, *lon, *h), study.start.position);
            [way[1], way[0]]
        })
        .collect();
    let largest = ways.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    if largest > 0.0 {
        let shown = Quantity::Length.shown(largest);
        let points = ways.iter().map(|way| way.map(|x| x * shown.per_si));
        let label = |what: &str| format!("{what} ({})", shown.symbol);
        let track = figure("track", Axis::linear(label("east")))
            .panel(Panel::new(Axis::linear(label("north"))).with(Series::line("", points)))
            .equal_aspect();
        all.push(("track".to_string(), track));
    }
    all
}
