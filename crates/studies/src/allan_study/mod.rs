//! The Allan study: deviations of a recorded log at rest, and the error model that they show.

mod axis;
mod figures;
mod notes;
mod report;
#[cfg(test)]
mod tests;

use rayon::prelude::*;

use crate::log::{LogReader, find};
use crate::record::Record;
use crate::scenario::Study;
use crate::{Context, Error, Scenario};
use axis::{Axis, Channel, KEPT};

/// Runs an Allan study: reads the log once, estimates the deviations of each sensor axis, fits the error model.
///
/// Up to four million samples are kept, for all estimators on a fine grid; beyond, the overlapping deviation at
/// octaves is made on the way in memory that does not grow ([`schuler_allan::Pyramid`] states its price in variance). The
/// axes are those of the body, by `log.axes`; a log may lack some of them.
///
/// The record has `allan_gyro` and `allan_accel` (every estimate with its 95 % interval), `parameters` (SI), the summary
/// in the units of the field, a picture of each axis, and `sources.yaml`, which goes into a scenario as `imu`.
///
/// # Errors
/// The log is not there or is wrong somewhere: a NaN, a short row, time that runs back or has a gap.
pub fn run(scenario: &Scenario, context: &Context) -> Result<Record, Error> {
    let Study::Allan(log) = &scenario.study else {
        return Err(Error::Unsupported { what: format!("study {} as allan", scenario.study.name()) });
    };
    let file = find(log, context.data.as_deref(), &scenario.file)?;
    let mut channels = Channel::all(log, KEPT);
    for sample in LogReader::open(log, &file)?.watched(context.progress) {
        let increments = sample?.increments;
        for channel in &mut channels {
            channel.push(&increments);
        }
    }
    context.progress.begin("fit", channels.len() as u64);
    let axes: Vec<Axis> = channels
        .into_par_iter()
        .map(|channel| {
            let axis = channel.finish();
            context.progress.advance(1);
            axis
        })
        .collect();
    Ok(report::record(scenario, &axes))
}
