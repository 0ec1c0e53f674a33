//! Runs beside the covariance: how many of the variances are outside their band, and what chance leaves outside; and columns
//! beside the covariance.

use std::f64::consts::FRAC_1_SQRT_2;

use super::report::{band, sigma, total};
use super::scene::Scene;
use super::source::{Kind, Source};
use super::{Contribution, Way};
use crate::record::{Cell, Table, columns};

/// Part of the total variance below which that of a source is not judged by runs: what linear theory leaves of it is smaller
/// than what the second order does.
const JUDGED: f64 = 1e-6;

/// The same through a filter. It takes out what was large at first (degrees of heading), of which the second order stays.
const JUDGED_AIDED: f64 = 4e-4;

/// Share of the variances that chance alone leaves outside their 99 % band.
const OUTSIDE: f64 = 0.01;

/// The row of all others.
const ALL: &str = "all";

/// Part of the total in standard deviation by which columns may be off the covariance: no picture and no decision would show it.
const OFF: f64 = 1e-4;

/// Variances of the last row that runs have found, over those of the covariance, and columns beside it.
pub struct Agreement {
    runs: u64,
    /// Part of the total variance below which nothing is judged.
    least: f64,
    /// Horizontal error at the end of a run in which nothing is wrong, m.
    own: f64,
    rows: Vec<Row>,
}

/// Those of one source, or of the total.
struct Row {
    name: String,
    /// Of each error that is judged.
    ratios: Vec<f64>,
    outside: usize,
    /// How far columns are off the covariance, in standard deviations of the total; NaN where there are none.
    off: f64,
    /// Numbers drawn for a run that its errors depend on: one of what is constant, whose errors all agree or all do not.
    /// None for the total, which has no draws of its own.
    draws: Option<Draws>,
}

#[derive(Clone, Copy, PartialEq)]
enum Draws {
    One,
    Many,
}

impl Agreement {
    /// What there is to judge, and the horizontal error `own` (m) of a run in which nothing is wrong; `None` without rows.
    pub fn new(
        scene: &Scene,
        sources: &[Source],
        contributions: &[Contribution],
        own: f64,
    ) -> Option<Agreement> {
        let runs = scene.study.runs;
        let whole = total(contributions).last()?;
        let least = if scene.study.filter.is_some() { JUDGED_AIDED } else { JUDGED };
        let row = |(k, c): (usize, &Contribution)| {
            let p = c.of(Way::Covariance)?.last()?;
            let judged = (0..9).filter(|&k| p[(k, k)] > least * whole[(k, k)]);
            let found = c.of(Way::MonteCarlo).and_then(|q| q.last());
            let ratios: Vec<f64> =
                found.map_or(Vec::new(), |q| judged.map(|k| q[(k, k)] / p[(k, k)]).collect());
            let outside = outside(&ratios, runs);
            let off = off(c, contributions);
            let draws = sources.get(k).map(|source| match source.kind {
                Kind::Initial(_) => Draws::One,
                Kind::Sensor(_) if source.size().is_some() => Draws::One,
                Kind::Sensor(_) | Kind::Noise(_) => Draws::Many,
            });
            Some(Row { name: c.name.clone(), ratios, outside, off, draws })
        };
        let rows: Vec<Row> = contributions.iter().enumerate().filter_map(row).collect();
        (!rows.is_empty()).then_some(Agreement { runs, least, own, rows })
    }

    /// `agreement.csv`.
    pub fn table(&self, scene: &Scene) -> Table {
        let mut table = Table::new("agreement", &columns::AGREEMENT, &["source"]);
        let t = scene.rows.last().map_or(0.0, |&k| scene.time(k));
        let mut push = |name: &str, ratios: &[f64], outside: usize, chance: f64, off: f64| {
            let cells: [Cell; 9] = [
                t.into(),
                name.into(),
                (ratios.len() as f64).into(),
                (outside as f64).into(),
                ratios.iter().copied().fold(f64::NAN, f64::min).into(),
                ratios.iter().copied().fold(f64::NAN, f64::max).into(),
                self.worst(ratios).into(),
                chance.into(),
                off.into(),
            ];
            table.push(&cells);
        };
        for row in &self.rows {
            let chance = row.draws.map_or(f64::NAN, |_| if row.outside > 0 { row.chance() } else { 1.0 });
            let chance = if row.ratios.is_empty() { f64::NAN } else { chance };
            push(&row.name, &row.ratios, row.outside, chance, row.off);
        }
        let all: Vec<f64> = self.rows.iter().flat_map(|row| row.ratios.iter().copied()).collect();
        let chance = if all.is_empty() { f64::NAN } else { self.chance() };
        push(ALL, &all, self.outside(), chance, self.off());
        table
    }

