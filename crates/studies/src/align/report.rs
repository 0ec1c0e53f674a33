//! The record of an align study.

use nalgebra::Matrix3;
use schuler_strapdown::filter::chi_square;

use super::figures;
use super::limit::Limit;
use super::observability::{self, Observed};
use super::place::Place;
use super::run::Trace;
use super::scene::Scene;
use super::statistics::{Sums, Totals};
use super::withheld::Withheld;
use crate::Scenario;
use crate::record::{Cell, Record, Table, columns};
use crate::scenario::{AlignStudy, FilterSettings, MethodKind};

/// Arc minutes in a radian.
const ARCMIN: f64 = 10_800.0 / std::f64::consts::PI;

/// Columns of the summary, at the end of the alignment and in the unit of the field: root mean square over all runs, the
/// method's own standard deviation of heading, the limit of the method with its part that stays, the mean NEES a degree of
/// freedom and the mean NIS of all updates, both with their 99 % band.
const SUMMARY: [&str; 15] = [
    "method",
    "phi_n_arcmin",
    "phi_e_arcmin",
    "phi_d_arcmin",
    "own_sigma_d_arcmin",
    "limit_n_arcmin",
    "limit_e_arcmin",
    "limit_d_arcmin",
    "bias_limit_d_arcmin",
    "nees",
    "nees_low",
    "nees_high",
    "nis",
    "nis_low",
    "nis_high",
];

/// What all tables and pictures are made of.
pub struct Results<'a> {
    pub study: &'a AlignStudy,
    pub scene: &'a Scene,
    pub limit: &'a Limit,
    pub first: &'a [Trace],
    pub totals: &'a Totals,
    /// The row of the end of the alignment.
    pub end: usize,
    /// The limit of each method at each row of the alignment, rad; NaN where there is none.
    pub limits: Vec<Vec<[f64; 3]>>,
    /// Of it at the end, what stays.
    pub stays: Vec<[f64; 3]>,
    /// Means of products of phi at the end by the limit of each method, rad².
    pub squares: Vec<Matrix3<f64>>,
    pub withheld: Withheld,
}

impl<'a> Results<'a> {
    fn new(
        study: &'a AlignStudy,
        scene: &'a Scene,
        limit: &'a Limit,
        first: &'a [Trace],
        totals: &'a Totals,
        end: usize,
    ) -> Self {
        let withheld = Withheld::new(study, limit, scene.time(scene.samples));
        let means: Vec<_> =
            scene.rows[..=end].iter().map(|&k| limit.means(scene.time(k), |_| true)).collect();
        let known = |i: usize, mut phi: [f64; 3]| {
            if withheld.heading[i] {
                phi[2] = f64::NAN;
            }
            phi
        };
        let of_rows = |i: usize, kind: &MethodKind| {
            let rows = scene.rows.iter().zip(&means);
            rows.map(|(&k, means)| known(i, limit.total(kind, means, scene.time(k)))).collect()
        };
        let limits = study.methods.iter().enumerate().map(|(i, m)| of_rows(i, &m.kind)).collect();
        let one_position = !limit.turned(scene.time(scene.samples));
        let stays = study.methods.iter().enumerate().map(|(i, method)| {
            if one_position { known(i, limit.left(&method.kind, &means[end])) } else { [f64::NAN; 3] }
        });
        let stays = stays.collect();
        let t = scene.time(scene.samples);
        let squares = study.methods.iter().map(|m| limit.total_squares(&m.kind, &means[end], t)).collect();
        Results { study, scene, limit, first, totals, end, limits, stays, squares, withheld }
    }

    /// The nine errors of a method without what cannot be had.
    pub fn shown(&self, method: usize, mut errors: [f64; 9]) -> [f64; 9] {
        if self.withheld.heading[method] {
            errors[8] = f64::NAN;
        }
        errors
    }

