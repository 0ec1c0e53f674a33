//! The navigate study: a recorded log, levelled and turned to north by its own sensors, then free inertial navigation;
//! or with measurements beside it, see [`aided`].

pub mod aided;
mod figures;
mod pass;
mod report;
#[cfg(test)]
mod tests;

use crate::log::{LogReader, find};
use crate::record::Record;
use crate::scenario::{Navigate, Study};
use crate::{Context, Diagnostic, Error, Scenario, channel};
use pass::{Pass, Plan};

/// Runs a navigate study: averages the log over the window, finds the attitude by TRIAD (specific force first) at
/// the stated position, and navigates from the end of the window with zero velocity, in one pass over the log.
///
/// The record has `trajectory` (from the end of the window on), `log` (number of samples, mean rate and specific
/// force of the whole log and of the window) and, where the log is stationary, `errors` against the known point.
///
/// # Errors
/// The log is not there, is wrong somewhere, ends within the window, or gives no attitude.
pub fn run(scenario: &Scenario, context: &Context) -> Result<Record, Error> {
    let Study::Navigate(navigate) = &scenario.study else {
        return Err(Error::Unsupported { what: format!("study {} as navigate", scenario.study.name()) });
    };
    if navigate.start.velocity != [0.0; 3] {
        return Err(Diagnostic::new(&scenario.file, "a velocity at the start of an alignment by averaging")
            .path("start.velocity")
            .expected("a vehicle at rest while the window lasts: leave `velocity` out")
            .into());
    }
    let plan = plan(navigate, scenario.output.every);
    let file = find(&navigate.log, context.data.as_deref(), &scenario.file)?;
    let mut pass = Pass::new(&plan);
    for sample in LogReader::open(&navigate.log, &file)?.watched(context.progress) {
        pass.sample(&sample?).map_err(|fault| no_attitude(navigate.align.window, &file, fault))?;
    }
    let Some(outcome) = pass.finish() else {
        let (begin, end) = (navigate.align.window[0], navigate.align.window[1]);
        let rows = pass.whole.count;
        return Err(Diagnostic::new(&file, "the log ends within the alignment window")
            .expected(format!("more than {end} s of data, because `align.window` is [{begin} s, {end} s]"))
            .found(format!("{rows} rows, which are {} s at {} Hz", rows as f64 * plan.dt, navigate.log.rate))
            .into());
    };
    Ok(report::record(scenario, navigate, &plan, &pass, &outcome))
}

/// What the pass over the log needs to know, in samples.
fn plan(navigate: &Navigate, every: Option<f64>) -> Plan {
    let (position, gravity) = (navigate.start.position, navigate.mechanization.gravity);
    let rate = navigate.log.rate;
    let vertical = channel::vertical(&navigate.mechanization, position);
    let samples = |seconds: f64| (seconds * rate).round() as u64;
    let window = navigate.align.window.map(samples);
    Plan {
        position,
        gravity,
        mechanization: navigate.mechanization,
        vertical,
        dt: 1.0 / rate,
        window,
        last: navigate.duration.map(|duration| window[1] + samples(duration)),
        stride: every.map_or(1, samples).max(1),
    }
}

fn no_attitude(window: [f64; 2], file: &std::path::Path, fault: pass::NoAttitude) -> Error {
    let [begin, end] = window;
    let help = "`log.scale`, `log.content` and `log.axes` say what a row means; `start.position` where it was recorded";
    Diagnostic::new(file, format!("no attitude from the window {begin} s to {end} s: {}", fault.problem))
        .expected(fault.expected)
        .found(fault.found)
        .help(help)
        .into()
}