    /// In sentences: of runs, where there are any, and of columns.
    pub fn notes(&self) -> Vec<String> {
        let off = self.off();
        let columns = || {
            let word = if off <= OFF { "they agree" } else { "NOT CONSISTENT" };
            format!(
                "Sensitivity columns of constant sources are off the covariance by {off:.1e} of the total standard deviation at most, at any time and of any error; {word}"
            )
        };
        let runs = (self.runs > 0).then(|| self.note());
        runs.into_iter().chain(off.is_finite().then(columns)).collect()
    }

    /// The largest by which columns are off; NaN without any.
    pub fn off(&self) -> f64 {
        self.rows.iter().map(|row| row.off).fold(f64::NAN, f64::max)
    }

    fn note(&self) -> String {
        let [low, high] = band(self.runs);
        let all: Vec<f64> = self.rows.iter().flat_map(|row| row.ratios.iter().copied()).collect();
        let (worst, chance) = (self.worst(&all), self.chance());
        let of = match self.independent().count() {
            0 => String::new(),
            n => format!(
                " ({} of {n} sources have one; so many or more: probability {chance:.3} at most)",
                self.independent().filter(|row| row.outside > 0).count()
            ),
        };
        format!(
            "Monte Carlo of {} runs: {} of {} variances of the last row are outside their 99 % chi-square band [{low:.4}, {high:.4}] about the covariance{of}; the furthest of them: probability {worst:.3} at most; {} (below {} % of the total in standard deviation is second order and not judged; what the algorithm leaves without any error, {:.3} m at the end, is taken out)",
            self.runs,
            self.outside(),
            all.len(),
            if worst.min(chance) >= OUTSIDE { "they agree" } else { "NOT CONSISTENT" },
            100.0 * self.least.sqrt(),
            self.own,
        )
    }

    fn outside(&self) -> usize {
        self.rows.iter().map(|row| row.outside).sum()
    }

    /// Sources with draws of their own and something to judge.
    fn independent(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| row.draws.is_some() && !row.ratios.is_empty())
    }

    /// Probability, at most, that one or more of so many ratios are as far from one as the furthest of them (Bonferroni: whatever
    /// hangs together).
    fn worst(&self, ratios: &[f64]) -> f64 {
        if ratios.is_empty() {
            return f64::NAN;
        }
        let least = ratios.iter().map(|ratio| self.tail(*ratio)).fold(1.0, f64::min);
        (least * ratios.len() as f64).min(1.0)
    }

    /// Probability of a ratio as far from one, by the cube root of Wilson and Hilferty (Proc. Natl. Acad. Sci. 17, 1931).
    fn tail(&self, ratio: f64) -> f64 {
        let v = 2.0 / (9.0 * self.runs as f64);
        libm::erfc((ratio.cbrt() - (1.0 - v)).abs() / v.sqrt() * FRAC_1_SQRT_2)
    }

    /// Probability, at most, that as many sources or more have a variance outside: they are independent, and of each it is no
    /// more than the sum over its variances.
    fn chance(&self) -> f64 {
        let found = self.independent().filter(|row| row.outside > 0).count();
        at_least(found, self.independent().map(Row::chance))
    }
}

impl Row {
    /// Probability, at most, that one or more of the variances are outside.
    fn chance(&self) -> f64 {
        match self.draws {
            Some(Draws::One) => OUTSIDE,
            _ => (OUTSIDE * self.ratios.len() as f64).min(1.0),
        }
    }
}

/// How many ratios are outside the band of so many runs.
fn outside(ratios: &[f64], runs: u64) -> usize {
    if ratios.is_empty() {
        return 0;
    }
    let [low, high] = band(runs);
    ratios.iter().filter(|ratio| !(low..=high).contains(*ratio)).count()
}

/// By how much the columns of a source are off its covariance at most, over all rows and errors, in standard deviations of the
/// total; NaN without columns.
fn off(c: &Contribution, contributions: &[Contribution]) -> f64 {
    let (Some(p), Some(q)) = (c.of(Way::Covariance), c.of(Way::Columns)) else { return f64::NAN };
    let mut worst: f64 = 0.0;
    for ((p, q), whole) in p.iter().zip(q).zip(total(contributions)) {
        for k in (0..9).filter(|&k| whole[(k, k)] > 0.0) {
            worst = worst.max((sigma(p, k) - sigma(q, k)).abs() / sigma(whole, k));
        }
    }
    worst
}

