//! The drift study: what each error source does to a navigator at rest, several ways side by side.

mod case;
mod figures;
mod linear;
mod nonlinear;
mod scene;
mod summary;
#[cfg(test)]
mod tests;

use rayon::prelude::*;
use schuler_strapdown::NavError;
use schuler_strapdown::static_base::{Response, exact, single_axis};

use crate::record::{Record, Table, columns};
use crate::scenario::{Drift, Study};
use crate::{Context, Diagnostic, Error, Scenario};
use case::{Case, cases};
pub(crate) use linear::van_loan;
use linear::{Linear, Path};
use scene::Scene;

/// A way in which an effect is obtained.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Injector and full mechanization.
    Nonlinear,
    /// Half the difference of the +e and -e runs.
    HalfDifference,
    /// Transition matrices of the linear error dynamics.
    Linear,
    /// Closed form on the ellipsoid; for random sources the standard deviation by the linear covariance.
    Exact,
    /// Textbook formula, one axis at a time; for random sources the standard deviation by it.
    SingleAxis,
}

impl Way {
    /// The word in `errors.csv`.
    pub fn name(self) -> &'static str {
        columns::WAYS[self as usize]
    }
}

/// The curves of one case, one error for each row of the scene.
struct Curves {
    case: Case,
    /// Anything in it is drawn at random.
    random: bool,
    /// `exact` and `single_axis` are standard deviations.
    sigma: bool,
    ways: Vec<(Way, Vec<NavError>)>,
}

impl Curves {
    fn of(&self, way: Way) -> Option<&[NavError]> {
        self.ways.iter().find(|(w, _)| *w == way).map(|(_, rows)| &rows[..])
    }
}

/// Runs a drift study.
///
/// Each error source stands alone and all stand together. Known sources (values, ramps, initial errors) are
/// obtained in five [`Way`]s. Of random sources one sample is run non-linearly, in half-difference and
/// linearly (with the same draws), beside the standard deviation by the complete covariance (`exact`) and by
/// the single-axis one. The closed form holds for a held vertical channel only.
///
/// # Errors
/// The scenario is not a drift study, or the IMU refuses its list of sources.
pub fn run(scenario: &Scenario, context: &Context) -> Result<Record, Error> {
    let Study::Drift(drift) = &scenario.study else {
        return Err(Error::Unsupported { what: format!("study {} as drift", scenario.study.name()) });
    };
    let scene = Scene::new(drift, scenario.output.every);
    let cases = cases(drift);
    possible(scenario, drift, &scene, cases.len())?;
    context.progress.begin("drift", 2 * cases.len() as u64);
    // Cases are independent and each is a pure function of the scenario: their number of threads changes nothing.
    let curves: Result<Vec<Curves>, Error> =
        cases.into_par_iter().map(|case| curves(&scene, drift, case, scenario.seed, context)).collect();
    let curves = curves?;

    let mut record = Record::new(scenario, summary::table(&curves));
    record.tables.push(errors(&scene, &curves));
    record.tables.push(summary::extremes(&curves));
    record.notes = summary::notes(&scene, &curves);
    if scenario.output.formats.png || scenario.output.formats.svg {
        record.figures = figures::figures(&scenario.title, &scene, &curves);
    }
    Ok(record)
}

