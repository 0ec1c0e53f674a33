//! Windows of a recorded log, aligned one by one, and navigation from the first of them on.

use schuler_frames::{B, Rot, T, Vec3, earth};
use schuler_imu::Truth;
use schuler_strapdown::align::Limits;
use schuler_strapdown::filter::Tally;
use schuler_strapdown::static_base::Site;
use schuler_strapdown::{Increments, NavError, Pva, Samples};

use super::limit::Limit;
use super::log_figures;
use super::method::{Worker, begin, measure};
use super::observability;
use super::place::Place;
use super::report::{band, states, unobserved};
use super::run::Navigator;
use super::withheld::{Withheld, at_pole};
use crate::log::{LogReader, LogSpec, find};
use crate::record::{Cell, Record, Table, columns};
use crate::scenario::{AlignStudy, Coarse, MethodKind};
use crate::{Context, Diagnostic, Error, Scenario, channel};

/// Columns of the summary: attitudes over the windows, in degrees, and the spread of the heading; the method's own standard deviation of
/// heading and its limit; of filters the mean NIS a degree of freedom with its 99 % band.
const SUMMARY: [&str; 11] = [
    "method",
    "windows",
    "mean_yaw_deg",
    "sd_yaw_arcmin",
    "sd_roll_arcmin",
    "sd_pitch_arcmin",
    "own_sigma_d_arcmin",
    "limit_d_arcmin",
    "nis",
    "nis_low",
    "nis_high",
];

const ARCMIN: f64 = 10_800.0 / std::f64::consts::PI;

/// What a method has found in a window.
pub struct Window {
    /// End of the window, s.
    pub t: f64,
    pub c_tb: Rot<T, B>,
    /// Roll, pitch and yaw, rad.
    pub angles: [f64; 3],
    /// Standard deviations of phi by the method itself, rad; NaN without.
    pub sigma: [f64; 3],
    tally: Tally,
    states: Vec<f64>,
}

/// Heading of a filter within a window: time from its begin (s), yaw and its standard deviation (rad).
pub type Course = Vec<[f64; 3]>;

/// All windows.
pub struct Found {
    /// Method by method.
    pub windows: Vec<Vec<Window>>,
    /// Window by window, of the first filter.
    pub courses: Vec<Course>,
    /// Limit of each method, rad; NaN where there is none.
    pub limits: Vec<[f64; 3]>,
    /// Whether a method's heading is not shown.
    pub withheld: Vec<bool>,
}

