//! The align study: methods of alignment side by side, each beside its analytic limit.

mod adaptation;
mod ends;
mod figures;
mod fine;
mod limit;
mod log;
mod log_figures;
mod mean;
mod method;
mod observability;
mod place;
mod report;
mod run;
mod scene;
mod statistics;
#[cfg(test)]
mod tests;
mod withheld;

use rayon::prelude::*;
use schuler_imu::Stream;

use crate::record::Record;
use crate::scenario::{AlignStudy, Imu, Motion, Origin, Study};
use crate::{Context, Error, Scenario};
use limit::Limit;
use run::Trace;
use scene::Scene;
use statistics::Totals;

/// Runs whose sums are formed together; sums of groups are added in their order, so that threads change nothing.
const GROUP: u64 = 8;

/// Runs an align study.
///
/// On a simulated base every run draws sensor errors, coarse errors and the noise of what is measured, and hands the
/// same samples to all methods; run i is a pure function of scenario, seed and i. The record has `errors` (over time: the
/// first run, root mean square over all runs, the method's own standard deviation, the limit of the method), `consistency` (mean
/// NEES and NIS with their bands), `innovations` (of the first run), `observability` (of each state) and `finals` (each run at the end).
///
/// A log is cut into windows that are aligned one by one: `windows` has the attitudes found, each beside the method's own standard
/// deviation and its limit. Its first window can be navigated on from, less the sensor errors that the method knows.
///
/// # Errors
/// The IMU refuses its list of sources, a filter its settings; a log that is not there or is wrong somewhere.
pub fn run(scenario: &Scenario, context: &Context) -> Result<Record, Error> {
    let Study::Align(study) = &scenario.study else {
        return Err(Error::Unsupported { what: format!("study {} as align", scenario.study.name()) });
    };
    match &study.origin {
        Origin::Simulated { motion, imu, .. } => simulated(scenario, study, motion, imu, context),
        Origin::Log { log, window } => log::run(scenario, study, log, *window, context),
    }
}

fn simulated(
    scenario: &Scenario,
    study: &AlignStudy,
    motion: &Motion,
    imu: &Imu,
    context: &Context,
) -> Result<Record, Error> {
    let scene = Scene::new(scenario, study, motion, imu)?;
    let end = scene.rows.iter().position(|k| *k == scene.samples);
    let end = end.expect("invariant: the end of the alignment is a row");
    context.progress.begin("runs", study.runs);
    let one = |run: u64| -> Result<Vec<Trace>, Error> {
        let traces = run::run(&scene, study, imu, Stream { seed: scenario.seed, run })?;
        context.progress.advance(1);
        Ok(traces)
    };
    let first = one(0)?;
    let groups: Vec<Totals> = (0..study.runs.div_ceil(GROUP))
        .into_par_iter()
        .map(|group| {
            let mut totals = Totals::default();
            for run in group * GROUP..((group + 1) * GROUP).min(study.runs) {
                match run {
                    0 => totals.add(&first, end),
                    _ => totals.add(&one(run)?, end),
                }
            }
            Ok(totals)
        })
        .collect::<Result<_, Error>>()?;
    let mut totals = Totals::default();
    groups.into_iter().for_each(|group| totals.merge(group));

    let rocks = matches!(motion, Motion::Sway(_) | Motion::Coning(_));
    let turn = match motion {
        Motion::Positions(poses, _) if poses.len() > 1 => Some(poses[0].dwell),
        _ => None,
    };
    let sensors = (&imu.spec, &scene.input(0), scene.dt);
    let limit = Limit::new(study, sensors, scene.c_tb(0), study.velocity.noise, rocks, turn);
    Ok(report::record(scenario, study, &scene, &limit, &first, &totals, end))
}