fn curves(scene: &Scene, drift: &Drift, case: Case, seed: u64, context: &Context) -> Result<Curves, Error> {
    let random = case.is_random();
    let linear = Linear::complete(scene);
    let mut ways = Vec::new();

    let (plus, sample_path) = if random {
        let step = linear.step(scene.dt);
        let mut path = Path::new(&step, &case);
        let mut rows = Vec::with_capacity(scene.rows.len());
        let mut next = scene.rows.iter().peekable();
        let plus = nonlinear::run(scene, &case, 1.0, seed, |k, sample| {
            if next.next_if_eq(&&k).is_some() {
                rows.push(path.errors());
            }
            path.advance_constant(&linear::input(sample.omega_error, sample.f_error));
        })?;
        rows.push(path.errors());
        (plus, rows)
    } else {
        let plus = nonlinear::run(scene, &case, 1.0, seed, |_, _| {})?;
        (plus, linear::propagate(&linear, scene, &case))
    };
    context.progress.advance(1);
    let minus = nonlinear::run(scene, &case, -1.0, seed, |_, _| {})?;
    context.progress.advance(1);
    let half = nonlinear::half_difference(&plus, &minus);
    ways.push((Way::Nonlinear, plus));
    ways.push((Way::HalfDifference, half));
    ways.push((Way::Linear, sample_path));

    let held = drift.mechanization.vertical == crate::scenario::Vertical::Held;
    // A random source alone has no known part: its laws are standard deviations. All together have one.
    let sigma = random && case.name != "all";
    if !sigma {
        let drivers = case.drivers(scene);
        if held {
            ways.push((Way::Exact, sampled(scene, &exact(&scene.site, &drivers))));
        }
        ways.push((Way::SingleAxis, sampled(scene, &single_axis(&scene.site, &drivers))));
    } else {
        ways.push((Way::Exact, linear.sigmas(scene, &case)));
        ways.push((Way::SingleAxis, Linear::single_axis(scene).sigmas(scene, &case)));
    }
    finite(scene, &case, &ways)?;
    Ok(Curves { case, random, sigma, ways })
}

/// Refuses what no run could answer: a place where north has no meaning, more rows than memory holds.
fn possible(scenario: &Scenario, drift: &Drift, scene: &Scene, cases: usize) -> Result<(), Error> {
    /// Beyond this the local level frame turns about the vertical faster than its error equations stay linear.
    const HIGHEST: f64 = 89.9;
    /// Rows of `errors.csv`, of 100 bytes each.
    const MOST_ROWS: usize = 20_000_000;
    let lat = drift.start.position.lat.to_degrees();
    if lat.abs() > HIGHEST {
        let fault = Diagnostic::new(&scenario.file, "the local level frame has no north this near to a pole")
            .path("start.position.lat")
            .expected(format!("at most {HIGHEST} deg north or south"))
            .found(format!("{lat} deg"))
            .example("lat: 80 deg");
        return Err(fault.into());
    }
    let rows = scene.rows.len() * cases * columns::WAYS.len();
    if rows > MOST_ROWS {
        let fault = Diagnostic::new(&scenario.file, "more rows than can be kept")
            .path("output.every")
            .expected(format!("at most {MOST_ROWS} rows of all sources and ways together"))
            .found(format!("{} rows of time, {cases} cases, {} ways", scene.rows.len(), columns::WAYS.len()))
            .example("every: 60 s");
        return Err(fault.into());
    }
    Ok(())
}

/// Refuses curves with values that are no numbers: the source drove the navigator where its equations end.
fn finite(scene: &Scene, case: &Case, ways: &[(Way, Vec<NavError>)]) -> Result<(), Error> {
    for (way, rows) in ways {
        if let Some(k) = rows.iter().position(|e| e.as_array().iter().any(|x| !x.is_finite())) {
            return Err(Error::Diverged {
                source_name: case.name.clone(),
                way: way.name(),
                time: scene.time(scene.rows[k]),
            });
        }
    }
    Ok(())
}

fn sampled(scene: &Scene, response: &Response) -> Vec<NavError> {
    let at = |&step: &u64| {
        let e = response.at(scene.time(step));
        NavError { dr: e.dr, dv: e.dv, phi: e.phi }
    };
    scene.rows.iter().map(at).collect()
}

/// Every curve in one table.
fn errors(scene: &Scene, curves: &[Curves]) -> Table {
    let mut table = Table::new("errors", &columns::ERRORS, &["source", "way"]);
    for c in curves {
        for (way, rows) in &c.ways {
            for (step, e) in scene.rows.iter().zip(rows) {
                let mut row = vec![scene.time(*step).into(), c.case.name.as_str().into(), way.name().into()];
                row.extend(e.as_array().map(crate::record::Cell::from));
                table.push(&row);
            }
        }
    }
    table
}