/// Aligns each whole window of the log by every method.
pub fn run(
    scenario: &Scenario,
    study: &AlignStudy,
    spec: &LogSpec,
    window: u64,
    context: &Context,
) -> Result<Record, Error> {
    let file = find(spec, context.data.as_deref(), &scenario.file)?;
    let position = study.start.position;
    let vertical = channel::vertical(&study.mechanization, position);
    let coning = study.mechanization.coning;
    let place = Place { position, gravity: study.mechanization.gravity, vertical, coning };
    let dt = 1.0 / spec.rate;
    let stride = scenario.output.every.map_or(1, |every| (every / dt).round().max(1.0) as u64);
    let filter = study.methods.iter().position(|m| matches!(m.kind, MethodKind::Filter(_)));
    context.progress.begin("log", 1);

    let mut errors = Table::new("errors", &columns::ERRORS, &["source", "way"]);
    let mut windows: Vec<Vec<Window>> = study.methods.iter().map(|_| Vec::new()).collect();
    let mut courses: Vec<Course> = vec![Vec::new()];
    let mut failures: Vec<String> = Vec::new();
    let mut work = Work::new(study, &place, window as f64 * dt);
    let mut navigators: Vec<Option<Navigator>> = Vec::new();
    let mut k = 0u64;
    for sample in LogReader::open(spec, &file)? {
        let increments = sample?.increments;
        if k >= window && k < window + study.navigate {
            for navigator in navigators.iter_mut().flatten() {
                navigator.advance(&increments, dt);
            }
        }
        work.advance(study, &place, k % window, &increments, dt);
        k += 1;
        if let Some(Ok(worker)) = filter.map(|i| &work.workers[i])
            && (k % window).is_multiple_of(study.velocity.every)
            && let Ok(found) = worker.found(&place)
        {
            let within = (k - 1) % window + 1;
            let sigma = found.sigma.map_or(f64::NAN, |s| s[2]);
            let course = courses.last_mut().expect("invariant: one course a window");
            course.push([within as f64 * dt, found.c_tb.as_euler().yaw, sigma]);
        }
        if k.is_multiple_of(window) {
            let t = k as f64 * dt;
            for (i, method) in study.methods.iter().enumerate() {
                match work.workers[i].as_ref().map_err(String::clone).and_then(|w| Ok((w, w.found(&place)?)))
                {
                    Ok((worker, found)) => {
                        let angles = found.c_tb.as_euler();
                        windows[i].push(Window {
                            t,
                            c_tb: found.c_tb,
                            angles: [angles.roll, angles.pitch, angles.yaw],
                            sigma: found.sigma.unwrap_or([f64::NAN; 3]),
                            tally: worker.fine().map_or_else(Tally::default, |fine| fine.filter().tally()),
                            states: worker.state_sigmas(),
                        });
                    }
                    Err(why) => failures.push(format!(
                        "`{}` gave no attitude in the window that ends at {t} s: {why}",
                        method.name
                    )),
                }
            }
            if k == window && study.navigate > 0 {
                let start = Pva { position, v_t: Vec3::ZERO, c_tb: Rot::IDENTITY };
                navigators = work.workers.iter().map(|w| Navigator::from(w, &place, &start)).collect();
            }
            work = Work::new(study, &place, window as f64 * dt);
            courses.push(Vec::new());
        }
        let navigated = k.saturating_sub(window);
        if navigated > 0 && navigated <= study.navigate && navigated.is_multiple_of(stride) {
            for (method, navigator) in study.methods.iter().zip(&navigators) {
                let Some(navigator) = navigator else { continue };
                let pva = navigator.pva();
                let truth = Pva { position, v_t: Vec3::ZERO, c_tb: pva.c_tb };
                let mut e = NavError::between(&pva, &truth).as_array();
                e[6..].fill(f64::NAN);
                let mut row: Vec<Cell> =
                    vec![(navigated as f64 * dt).into(), method.name.as_str().into(), "navigated".into()];
                row.extend(e.map(Cell::from));
                errors.push(&row);
            }
        }
    }
    context.progress.advance(1);
    if k < window {
        return Err(Diagnostic::new(&file, "the log ends within the first window")
            .expected(format!("{} s of data or more, because `alignment.window` says so", window as f64 * dt))
            .found(format!("{k} rows, which are {} s at {} Hz", k as f64 * dt, spec.rate))
            .into());
    }
    // What is left over at the end is no window.
    courses.pop();
    let c_tb = windows.iter().flatten().next().map_or(Rot::IDENTITY, |window| window.c_tb);
    let (limits, withheld) = limits(study, &place, c_tb, window as f64 * dt, dt);
    let found = Found { windows, courses, limits, withheld: withheld.heading };
    let observed = observed(study, &place, c_tb);

    let mut record = Record::new(scenario, summary(study, &found));
    record.tables.push(windows_table(study, &found));
    if !errors.is_empty() {
        record.tables.push(errors);
    }
    if !observed.is_empty() {
        let ends: Vec<&[f64]> =
            found.windows.iter().map(|w| w.first().map_or(&[][..], |w| w.states.as_slice())).collect();
        record.tables.push(states(&observed, &ends));
    }
    record.notes.push(
        "Nobody knows the true attitude of a log: what is shown is how well windows agree with each other, which holds what the base itself did between them".into(),
    );
    record.notes.push(match filter {
        Some(i) => format!(
            "Nobody knows the true errors of its sensors either: the limits are those of the errors and of the velocity noise that `{}` takes them to have, for a base at rest; what stays of them is the same in all windows, and no part of the spread",
            study.methods[i].name
        ),
        None => "There is no limit: it needs the sensors' errors, and no filter here has a list of them".into(),
    });
    record.notes.extend(unobserved(&observed));
    record.notes.extend(inconsistent(study, &found));
    record.notes.extend(withheld.notes);
    record.notes.extend(failures);
    if scenario.output.formats.png || scenario.output.formats.svg {
        record.figures = log_figures::figures(&scenario.title, study, &found);
    }
    Ok(record)
}

