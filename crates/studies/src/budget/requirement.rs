//! What a requirement asks of each source: which bind, and by how much each may grow.

use super::radius::{derivative, may_grow, radius};
use super::report::total;
use super::scene::Scene;
use super::source::Source;
use super::subject::plane;
use super::{Contribution, Way};
use crate::{
    record::{Cell, Table, columns},
    scenario::{Required, Requirement},
};

/// Sources that a note names.
const NAMED: usize = 3;

/// What one source does to one limit.
struct Part<'a> {
    name: &'a str,
    /// Radius of the source alone.
    alone: f64,
    /// Derivative of the radius of all by the relative size of the source.
    slope: f64,
    /// Factor by which it may grow until the limit is reached.
    may_grow: f64,
}

/// One limit, and what all and each source do to it.
struct Judged<'a> {
    of: Required,
    limit: f64,
    reached: f64,
    parts: Vec<Part<'a>>,
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
    (tables, judged.iter().map(|j| note(r, j)).collect())
}

fn judge(
    contributions: &[Contribution],
    row: usize,
    probability: f64,
    of: Required,
    limit: f64,
) -> Judged<'_> {
    let whole = plane(of, &total(contributions)[row]);
    let reached = radius(&whole, probability);
    let mut parts = Vec::with_capacity(contributions.len());
    for c in contributions {
        let part = plane(of, &c.of(Way::Covariance).unwrap_or_default()[row]);
        parts.push(Part {
            name: &c.name,
            alone: radius(&part, probability),
            slope: derivative(&whole, &part, reached),
            may_grow: may_grow(&whole, &part, probability, limit),
        });
    }
    Judged { of, limit, reached, parts }
}

fn table(scene: &Scene, sources: &[Source], at: f64, judged: &Judged) -> Table {
    let names = match judged.of {
        Required::Horizontal | Required::Down => columns::REQUIREMENT,
        Required::Velocity => columns::required("radius_mps", "derivative_mps"),
        Required::Tilt | Required::Heading => columns::required("radius_rad", "derivative_rad"),
    };
    let name = format!("requirement_{}", judged.of.name());
    let mut table = Table::new(&name, &names, &["source", "parameter", "unit"]);
    for (k, part) in judged.parts.iter().enumerate() {
        // All together have no number of their own.
        let number = sources.get(k).map(|source| source.parameter(scene));
        let (name, value) = number.as_ref().map_or(("", f64::NAN), |(name, _, value)| (*name, *value));
        let unit = number.map_or(String::new(), |(_, unit, _)| unit.to_string());
        let cells: [Cell; 10] = [
            at.into(),
            part.name.into(),
            part.alone.into(),
            part.slope.into(),
            (part.slope / judged.reached).into(),
            part.may_grow.into(),
            name.into(),
            unit.as_str().into(),
            value.into(),
            (part.may_grow * value).into(),
        ];
        table.push(&cells);
    }
    table
}

/// Whether the limit is kept, and which sources bind.
fn note(r: &Requirement, judged: &Judged) -> String {
    let size = |x: f64| match judged.of {
        Required::Horizontal | Required::Down => format!("{x:.1} m"),
        Required::Velocity => format!("{x:.4} m/s"),
        Required::Tilt | Required::Heading => format!("{:.4} arcmin", x.to_degrees() * 60.0),
    };
    let errors = match judged.of {
        Required::Horizontal => "horizontal errors",
        Required::Down => "height errors",
        Required::Velocity => "horizontal velocity errors",
        Required::Tilt => "tilts",
        Required::Heading => "heading errors",
    };
    let met = judged.reached <= judged.limit;
    let mut parts: Vec<&Part> = judged.parts.iter().filter(|p| p.name != super::TOTAL).collect();
    parts.sort_by(|a, b| b.slope.total_cmp(&a.slope));
    let binding = parts.iter().take(NAMED).map(|p| {
        let share = 100.0 * p.slope / judged.reached;
        let may = match p.may_grow {
            0.0 => "without it the rest is still too large".to_string(),
            x if x.is_infinite() => "it may grow without end".to_string(),
            x if met => format!("it may be {x:.3} times as large"),
            x => format!("at {x:.3} of it all would be met"),
        };
        format!("`{}` ({share:.1} % of the slope; {may})", p.name)
    });
    format!(
        "{:.4} % of the {errors} are within {} at {} s; required are {}: {}. What binds: {}",
        100.0 * r.probability,
        size(judged.reached),
        r.at,
        size(judged.limit),
        if met { "met" } else { "not met" },
        binding.collect::<Vec<_>>().join(", ")
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
}
