//! From data to points: the ends of an axis and the scale between them.

use super::{Axis, Data, Figure, Panel, Scale};

/// Numbers beyond this are treated as missing: differences of larger ones overflow.
const LARGEST: f64 = 1e290;

/// An axis between two ends, laid over an interval in points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Map {
    pub low: f64,
    pub high: f64,
    pub scale: Scale,
    /// Position of `low` and of `high` in points.
    pub points: [f64; 2],
}

impl Map {
    /// Position of a value in points, `None` for what the axis cannot show.
    pub fn at(&self, v: f64) -> Option<f64> {
        usable(v, self.scale).then(|| {
            let u = match self.scale {
                Scale::Log => (v / self.low).log10() / (self.high / self.low).log10(),
                _ => (v - self.low) / (self.high - self.low),
            };
            // Far outside is as good as just outside, and keeps later arithmetic finite.
            self.points[0] + u.clamp(-1e4, 1e4) * (self.points[1] - self.points[0])
        })
    }

    /// Data units per point, for linear axes.
    pub fn per_point(&self) -> f64 {
        (self.high - self.low) / (self.points[1] - self.points[0]).abs()
    }
}

fn usable(v: f64, scale: Scale) -> bool {
    v.abs() < LARGEST && (scale != Scale::Log || v > 1e3 / LARGEST)
}

/// Smallest and largest usable value, `None` without one.
fn extent(values: impl Iterator<Item = f64>, scale: Scale) -> Option<[f64; 2]> {
    values.filter(|&v| usable(v, scale)).fold(None, |found, v| {
        let [low, high] = found.unwrap_or([v, v]);
        Some([v.min(low), v.max(high)])
    })
}

/// Ends of the x axis.
pub(super) fn x_ends(figure: &Figure) -> [f64; 2] {
    let series = figure.panels.iter().flat_map(|panel| &panel.series);
    let values = series.flat_map(|s| -> Box<dyn Iterator<Item = f64>> {
        match &s.data {
            Data::Points(points) => Box::new(points.iter().map(|p| p[0])),
            Data::Band(band) => Box::new(band.iter().map(|p| p[0])),
        }
    });
    ends(&figure.x, extent(values, figure.x.scale), 0.0)
}

/// Ends of the y axis of a panel, from what lies within the ends of x.
pub(super) fn y_ends(panel: &Panel, [left, right]: [f64; 2]) -> [f64; 2] {
    let inside = move |x: f64| x >= left && x <= right;
    let values = panel.series.iter().flat_map(|s| -> Box<dyn Iterator<Item = f64>> {
        match &s.data {
            Data::Points(points) => Box::new(points.iter().filter(move |p| inside(p[0])).map(|p| p[1])),
            Data::Band(band) => {
                Box::new(band.iter().filter(move |p| inside(p[0])).flat_map(|p| [p[1], p[2]]))
            }
        }
    });
    ends(&panel.y, extent(values, panel.y.scale), 0.05)
}

/// True if the panel has nothing that its axes can show.
pub(super) fn is_empty(panel: &Panel, x: &Map, y: &Map) -> bool {
    let shown = |a: f64, b: f64| x.at(a).is_some() && y.at(b).is_some();
    !panel.series.iter().any(|s| match &s.data {
        Data::Points(points) => points.iter().any(|p| shown(p[0], p[1])),
        Data::Band(band) => band.iter().any(|p| shown(p[0], p[1]) && shown(p[0], p[2])),
    })
}

/// True if there is room for ticks between the two: more than the numbers themselves can resolve.
fn wide(low: f64, high: f64, scale: Scale) -> bool {
    match scale {
        Scale::Log => high > low * 1.001,
        _ => high - low > 1e-13 * low.abs().max(high.abs()) && high - low > 1.0 / LARGEST,
    }
}

fn ends(axis: &Axis, data: Option<[f64; 2]>, margin: f64) -> [f64; 2] {
    let scale = axis.scale;
    let asked = axis.range.filter(|r| r.iter().all(|&v| usable(v, scale)) && wide(r[0], r[1], scale));
    if let Some(range) = asked {
        return range;
    }
    match (scale, data) {
        (Scale::Log, None) => [1.0, 10.0],
        (_, None) => [0.0, 1.0],
        (Scale::Log, Some([low, high])) if margin == 0.0 && wide(low, high, scale) => [low, high],
        (Scale::Log, Some([low, high])) => {
            // A constant gets half a decade on each side.
            let (low, high) = if wide(low, high, scale) { (low, high) } else { (low / 3.0, high * 3.0) };
            [round_down(low), 1.0 / round_down(1.0 / high)]
        }
        (_, Some([low, high])) if wide(low, high, scale) => {
            let room = margin * (high - low);
            [low - room, high + room]
        }
        (_, Some([low, high])) => {
            let half = if low.abs() < 1e3 / LARGEST { 1.0 } else { 0.1 * low.abs() };
            [low - half, high + half]
        }
    }
}

/// The largest 1, 2 or 5 times a power of ten that is not above `v`.
fn round_down(v: f64) -> f64 {
    let decade = 10_f64.powf(v.log10().floor());
    // A decade computed a rounding error too large must not win over the value itself.
    [5.0, 2.0, 1.0].into_iter().map(|m| m * decade).find(|&r| r <= v * (1.0 + 1e-9)).unwrap_or(0.5 * decade)
}