/// The limit of each method by the list of the first filter, in the attitude found, and whose heading is withheld.
fn limits(study: &AlignStudy, place: &Place, c_tb: Rot<T, B>, t: f64, dt: f64) -> (Vec<[f64; 3]>, Withheld) {
    let settings = study.methods.iter().find_map(|m| match &m.kind {
        MethodKind::Filter(settings) if !settings.position => Some(settings),
        _ => None,
    });
    let any = study.methods.iter().find_map(|m| match &m.kind {
        MethodKind::Filter(settings) => Some(settings),
        _ => None,
    });
    let none = [f64::NAN; 3];
    let Some(known) = any else {
        let why = at_pole(&Limits::new(Site::new(place.position, place.gravity)));
        let heading = vec![why.is_some(); study.methods.len()];
        let notes = why.map(String::from).into_iter().collect();
        return (vec![none; study.methods.len()], Withheld { heading, notes });
    };
    let (s, c) = place.position.lat.sin_cos();
    let omega_b = c_tb.inverse() * earth::omega_ie_t(s, c).as_vec3();
    let f_b = c_tb.inverse() * -place.gravity.gravity_t(place.position);
    let truth = Truth::rates(omega_b.as_array(), f_b.as_array());
    let noise = settings.map_or(0.0, |settings| settings.noise);
    let limit = Limit::new(study, (&known.spec, &truth, dt), c_tb, noise, false, None);
    let withheld = Withheld::new(study, &limit, t);
    let means = limit.means(t, |_| true);
    let of = |(i, kind): (usize, &MethodKind)| {
        let mut total = limit.total(kind, &means, t);
        if withheld.heading[i] {
            total[2] = f64::NAN;
        }
        total
    };
    (study.methods.iter().map(|m| &m.kind).enumerate().map(of).collect(), withheld)
}

/// What each filter observes at rest in this attitude.
fn observed(
    study: &AlignStudy,
    place: &Place,
    c_tb: Rot<T, B>,
) -> Vec<(String, usize, observability::Observed)> {
    let filters = study.methods.iter().enumerate().filter_map(|(i, method)| match &method.kind {
        MethodKind::Filter(settings) => {
            Some((method.name.clone(), i, observability::at_rest(settings, place, &[c_tb])?))
        }
        _ => None,
    });
    filters.collect()
}

/// All methods over one window.
struct Work {
    workers: Vec<Result<Worker, String>>,
    coarse: Option<(u64, Worker)>,
    samples: Samples,
}

impl Work {
    fn new(study: &AlignStudy, place: &Place, duration: f64) -> Work {
        let coarse = match study.coarse {
            Some(Coarse::Triad(ready)) => Some((ready, Worker::mean())),
            Some(Coarse::Inertial(ready)) => Some((ready, Worker::inertial(ready as f64 / study.rate()))),
            Some(Coarse::Value(_) | Coarse::Sigma(_)) | None => None,
        };
        let workers = study.methods.iter().map(|m| Worker::new(m, place, duration)).collect();
        Work { workers, coarse, samples: Samples::new(study.mechanization.coning) }
    }

    /// Sample `k` of the window.
    fn advance(&mut self, study: &AlignStudy, place: &Place, k: u64, increments: &Increments, dt: f64) {
        let motion = self.samples.add(increments).expect("invariant: one sample an update");
        if let Some((ready, coarse)) = &mut self.coarse {
            if k == *ready {
                let begun = coarse.found(place).map(|found| found.c_tb);
                begin(&mut self.workers, &begun, place);
            }
            if k < *ready {
                coarse.advance(increments, &motion, dt);
            }
        }
        for worker in self.workers.iter_mut().flatten() {
            worker.advance(increments, &motion, dt);
        }
        if (k + 1).is_multiple_of(study.velocity.every) {
            measure(&mut self.workers, [0.0; 2], place);
        }
    }
}

