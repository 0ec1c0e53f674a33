//! What a requirement asks of each source: which bind, and by how much each may grow.

use std::f64::consts::PI;

use nalgebra::Matrix2;
use schuler_imu::Unit;

use super::radius::{derivative, may_grow, radius};
use super::report::total;
use super::scene::Scene;
use super::source::Source;
use super::subject::{plane, written};
use super::{Contribution, Way};
use crate::{
    record::{self, Cell, Table, columns},
    scenario::{Required, Requirement},
};

/// Sources that a note names.
const NAMED: usize = 3;

/// What one source, or all axes of an entry of the scenario, do to one limit.
struct Part {
    name: String,
    /// Places of what it is made of among the sources.
    members: Vec<usize>,
    /// Radius of the source alone.
    alone: f64,
    /// Derivative of the radius of all by the relative size of the source.
    slope: f64,
    /// Factor by which it may grow until the limit is reached.
    may_grow: f64,
}

/// One limit, and what all and each source do to it.
struct Judged {
    of: Required,
    limit: f64,
    reached: f64,
    parts: Vec<Part>,
}

impl Judged {
    /// Part of the slope; nothing where there are no such errors.
    fn part(&self, part: &Part) -> f64 {
        if self.reached > 0.0 { part.slope / self.reached } else { 0.0 }
    }
}

/// The tables and the notes of a requirement.
pub fn requirement(
    scene: &Scene,
    sources: &[Source],
    contributions: &[Contribution],
    r: &Requirement,
) -> (Vec<Table>, Vec<String>) {
    let row = scene
        .rows
        .iter()
        .position(|&k| (scene.time(k) - r.at).abs() < 0.5 * scene.dt)
        .expect("invariant: the time of a valid requirement is that of a row");
    let judged: Vec<Judged> =
        r.limits.iter().map(|(of, limit)| judge(contributions, row, r.probability, *of, *limit)).collect();
    let tables = judged.iter().map(|j| table(scene, sources, r.at, j)).collect();
    (tables, judged.iter().map(|j| note(scene, sources, r, j)).collect())
}

fn judge(contributions: &[Contribution], row: usize, probability: f64, of: Required, limit: f64) -> Judged {
    let whole = plane(of, &total(contributions)[row]);
    let reached = radius(&whole, probability);
    let mut named: Vec<(String, Vec<usize>)> =
        contributions.iter().enumerate().map(|(k, c)| (c.name.clone(), vec![k])).collect();
    let total = named.pop_if(|(name, _)| name == super::TOTAL);
    named.extend(entries(&named));
    named.extend(total);
    let mut parts = Vec::with_capacity(named.len());
    for (name, members) in named {
        let p = |k: &usize| plane(of, &contributions[*k].of(Way::Covariance).unwrap_or_default()[row]);
        let part: Matrix2<f64> = members.iter().map(p).sum();
        parts.push(Part {
            name,
            members,
            alone: radius(&part, probability),
            slope: derivative(&whole, &part, reached),
            may_grow: may_grow(&whole, &part, probability, limit),
        });
    }
    Judged { of, limit, reached, parts }
}

/// Sources of one entry of the scenario: all axes of `gyro.bias.constant`, which are bought together.
fn entries(named: &[(String, Vec<usize>)]) -> Vec<(String, Vec<usize>)> {
    let mut entries: Vec<(String, Vec<usize>)> = Vec::new();
    for (name, members) in named {
        let Some((entry, _)) = name.rsplit_once('.') else { continue };
        match entries.iter_mut().find(|(known, _)| known == entry) {
            Some((_, all)) => all.extend(members),
            None => entries.push((entry.into(), members.clone())),
        }
    }
    entries.retain(|(_, members)| members.len() > 1);
    entries
}

/// The number of the scenario that a part is as large as, if all its members have the same one: its name, its SI unit and its size;
/// of members of several sizes no size.
fn parameter(scene: &Scene, sources: &[Source], part: &Part) -> Option<(&'static str, Unit, f64)> {
    let mut all = part.members.iter().map(|k| sources.get(*k).map(|source| source.parameter(scene)));
    let (name, unit, value) = all.next()??;
    let mut alike = true;
    for other in all {
        let (other_name, other_unit, other) = other?;
        if other_name != name || other_unit != unit {
            return None;
        }
        alike &= (other - value).abs() <= 1e-12 * value;
    }
    Some((name, unit, if alike { value } else { f64::NAN }))
}