    /// The same of its standard deviations of phi.
    pub fn sigma(&self, method: usize, row: usize) -> [f64; 3] {
        let mut sigma = self.totals.sums[method][row].sigma();
        if self.withheld.heading[method] {
            sigma[2] = f64::NAN;
        }
        sigma
    }
}

pub fn record(
    scenario: &Scenario,
    study: &AlignStudy,
    scene: &Scene,
    limit: &Limit,
    first: &[Trace],
    totals: &Totals,
    end: usize,
) -> Record {
    let results = Results::new(study, scene, limit, first, totals, end);
    let mut record = Record::new(scenario, summary(&results));
    record.tables.push(errors(&results));
    record.tables.push(consistency(&results));
    let innovations = innovations(&results);
    if !innovations.is_empty() {
        record.tables.push(innovations);
    }
    let observed = observe(study, scene, limit.rocks);
    let ends: Vec<&[f64]> = first.iter().map(|trace| trace.states.as_slice()).collect();
    record.tables.push(states(&observed, &ends));
    record.tables.push(finals(&results));
    record.notes = limit.words(scene.time(scene.samples));
    record.notes.extend(notes(&results));
    record.notes.extend(unobserved(&observed));
    record.notes.extend(results.withheld.notes.clone());
    if scenario.output.formats.png || scenario.output.formats.svg {
        record.figures = figures::figures(&scenario.title, &results);
    }
    record
}

/// 99 % band of the mean of `dof` squares of standard normals.
pub fn band(dof: u64) -> [f64; 2] {
    let n = dof as usize;
    [0.995, 0.005].map(|p| if n == 0 { f64::NAN } else { chi_square::quantile(p, n) / n as f64 })
}

fn summary(results: &Results) -> Table {
    let mut table = Table::new("summary", &SUMMARY, &["method"]);
    let end = results.end;
    for (i, (method, rows)) in results.study.methods.iter().zip(&results.totals.sums).enumerate() {
        let sums = &rows[end];
        let (rms, total) = (results.shown(i, sums.rms()), results.limits[i][end]);
        let nees = if results.withheld.heading[i] { 0 } else { sums.with_nees };
        let ratio = if nees > 0 { sums.nees_ratio() } else { f64::NAN };
        let (nis, freedom) = sums.nis_since(None);
        let mut row: Vec<Cell> = vec![method.name.as_str().into()];
        let sigma = results.sigma(i, end)[2];
        let angles = [rms[6], rms[7], rms[8], sigma, total[0], total[1], total[2], results.stays[i][2]];
        row.extend(angles.map(|x| Cell::from(x * ARCMIN)));
        let ([low, high], [least, most]) = (band(3 * nees), band(freedom));
        row.extend([ratio, low, high, nis, least, most].map(Cell::from));
        table.push(&row);
    }
    table
}

/// Over time and method: the first run, root mean squares, own standard deviations, the limit.
fn errors(results: &Results) -> Table {
    let Results { study, scene, .. } = *results;
    let mut table = Table::new("errors", &columns::ERRORS, &["source", "way"]);
    let mut push = |k: u64, source: &str, way: &str, errors: [f64; 9]| {
        let mut row: Vec<Cell> = vec![scene.time(k).into(), source.into(), way.into()];
        row.extend(errors.map(Cell::from));
        table.push(&row);
    };
    let attitude = |phi: [f64; 3]| {
        let mut errors = [f64::NAN; 9];
        errors[6..].copy_from_slice(&phi);
        errors
    };
    for (i, method) in study.methods.iter().enumerate() {
        for (j, &k) in scene.rows.iter().enumerate() {
            let sums: &Sums = &results.totals.sums[i][j];
            push(k, &method.name, "run", results.shown(i, results.first[i].rows[j].error.as_array()));
            if study.runs > 1 {
                push(k, &method.name, "rms", results.shown(i, sums.rms()));
            }
            if k <= scene.samples {
                if matches!(method.kind, MethodKind::Filter(_) | MethodKind::AnyHeading(_)) {
                    push(k, &method.name, "sigma", attitude(results.sigma(i, j)));
                }
                push(k, &method.name, "limit", attitude(results.limits[i][j]));
            }
        }
    }
    table
}