/// Mean and standard deviation; NaN where there are too few.
pub fn spread(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    (mean, if values.len() < 2 { f64::NAN } else { (squares / (n - 1.0)).sqrt() })
}

impl Found {
    /// One angle (roll, pitch, yaw) of a method in all windows, about that of the first, so that none is cut at ±180 deg; and
    /// that of the first.
    pub fn about_first(&self, method: usize, axis: usize) -> (f64, Vec<f64>) {
        let windows = &self.windows[method];
        let about = windows.first().map_or(f64::NAN, |w| w.angles[axis]);
        let turn = |x: f64| x - std::f64::consts::TAU * (x / std::f64::consts::TAU).round();
        (about, windows.iter().map(|w| turn(w.angles[axis] - about)).collect())
    }
}

/// Sum of the normalized innovations squared of a method over all windows, and its degrees of freedom.
fn nis(windows: &[Window]) -> (f64, u64) {
    windows.iter().fold((0.0, 0), |(sum, n), w| (sum + w.tally.nis, n + w.tally.rows))
}

/// Filters whose innovations are not what they predict.
fn inconsistent(study: &AlignStudy, found: &Found) -> Option<String> {
    let names: Vec<String> = study
        .methods
        .iter()
        .zip(&found.windows)
        .filter_map(|(method, windows)| {
            let (sum, freedom) = nis(windows);
            let ([low, high], ratio) = (band(freedom), sum / freedom as f64);
            (freedom > 0 && !(low..=high).contains(&ratio))
                .then(|| format!("`{}` ({ratio:.3}, band {low:.3} to {high:.3})", method.name))
        })
        .collect();
    (!names.is_empty()).then(|| {
        format!(
            "Not consistent, because their mean NIS a degree of freedom is outside of its 99 % band (below it the noise they assume is too large): {}",
            names.join(", ")
        )
    })
}

fn windows_table(study: &AlignStudy, found: &Found) -> Table {
    let mut table = Table::new("windows", &columns::WINDOWS, &["source"]);
    let count = found.windows.iter().map(Vec::len).max().unwrap_or(0);
    let mut rows: Vec<(f64, usize, &Window)> = Vec::with_capacity(count * study.methods.len());
    for (i, windows) in found.windows.iter().enumerate() {
        rows.extend(windows.iter().map(|w| (w.t, i, w)));
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for (t, i, window) in rows {
        let mut row: Vec<Cell> = vec![t.into(), study.methods[i].name.as_str().into()];
        let mut numbers = [window.angles, window.sigma, found.limits[i]];
        if found.withheld[i] {
            numbers.iter_mut().for_each(|three| three[2] = f64::NAN);
        }
        row.extend(numbers.as_flattened().iter().map(|x| Cell::from(*x)));
        table.push(&row);
    }
    table
}

fn summary(study: &AlignStudy, found: &Found) -> Table {
    let mut table = Table::new("summary", &SUMMARY, &["method"]);
    for (i, method) in study.methods.iter().enumerate() {
        let windows = &found.windows[i];
        let statistics = |axis: usize| {
            let (about, values) = found.about_first(i, axis);
            let (mean, sd) = spread(&values);
            (about + mean, sd)
        };
        let n = windows.len() as f64;
        let sigma = (windows.iter().map(|w| w.sigma[2].powi(2)).sum::<f64>() / n).sqrt();
        let (yaw, sd_yaw) = statistics(2);
        let mut heading = [yaw.to_degrees(), sd_yaw * ARCMIN, sigma * ARCMIN, found.limits[i][2] * ARCMIN];
        if found.withheld[i] {
            heading = [f64::NAN; 4];
        }
        let (sum, freedom) = nis(windows);
        let nis = sum / freedom as f64;
        let [low, high] = band(freedom);
        let mut row: Vec<Cell> = vec![method.name.as_str().into(), n.into()];
        row.extend(
            [heading[0], heading[1], statistics(0).1 * ARCMIN, statistics(1).1 * ARCMIN].map(Cell::from),
        );
        row.extend([heading[2], heading[3], nis, low, high].map(Cell::from));
        table.push(&row);
    }
    table
}