/// A number in the unit of a data sheet.
fn sheet(x: f64, unit: Unit) -> String {
    const DEG: f64 = PI / 180.0;
    const HOUR: f64 = 3600.0;
    const UG: f64 = 9.806_65e-6;
    let units = [
        (Unit::RATE, "deg/h", DEG / HOUR),
        (Unit::RATE.times_half_seconds(1), "deg/sqrt(h)", DEG / HOUR.sqrt()),
        (Unit::RADIAN, "arcmin", DEG / 60.0),
        (Unit::FORCE, "ug", UG),
        (Unit::FORCE.times_half_seconds(1), "ug/sqrt(Hz)", UG),
        (Unit::ONE, "ppm", 1e-6),
    ];
    if !x.is_finite() {
        return String::new();
    }
    let known = units.iter().find(|(known, _, _)| *known == unit);
    match known {
        Some((_, symbol, factor)) => format!("{} {symbol}", record::number(x / factor)),
        None => format!("{} {unit}", record::number(x)),
    }
}

fn table(scene: &Scene, sources: &[Source], at: f64, judged: &Judged) -> Table {
    let names = match judged.of {
        Required::Horizontal | Required::Down => columns::REQUIREMENT,
        Required::Velocity => columns::required("radius_mps", "derivative_mps"),
        Required::Tilt | Required::Heading => columns::required("radius_rad", "derivative_rad"),
    };
    let name = format!("requirement_{}", judged.of.name());
    let mut table = Table::new(&name, &names, &["source", "parameter", "unit", "limit_shown"]);
    for part in &judged.parts {
        // All together have no number of their own.
        let number = parameter(scene, sources, part);
        let (name, value) = number.as_ref().map_or(("", f64::NAN), |(name, _, value)| (*name, *value));
        let limit = part.may_grow * value;
        let shown = number.map_or(String::new(), |(_, unit, _)| sheet(limit, unit));
        let unit = number.map_or(String::new(), |(_, unit, _)| unit.to_string());
        let cells: [Cell; 11] = [
            at.into(),
            part.name.as_str().into(),
            part.alone.into(),
            part.slope.into(),
            judged.part(part).into(),
            part.may_grow.into(),
            name.into(),
            unit.as_str().into(),
            value.into(),
            limit.into(),
            shown.as_str().into(),
        ];
        table.push(&cells);
    }
    table
}

