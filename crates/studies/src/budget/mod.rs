//! The budget study: how much of the navigator's error comes from which source, several ways side by side.

mod agreement;
mod aided;
mod alignment;
mod closed_form;
mod columns;
mod covariance;
mod figures;
mod monte_carlo;
mod passage;
mod radius;
mod report;
mod requirement;
mod rounding;
mod scene;
mod shared;
mod source;
mod stepper;
mod subject;
#[cfg(test)]
mod tests;

pub use columns::Columns;
pub(crate) use radius::radius;

use crate::{Context, Diagnostic, Error, Scenario, record::Record, scenario::Budget};
use agreement::Agreement;
use figures::Beginning;
use scene::Scene;
use shared::Shared;
use source::{Nine, Source};

/// A way in which a row is obtained.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Joint covariance of the navigation errors and the states of the source.
    Covariance,
    /// One response of constants and initial errors by the transition matrices of the error dynamics.
    Columns,
    /// One pass backward from the last row.
    Adjoint,
    /// Closed form on the ellipsoid; at rest with the height held.
    Exact,
    /// Mean square over runs of the full navigator, with its filter where there is one.
    MonteCarlo,
    /// What the filter itself believes, of all together.
    Sigma,
}

impl Way {
    /// The word in `budget.csv`.
    pub fn name(self) -> &'static str {
        match self {
            Way::Covariance => "covariance",
            Way::Columns => "columns",
            Way::Adjoint => "adjoint",
            Way::Exact => "exact",
            Way::MonteCarlo => "monte_carlo",
            Way::Sigma => "sigma",
        }
    }
}

/// What one way says about one row: covariances from row `first` of the scene on.
struct Said {
    way: Way,
    first: usize,
    p: Vec<Nine>,
}

/// All ways of one source, or of all together.
struct Contribution {
    name: String,
    said: Vec<Said>,
}

impl Contribution {
    fn of(&self, way: Way) -> Option<&[Nine]> {
        self.said.iter().find(|s| s.way == way).map(|s| &s.p[..])
    }
}

/// The row of all sources together.
const TOTAL: &str = "total";

/// The row of what a filter believes of all together, in the summary.
const BELIEVED: &str = "total, as the filter believes";

/// Samples of a motion that Monte Carlo runs keep in memory.
const MOST_SAMPLES: u64 = 2_000_000;

/// Latitude beyond which north and heading have no meaning, deg: what is small in the local level is large there.
const NEAREST_POLE: f64 = 89.99;

/// Rows times sources, at most: radii of so many take minutes.
const MOST_CELLS: usize = 300_000;

/// Runs a budget study.
///
/// Each component of an error source, each initial error and each component of the noise of a measurement is a row, of one
/// standard deviation (a fixed value counts as one of its size), independent of all others: the rows sum to the total in
/// variance. Every row is obtained by covariance, and by all other [`Way`]s that know it. After an alignment a sensor error
/// includes the tilt and the heading that it caused; with a filter every row is what the filter's gains leave of it.
///
/// # Errors
/// Nothing to budget; more samples than Monte Carlo can keep; a run without numbers.
pub fn run(scenario: &Scenario, study: &Budget, context: &Context) -> Result<Record, Error> {
    let scene = Scene::new(study, scenario.output.every);
    let sources = source::sources(study);
    possible(scenario, &scene, &sources)?;
    let units = match (study.runs, study.runs_of_each) {
        (0, _) => 0,
        (_, true) => sources.len() as u64 + 1,
        (_, false) => 1,
    };
    context.progress.begin("budget", 1 + units);
    let mut contributions = linear(&scene, &sources)?;
    context.progress.advance(1);
    let mut own = 0.0;
    if study.runs > 0 {
        let track = monte_carlo::Track::new(&scene)?;
        own = track.own_horizontal();
        let each = study.runs_of_each;
        for (k, contribution) in
            contributions.iter_mut().enumerate().skip(if each { 0 } else { sources.len() })
        {
            let together = sources.get(k).map_or(&sources[..], std::slice::from_ref);
            let p = monte_carlo::covariance(&scene, &track, together, scenario.seed)?;
            contribution.said.push(Said { way: Way::MonteCarlo, first: 0, p });
            context.progress.advance(1);
        }
    }

    let subjects = subject::subjects(&scene, &scenario.expect, &contributions);
    let mut record = Record::new(scenario, report::summary(&scene, &contributions, subjects[0]));
    record.tables.push(report::table(&scene, &contributions));
    let agreement = Agreement::new(&scene, &sources, &contributions, own);
    record.tables.extend(agreement.as_ref().map(|agreement| agreement.table(&scene)));
    record.notes = report::notes(&scene, &contributions, agreement.as_ref(), &subjects);
    if let Some(requirement) = &study.requirement {
        let (tables, notes) = requirement::requirement(&scene, &sources, &contributions, requirement);
        record.tables.extend(tables);
        record.notes.extend(notes);
    }
    if scenario.output.formats.png || scenario.output.formats.svg {
        let early = scene.beginning();
        let beginning = Beginning { scene: &early, contributions: &linear(&early, &sources)? };
        record.figures = figures::figures(&scenario.title, &subjects, &scene, &contributions, &beginning);
    }
    Ok(record)
}