/// Of methods with a covariance: mean NEES a degree of freedom with its band, the square of the heading error over that of its
/// standard deviation with its own, and NIS. Where heading cannot be had nothing but NIS, which looks at what is measured.
fn consistency(results: &Results) -> Table {
    let mut table = Table::new("consistency", &columns::CONSISTENCY, &["source"]);
    for (i, (method, rows)) in results.study.methods.iter().zip(&results.totals.sums).enumerate() {
        for (j, &k) in results.scene.rows[..=results.end].iter().enumerate() {
            let sums = &rows[j];
            if sums.with_nees == 0 {
                continue;
            }
            let ([low, high], [least, most]) = (band(3 * sums.with_nees), band(sums.count));
            let heading = (sums.rms()[8] / sums.sigma()[2]).powi(2);
            let mut numbers = [sums.nees_ratio(), low, high, heading, least, most];
            if results.withheld.heading[i] {
                numbers = [f64::NAN; 6];
            }
            let (nis, freedom) = sums.nis_since(j.checked_sub(1).map(|before| &rows[before]));
            let [lowest, highest] = band(freedom);
            let mut row: Vec<Cell> = vec![results.scene.time(k).into(), method.name.as_str().into()];
            row.extend(numbers.into_iter().chain([nis, lowest, highest]).map(Cell::from));
            table.push(&row);
        }
    }
    table
}

/// Of the first run: the last innovations before each row, computed minus measured, and their predicted standard deviations.
fn innovations(results: &Results) -> Table {
    let names = ["t_s", "source", "innovation_n", "innovation_e", "sigma_n", "sigma_e"];
    let mut table = Table::new("innovations", &names, &["source"]);
    for (method, trace) in results.study.methods.iter().zip(results.first) {
        for (row, &k) in trace.rows[..=results.end].iter().zip(&results.scene.rows) {
            let numbers = row.innovation.as_flattened();
            if numbers.iter().all(|x| x.is_finite()) {
                let mut cells: Vec<Cell> = vec![results.scene.time(k).into(), method.name.as_str().into()];
                cells.extend(numbers.iter().map(|x| Cell::from(*x)));
                table.push(&cells);
            }
        }
    }
    table
}

/// What each filter can observe at all: at rest exactly, one position after the other; of a base that rocks by the run.
fn observe(study: &AlignStudy, scene: &Scene, rocks: bool) -> Vec<(String, usize, Observed)> {
    let coning = study.mechanization.coning;
    let place = Place { position: scene.position, gravity: scene.gravity, vertical: scene.vertical, coning };
    let every = study.velocity.every;
    let dwells = scene.dwells(every);
    let of = |settings: &FilterSettings| {
        if rocks {
            observability::rocking(settings, &place, scene, every)
        } else {
            observability::at_rest(settings, &place, &dwells)
        }
    };
    let filters = study.methods.iter().enumerate().filter_map(|(i, method)| match &method.kind {
        MethodKind::Filter(settings) => Some((method.name.clone(), i, of(settings)?)),
        _ => None,
    });
    filters.collect()
}

/// States of each filter: standard deviation at the start, at the end (of each method, `ends`), and what [`observability::State::limit`] is.
pub fn states(observed: &[(String, usize, Observed)], ends: &[&[f64]]) -> Table {
    let names = ["source", "state", "start", "end", "limit", "limit_ratio"];
    let mut table = Table::new("observability", &names, &["source", "state"]);
    for (name, i, observed) in observed {
        for (k, state) in observed.states.iter().enumerate() {
            let end = ends[*i].get(k).copied().unwrap_or(f64::NAN);
            let numbers = [state.start, end, state.limit, state.limit / state.start];
            let mut row: Vec<Cell> = vec![name.as_str().into(), state.name.as_str().into()];
            row.extend(numbers.map(Cell::from));
            table.push(&row);
        }
    }
    table
}