/// Probability that `count` or more of independent events happen.
fn at_least(count: usize, chances: impl Iterator<Item = f64>) -> f64 {
    // Of fewer than `count`, each number of them by itself.
    let mut fewer = vec![0.0; count];
    if let Some(none) = fewer.first_mut() {
        *none = 1.0;
    }
    for p in chances {
        for k in (0..count).rev() {
            fewer[k] = fewer[k] * (1.0 - p) + if k > 0 { fewer[k - 1] * p } else { 0.0 };
        }
    }
    (1.0 - fewer.iter().sum::<f64>()).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::{Nine, Said, TOTAL};

    fn agreement(runs: u64, rows: &[(&[f64], Option<Draws>)]) -> Agreement {
        let row = |(ratios, draws): &(&[f64], Option<Draws>)| Row {
            name: String::new(),
            ratios: ratios.to_vec(),
            outside: outside(ratios, runs),
            off: f64::NAN,
            draws: *draws,
        };
        Agreement { runs, least: JUDGED, own: 0.0, rows: rows.iter().map(row).collect() }
    }

    /// Binomial: of ten at a tenth, two or more 1 - 0.9^10 - 10 0.1 0.9^9; and two unlike ones by hand.
    #[test]
    fn independent_events() {
        let two = at_least(2, std::iter::repeat_n(0.1, 10));
        assert!((two - (1.0 - 0.9f64.powi(10) - 0.9f64.powi(9))).abs() < 1e-14);
        assert!((at_least(1, [0.2, 0.5].into_iter()) - 0.6).abs() < 1e-14);
        assert!((at_least(2, [0.2, 0.5].into_iter()) - 0.1).abs() < 1e-14);
        assert_eq!(at_least(0, [0.2].into_iter()), 1.0);
    }

    /// NIST/SEMATECH e-Handbook, 1.3.6.7.4: of 100 degrees of freedom 0.5 % are below 67.328 and as many above 140.169.
    #[test]
    fn tails() {
        let a = agreement(100, &[]);
        for x in [0.67328, 1.40169] {
            assert!((a.tail(x) - 0.01).abs() < 2e-4, "{}", a.tail(x));
        }
    }

    /// Columns that are off by more than a ten thousandth of the total say so; of sources without there is nothing to say.
    #[test]
    fn columns_off_are_told() {
        let p = |sigma: f64| vec![Nine::identity() * (sigma * sigma)];
        let said = |way, sigma| Said { way, first: 0, p: p(sigma) };
        let all = |by_columns: f64| {
            let columns = vec![said(Way::Covariance, 3.0), said(Way::Columns, by_columns)];
            [
                Contribution { name: "a".into(), said: columns },
                Contribution { name: "b".into(), said: vec![said(Way::Covariance, 4.0)] },
                Contribution { name: TOTAL.into(), said: vec![said(Way::Covariance, 5.0)] },
            ]
        };
        let contributions = all(3.1);
        assert!((off(&contributions[0], &contributions) - 0.02).abs() < 1e-12);
        assert!(off(&contributions[1], &contributions).is_nan());
        let row = |off| Row { name: "a".into(), ratios: Vec::new(), outside: 0, off, draws: None };
        for (worst, word) in [(0.02, "NOT CONSISTENT"), (1e-6, "they agree")] {
            let rows = vec![row(worst), row(f64::NAN)];
            let notes = Agreement { runs: 0, least: JUDGED, own: 0.0, rows }.notes();
            assert!(notes.len() == 1 && notes[0].contains(word), "{notes:?}");
        }
    }

    /// What is one draw counts once; a wrong covariance is told by one variance far out, and by many sources a little out.
    #[test]
    fn disagreement_is_told() {
        let good: &[f64] = &[1.0, 0.99, 1.03];
        let a = agreement(1000, &[(good, Some(Draws::One)), (good, Some(Draws::Many)), (good, None)]);
        assert!(a.outside() == 0 && a.chance() == 1.0 && a.note().contains("they agree"), "{}", a.note());
        // A standard deviation that is wrong by a tenth: 4.5 sigmas of the estimate, twice 3.4e-6.
        let far = agreement(1000, &[(&[1.0, 1.21], Some(Draws::Many)), (good, None)]);
        assert!(far.outside() == 1 && far.note().contains("NOT CONSISTENT"), "{}", far.note());
        assert!((1e-6..1e-3).contains(&far.worst(&[1.0, 1.21])));
        // 1.125 is 2.7 sigmas out: nothing in one source of ten, too much in three.
        let out: (&[f64], _) = (&[1.125; 7], Some(Draws::One));
        let one = agreement(1000, &[&[out][..], &[(good, Some(Draws::One)); 9]].concat());
        assert!(one.outside() == 7 && (one.chance() - (1.0 - 0.99f64.powi(10))).abs() < 1e-12);
        assert!(one.note().contains("they agree"), "{}", one.note());
        let three = agreement(1000, &[&[out; 3][..], &[(good, Some(Draws::One)); 7]].concat());
        assert!(three.note().contains("NOT CONSISTENT"), "{}", three.note());
    }
}