/// Whether the limit is kept, and which sources and entries bind.
fn note(scene: &Scene, sources: &[Source], r: &Requirement, judged: &Judged) -> String {
    let size = |x: f64| written(judged.of, x);
    let errors = match judged.of {
        Required::Horizontal => "horizontal errors",
        Required::Down => "height errors",
        Required::Velocity => "horizontal velocity errors",
        Required::Tilt => "tilts",
        Required::Heading => "heading errors",
    };
    let met = judged.reached <= judged.limit;
    let told = |p: &&Part| {
        let limit = parameter(scene, sources, p).map(|(_, unit, value)| sheet(p.may_grow * value, unit));
        let limit = limit.filter(|limit| !limit.is_empty()).map_or(String::new(), |x| format!(", {x}"));
        let may = match p.may_grow {
            0.0 => "without it the rest is still too large".to_string(),
            x if x.is_infinite() => "it may grow without end".to_string(),
            x if met => format!("it may be {x:.3} times as large{limit}"),
            x => format!("at {x:.3} of it all would be met{limit}"),
        };
        format!("`{}` ({:.1} % of the slope; {may})", p.name, 100.0 * judged.part(p))
    };
    let binding = |entries: bool| -> Vec<String> {
        let of_kind = |p: &&Part| p.name != super::TOTAL && (p.members.len() > 1) == entries && p.slope > 0.0;
        let mut parts: Vec<&Part> = judged.parts.iter().filter(of_kind).collect();
        parts.sort_by(|a, b| b.slope.total_cmp(&a.slope));
        parts.iter().take(NAMED).map(told).collect()
    };
    let (single, entries) = (binding(false), binding(true));
    let binds = if single.is_empty() {
        "Nothing binds: there are no such errors".to_string()
    } else if entries.is_empty() {
        format!("What binds: {}", single.join(", "))
    } else {
        format!("What binds: {}; all axes of an entry together: {}", single.join(", "), entries.join(", "))
    };
    format!(
        "{:.4} % of the {errors} are within {} at {} s; required are {}: {}. {binds}",
        100.0 * r.probability,
        size(judged.reached),
        r.at,
        size(judged.limit),
        if met { "met" } else { "not met" },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::{Nine, Said, TOTAL};

    /// 97.5 % quantile of the normal distribution.
    const Z: f64 = 1.959963984540054;

    fn contribution(name: &str, sigmas: [f64; 9]) -> Contribution {
        let p = Nine::from_diagonal(&sigmas.map(|s| s * s).into());
        Contribution { name: name.into(), said: vec![Said { way: Way::Covariance, first: 0, p: vec![p] }] }
    }

    /// Standard deviations of 3 and 4 along a line make 5: radius z 5, derivatives z 9/5 and z 16/5, and with 3 the other may
    /// be sqrt(6.5² - 3²) for 6.5.
    #[test]
    fn along_a_line_in_closed_form() {
        for (of, k) in [(Required::Down, 2), (Required::Heading, 8)] {
            let one = |sigma| std::array::from_fn(|i| if i == k { sigma } else { 7.0 });
            let all = [
                contribution("a", one(3.0)),
                contribution("b", one(4.0)),
                contribution("c", one(0.0)),
                contribution(TOTAL, one(5.0)),
            ];
            let judged = judge(&all, 0, 0.95, of, 6.5 * Z);
            let [a, b, c, total] = &judged.parts[..] else { panic!() };
            let near = |x: f64, y: f64| assert!((x - y).abs() < 1e-9 * y, "{x} {y}");
            near(judged.reached, 5.0 * Z);
            near(a.alone, 3.0 * Z);
            near(a.slope, 1.8 * Z);
            near(b.slope, 3.2 * Z);
            near(total.slope, 5.0 * Z);
            near(b.may_grow, (6.5f64 * 6.5 - 9.0).sqrt() / 4.0);
            near(total.may_grow, 1.3);
            assert!(c.slope == 0.0 && c.may_grow.is_infinite());
        }
    }

    /// A circle: the radius is that of Rayleigh, sqrt(-2 ln 5 %) of a standard deviation.
    #[test]
    fn in_the_plane_in_closed_form() {
        for (of, k) in [(Required::Horizontal, 0), (Required::Velocity, 3), (Required::Tilt, 6)] {
            let one = |sigma| std::array::from_fn(|i| if i == k || i == k + 1 { sigma } else { 7.0 });
            let all =
                [contribution("a", one(3.0)), contribution("b", one(4.0)), contribution(TOTAL, one(5.0))];
            let judged = judge(&all, 0, 0.95, of, 3.9 * 2.447746830680816);
            let near = |x: f64, y: f64| assert!((x - y).abs() < 1e-9 * y, "{x} {y}");
            near(judged.reached, 5.0 * 2.447746830680816);
            near(judged.parts[0].slope, 1.8 * 2.447746830680816);
            // Beside 3 the other must come down to sqrt(3.9² - 3²); beside 4 nothing helps.
            near(judged.parts[1].may_grow, (3.9f64 * 3.9 - 9.0).sqrt() / 4.0);
            assert_eq!(judged.parts[0].may_grow, 0.0);
        }
    }

    /// Axes of 3 and 4 of one entry make 5 of 13, with 12 of another source: the entry may grow to sqrt(13.6² - 12²) of 5. What has no
    /// such errors binds nothing, and is no number that is none.
    #[test]
    fn entries_are_judged_together() {
        let one = |sigma| std::array::from_fn(|i| if i == 8 { sigma } else { 0.0 });
        let all = [
            contribution("gyro.bias.constant.x", one(3.0)),
            contribution("gyro.bias.constant.y", one(4.0)),
            contribution("initial.heading.d", one(12.0)),
            contribution(TOTAL, one(13.0)),
        ];
        let judged = judge(&all, 0, 0.95, Required::Heading, 13.6 * Z);
        let names: Vec<&str> = judged.parts.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names[2..], ["initial.heading.d", "gyro.bias.constant", TOTAL]);
        let near = |x: f64, y: f64| assert!((x - y).abs() < 1e-9 * y, "{x} {y}");
        let entry = &judged.parts[3];
        near(entry.alone, 5.0 * Z);
        near(judged.part(entry), 25.0 / 169.0);
        near(entry.may_grow, (13.6f64 * 13.6 - 144.0).sqrt() / 5.0);
        let none = judge(&all, 0, 0.95, Required::Horizontal, 1.0);
        assert!(none.parts.iter().all(|p| none.part(p) == 0.0));
        // A far limit is a number as well: 1e12 of 3.
        let far = judge(&all, 0, 0.95, Required::Heading, 1e12 * Z);
        near(far.parts[0].may_grow, 1e12 / 3.0);
    }

    /// Units of data sheets: 1 deg/h, 0.003 deg/√h, 50 µg, 10 µg/√Hz.
    #[test]
    fn limits_in_the_units_of_data_sheets() {
        let deg = PI / 180.0;
        assert_eq!(sheet(deg / 3600.0, Unit::RATE), "1.0000 deg/h");
        assert_eq!(sheet(0.003 * deg / 60.0, Unit::RATE.times_half_seconds(1)), "0.0030000 deg/sqrt(h)");
        assert_eq!(sheet(50.0 * 9.80665e-6, Unit::FORCE), "50.000 ug");
        assert_eq!(sheet(10.0 * 9.80665e-6, Unit::FORCE.times_half_seconds(1)), "10.000 ug/sqrt(Hz)");
        assert_eq!(sheet(0.000_812_346 * deg / 3600.0, Unit::RATE), "8.1235e-4 deg/h");
        assert_eq!(sheet(f64::INFINITY, Unit::ONE), "");
    }
}