/// All ways but runs; the last contribution is the total.
///
/// # Errors
/// A filter meets numbers that make no sense.
fn linear(scene: &Scene, sources: &[Source]) -> Result<Vec<Contribution>, Error> {
    let square = |rows: &[[f64; 9]]| rows.iter().map(columns::covariance).collect::<Vec<_>>();
    let shared = Shared::new(sources);
    let firsts: Vec<Source> = shared.firsts.iter().map(|k| sources[*k].clone()).collect();
    let mut own = None;
    let (forward, responses, backward) = match &scene.study.filter {
        Some(filter) => {
            let found = aided::linear(scene, filter, &firsts)?;
            own = Some(Said { way: Way::Sigma, first: 0, p: found.own });
            (found.covariance, found.columns, found.adjoint)
        }
        None => (
            covariance::covariance(scene, &firsts),
            columns::responses(scene, &firsts),
            covariance::adjoint(scene, &firsts),
        ),
    };
    let all = sources.iter().zip(&shared.of).map(|(source, &(k, times))| {
        let scaled = |p: &[Nine]| p.iter().map(|p| p * (times * times)).collect::<Vec<_>>();
        let mut said = vec![Said { way: Way::Covariance, first: 0, p: scaled(&forward[k]) }];
        if !responses[k].is_empty() {
            said.push(Said { way: Way::Columns, first: 0, p: scaled(&square(&responses[k])) });
        }
        let last = scaled(&backward[k..=k]);
        said.push(Said { way: Way::Adjoint, first: scene.rows.len() - 1, p: last });
        if let Some(response) = closed_form::response(scene, source) {
            said.push(Said { way: Way::Exact, first: 0, p: square(&response) });
        }
        Contribution { name: source.name.clone(), said }
    });
    let mut all: Vec<Contribution> = all.collect();
    // A way has a total where it knows every row.
    let mut total = Contribution { name: TOTAL.into(), said: Vec::new() };
    for way in [Way::Covariance, Way::Columns, Way::Adjoint, Way::Exact] {
        let rows: Option<Vec<&Said>> = all.iter().map(|c| c.said.iter().find(|s| s.way == way)).collect();
        let Some(first) = rows.as_ref().and_then(|rows| rows.first()) else { continue };
        let (first, len) = (first.first, first.p.len());
        let sum = |k: usize| rows.iter().flatten().map(|s| s.p[k]).sum::<Nine>();
        total.said.push(Said { way, first, p: (0..len).map(sum).collect() });
    }
    total.said.extend(own);
    all.push(total);
    Ok(all)
}

fn possible(scenario: &Scenario, scene: &Scene, sources: &[Source]) -> Result<(), Error> {
    if sources.is_empty() {
        return Err(Diagnostic::new(&scenario.file, "a budget of nothing")
            .path("imu")
            .expected("error sources, or `budget: { initial_sigmas: … }`")
            .example("gyro: [{ bias: { constant: { sigma: 0.01 deg/h } } }]")
            .into());
    }
    let lat = scene.study.start.position.lat.to_degrees();
    if lat.abs() > NEAREST_POLE {
        return Err(Diagnostic::new(&scenario.file, "neither north nor heading at a pole")
            .path("start.position.lat")
            .expected(format!("a latitude within {NEAREST_POLE} deg"))
            .found(format!("{lat} deg"))
            .into());
    }
    let cells = scene.rows.len() * (sources.len() + 1);
    if cells > MOST_CELLS {
        return Err(Diagnostic::new(&scenario.file, "more rows than a budget can keep")
            .path("output.every")
            .expected(format!(
                "at most {} rows of {} sources and their total",
                MOST_CELLS / (sources.len() + 1),
                sources.len()
            ))
            .found(format!("{} rows", scene.rows.len()))
            .example("output: { every: 10 s }")
            .into());
    }
    if let Some(fault) = scene.study.filter.as_ref().and_then(|filter| aided::too_large(scene, filter)) {
        return Err(Diagnostic::new(&scenario.file, format!("no such filter: {fault}"))
            .path("budget.filter")
            .expected(format!("at most {} states", aided::MOST_STATES))
            .into());
    }
    if scene.study.runs > 0 && !scene.steady && scene.study.samples > MOST_SAMPLES {
        return Err(Diagnostic::new(&scenario.file, "more samples of a motion than runs can keep")
            .path("budget.runs")
            .expected(format!("at most {MOST_SAMPLES} samples, or `motion: static`"))
            .found(format!("{} samples", scene.study.samples))
            .into());
    }
    Ok(())
}