/// Rank and unobservable combinations, once for filters that share them.
pub fn unobserved(observed: &[(String, usize, Observed)]) -> Vec<String> {
    let mut said: Vec<(Vec<&str>, String)> = Vec::new();
    for (name, _, observed) in observed {
        let Observed { rank, of, unseen, rocks, .. } = observed;
        let list = unseen.iter().map(|v| format!("({v})")).collect::<Vec<_>>().join(", ");
        let text = match (unseen.is_empty(), rocks) {
            (true, _) => format!("observes all of its {of} states"),
            (false, false) => {
                format!("observes {rank} of {of} combinations of its states (SI units); never: {list}")
            }
            (false, true) => format!(
                "observes {rank} of {of} combinations of its states (SI units) by more than half of their variance; of the others the rocking tells less, even without noise of the sensors: {list}"
            ),
        };
        match said.iter_mut().find(|(_, same)| *same == text) {
            Some((names, _)) => names.push(name),
            None => said.push((vec![name], text)),
        }
    }
    said.iter().map(|(names, text)| format!("`{}` {text}", names.join("`, `"))).collect()
}

/// Each run at the end of the alignment.
fn finals(results: &Results) -> Table {
    let names = ["run_count", "source", "final_phi_n_rad", "final_phi_e_rad", "final_phi_d_rad"];
    let mut table = Table::new("finals", &names, &["source"]);
    for (i, (method, finals)) in results.study.methods.iter().zip(&results.totals.finals).enumerate() {
        for (run, &[n, e, d]) in finals.iter().enumerate() {
            let d = if results.withheld.heading[i] { f64::NAN } else { d };
            table.push(&[(run as f64).into(), method.name.as_str().into(), n.into(), e.into(), d.into()]);
        }
    }
    table
}

/// What a reader of the numbers must know.
fn notes(results: &Results) -> Vec<String> {
    let Results { study, totals, .. } = *results;
    let mut notes = Vec::new();
    for method in study.methods.iter().filter(|m| matches!(m.kind, MethodKind::AnyHeading(_))) {
        notes.push(format!(
            "The own standard deviation of `{}` is that of noise alone: constant errors of the sensors, which no alignment in one position tells from attitude, are no states of it and come on top (bias limit)",
            method.name
        ));
    }
    for (method, (count, why)) in study.methods.iter().zip(&totals.failures) {
        if let Some(why) = why {
            notes
                .push(format!("`{}` gave no attitude in {count} of {} runs: {why}", method.name, study.runs));
        }
    }
    let outside = |what: &str, of: &dyn Fn(usize, &Sums) -> (f64, u64)| {
        let all = study.methods.iter().zip(&totals.sums).enumerate();
        let names: Vec<String> = all
            .filter_map(|(i, (method, rows))| {
                let (ratio, freedom) = of(i, &rows[results.end]);
                let [low, high] = band(freedom);
                (freedom > 0 && !(low..=high).contains(&ratio))
                    .then(|| format!("`{}` ({ratio:.3}, band {low:.3} to {high:.3})", method.name))
            })
            .collect();
        (!names.is_empty()).then(|| {
            format!(
                "Not consistent, because their mean {what} a degree of freedom is outside of its 99 % band: {}",
                names.join(", ")
            )
        })
    };
    let nees = |i: usize, sums: &Sums| match results.withheld.heading[i] {
        true => (f64::NAN, 0),
        false => (sums.nees_ratio(), 3 * sums.with_nees),
    };
    notes.extend(outside("NEES", &nees));
    notes.extend(outside("NIS", &|_, sums| sums.nis_since(None)));
    notes
}
