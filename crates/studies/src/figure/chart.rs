//! Layout of a figure and the order in which its parts are drawn.

use std::collections::HashSet;

use super::canvas::{Anchor, BAND_OPACITY, Canvas, Pen, Point, Type};
use super::map::{self, Map};
use super::ticks::{Ticks, ticks};
use super::{Axis, Colour, Data, Figure, FigureError, Panel, Scale, Style, decimate, font, legend};

const EDGE: f64 = 12.0;
const TITLE: f64 = 14.0;
const SUBTITLE: f64 = 10.5;
const LABEL: f64 = 11.0;
const TICK: f64 = 10.0;
/// Line height per em size.
const LEADING: f64 = 1.3;
const LINE_WIDTH: f64 = 1.4;
/// Width of the white line between opaque bands.
const EDGE_WIDTH: f64 = 0.7;
/// Line width of noise, which covers most of its panel.
const DENSE_WIDTH: f64 = 0.7;
/// Points between two ticks, at least.
const ROOM_X: f64 = 85.0;
const ROOM_Y: f64 = 42.0;
const DOT: f64 = 1.7;
const GRID: Colour = Colour(0xe4, 0xe4, 0xe4);
const ZERO: Colour = Colour(0xb0, 0xb0, 0xb0);
const AXES: Colour = Colour(0x40, 0x40, 0x40);

/// A panel with its place: y axis and ticks.
struct Placed<'a> {
    panel: &'a Panel,
    y: Map,
    ticks: Ticks,
}

/// Height in points of the figure if its legend needs more than `height`.
pub(super) fn height_with_legend(figure: &Figure, width: f64, height: f64) -> f64 {
    let plan = legend::plan(figure, width - 110.0);
    height.max(plan.height_right() + 100.0)
}

/// Draws the whole figure.
pub(super) fn draw(figure: &Figure, canvas: &mut dyn Canvas) -> Result<(), FigureError> {
    let (w, h) = figure.points();
    let (w, h) = (f64::from(w), f64::from(h));
    canvas.rect((0.0, 0.0), (w, h), Colour(255, 255, 255))?;

    // Widths first: what stands left and right of the panels does not depend on their heights by much.
    let count = figure.panels.len().max(1) as f64;
    let x_ends = map::x_ends(figure);
    let label_room = |panels_height: f64| (panels_height - 14.0 * (count - 1.0)) / count;
    let guess = label_room(h - 110.0);
    let ends: Vec<[f64; 2]> = figure.panels.iter().map(|p| map::y_ends(p, x_ends)).collect();
    let y_ticks = |height: f64| -> Vec<Ticks> {
        let wanted = (height / ROOM_Y).clamp(2.0, 10.0);
        figure.panels.iter().zip(&ends).map(|(p, e)| y_ticks_of(&p.y, *e, wanted)).collect()
    };
    let guessed = y_ticks(guess);
    let widest =
        guessed.iter().flat_map(|t| &t.major).map(|(_, l)| font::width(l, TICK, false)).fold(0.0, f64::max);
    let label_lines = |p: &Panel| font::wrap(&axis_label(&p.y, None), LABEL, false, guess + 10.0);
    let lines = figure.panels.iter().map(|p| label_lines(p).len()).max().unwrap_or(0) as f64;
    let left = EDGE + lines * LABEL * LEADING + widest + 14.0;
    let plan = legend::plan(figure, w - left - EDGE);
    let right = w - EDGE - 10.0 - plan.width_right();

    // Then heights.
    let title = font::wrap(&figure.title, TITLE, true, w - left - EDGE);
    let subtitle = font::wrap(&figure.subtitle, SUBTITLE, false, w - left - EDGE);
    let mut y = EDGE;
    for (texts, size, bold, colour) in
        [(&title, TITLE, true, Colour::BLACK), (&subtitle, SUBTITLE, false, Colour(0x59, 0x59, 0x59))]
    {
        for line in texts {
            let kind = Type { size, bold, colour, anchor: Anchor::Start, upwards: false };
            canvas.text(line, kind, (left, y + size))?;
            y += size * LEADING;
        }
        y += 2.0;
    }
    let legend_top = y;
    y += plan.height_above();
    let notes = guessed.iter().any(|t| !t.note.is_empty());
    let gap = if notes { TICK * LEADING + 6.0 } else { 14.0 };
    let top = y + if notes { TICK * LEADING } else { 4.0 };
    let bottom = h - EDGE - 2.0 * LABEL * LEADING - 8.0;
    let each = ((bottom - top - gap * (count - 1.0)) / count).max(20.0);

    let mut x = Map { low: x_ends[0], high: x_ends[1], scale: figure.x.scale, points: [left, right] };
    let mut placed: Vec<Placed> = Vec::new();
    for (k, (panel, ticks)) in figure.panels.iter().zip(y_ticks(each)).enumerate() {
        let panel_top = top + (each + gap) * k as f64;
        let y = Map {
            low: ends[k][0],
            high: ends[k][1],
            scale: panel.y.scale,
            points: [panel_top + each, panel_top],
        };
        placed.push(Placed { panel, y, ticks });
    }
    if figure.equal_aspect && figure.x.scale == Scale::Linear {
        equalise(&mut x, &mut placed);
    }
    let x_ticks = ticks(x.scale, x.low, x.high, ((right - left) / ROOM_X).clamp(2.0, 10.0));

    for (k, place) in placed.iter().enumerate() {
        grid(canvas, &x, &x_ticks, place)?;
        curves(canvas, figure, &x, place)?;
        foot(canvas, &x, place)?;
        axes(canvas, &x, &x_ticks, place, k + 1 == placed.len())?;
        let label = label_lines(place.panel);
        let middle = 0.5 * (place.y.points[0] + place.y.points[1]);
        for (n, line) in label.iter().enumerate() {
            let kind = Type { upwards: true, ..text(LABEL, Anchor::Middle) };
            canvas.text(line, kind, (EDGE + LABEL * (1.0 + LEADING * n as f64), middle))?;
        }
    }
    let x_label = font::fit(&axis_label(&figure.x, Some(&x_ticks)), LABEL, false, w - 2.0 * EDGE);
    canvas.text(&x_label, text(LABEL, Anchor::Middle), (0.5 * (left + right), h - EDGE - 2.0))?;
    plan.draw(canvas, (left, legend_top), (right + 16.0, top - 4.0), bottom - top + 8.0)
}

/// Ticks of a y axis: names of rows, or numbers.
fn y_ticks_of(axis: &Axis, [low, high]: [f64; 2], wanted: f64) -> Ticks {
    if axis.names.is_empty() {
        return ticks(axis.scale, low, high, wanted);
    }
    let major = axis.names.iter().enumerate().map(|(k, name)| (-(k as f64), name.clone())).collect();
    Ticks { major, ..Ticks::default() }
}

fn text(size: f64, anchor: Anchor) -> Type {
    Type { size, bold: false, colour: Colour::BLACK, anchor, upwards: false }
}

/// Label with the unit of a time axis, and with the common factor of the ticks where they have no place of their own.
fn axis_label(axis: &Axis, ticks: Option<&Ticks>) -> String {
    let mut label = axis.label.clone();
    if let Some(ticks) = ticks {
        if let Some(unit) = ticks.unit {
            label = format!("{label} ({unit})");
        }
        if !ticks.note.is_empty() {
            label = format!("{label}   [{}]", ticks.note);
        }
    }
    label
}

/// Widens the axis that shows more detail until both have the same scale, around its middle.
fn equalise(x: &mut Map, placed: &mut [Placed]) {
    let [Placed { y, ticks: y_ticks, panel }] = placed else { return };
    if panel.y.scale != Scale::Linear {
        return;
    }
    let widen = |m: &mut Map, factor: f64| {
        let (middle, half) = (0.5 * (m.low + m.high), 0.5 * factor * (m.high - m.low));
        (m.low, m.high) = (middle - half, middle + half);
    };
    // Room around a track: x ends are those of the data.
    widen(x, 1.06);
    let ratio = x.per_point() / y.per_point();
    widen(if ratio > 1.0 { y } else { x }, ratio.max(1.0 / ratio));
    let height = (y.points[1] - y.points[0]).abs();
    *y_ticks = ticks(Scale::Linear, y.low, y.high, (height / ROOM_X).clamp(2.0, 10.0));
}

fn grid(canvas: &mut dyn Canvas, x: &Map, x_ticks: &Ticks, place: &Placed) -> Result<(), FigureError> {
    let ([left, right], [bottom, top]) = (x.points, place.y.points);
    for (v, _) in &x_ticks.major {
        if let Some(at) = x.at(*v) {
            canvas.polyline(&[(at, top), (at, bottom)], Pen::solid(0.6, GRID))?;
        }
    }
    for (v, _) in &place.ticks.major {
        if let Some(at) = place.y.at(*v) {
            // Of an axis of rows, 0 is the first of them.
            let colour = if *v == 0.0 && place.panel.y.names.is_empty() { ZERO } else { GRID };
            canvas.polyline(&[(left, at), (right, at)], Pen::solid(0.6, colour))?;
        }
    }
    Ok(())
}

/// Of rows, the line that their bars start from.
fn foot(canvas: &mut dyn Canvas, x: &Map, place: &Placed) -> Result<(), FigureError> {
    match x.at(0.0) {
        Some(at) if !place.panel.y.names.is_empty() && x.low < 0.0 && x.high > 0.0 => {
            let [bottom, top] = place.y.points;
            canvas.polyline(&[(at, top), (at, bottom)], Pen::solid(0.9, AXES))
        }
        _ => Ok(()),
    }
}

fn curves(canvas: &mut dyn Canvas, figure: &Figure, x: &Map, place: &Placed) -> Result<(), FigureError> {
    let y = &place.y;
    if map::is_empty(place.panel, x, y) {
        let middle = (0.5 * (x.points[0] + x.points[1]), 0.5 * (y.points[0] + y.points[1]));
        return canvas.text("no data", Type { colour: Colour::GREY, ..text(LABEL, Anchor::Middle) }, middle);
    }
    // Bands below all lines.
    for (k, series) in place.panel.series.iter().enumerate() {
        if let Data::Band(band) = &series.data {
            let (colour, _) = legend::look(figure, series, k);
            for piece in band_pieces(band, x, y) {
                area(canvas, &piece, colour, series.solid)?;
            }
        }
    }
    for (k, series) in place.panel.series.iter().enumerate() {
        if let Data::Points(points) = &series.data {
            let (colour, style) = legend::look(figure, series, k);
            if style == Style::Points {
                dots(canvas, points, x, y, colour)?;
                continue;
            }
            for piece in decimate::pieces(points, x, y) {
                stroke(canvas, &piece, style, colour)?;
            }
        }
    }
    Ok(())
}

/// A band; an opaque one has an edge, so that those of like colours are told apart.
pub(super) fn area(
    canvas: &mut dyn Canvas,
    piece: &[(f64, f64, f64)],
    colour: Colour,
    solid: bool,
) -> Result<(), FigureError> {
    if !solid {
        return canvas.band(piece, colour, BAND_OPACITY);
    }
    canvas.band(piece, colour, 1.0)?;
    let edge: Vec<Point> = piece.iter().map(|&(x, top, _)| (x, top)).collect();
    canvas.polyline(&edge, Pen::solid(EDGE_WIDTH, Colour(255, 255, 255)))
}

/// A line in its style; a single point is shown as a dot.
pub(super) fn stroke(
    canvas: &mut dyn Canvas,
    line: &[Point],
    style: Style,
    colour: Colour,
) -> Result<(), FigureError> {
    let pattern: &'static [f64] = match style {
        Style::Points => {
            let (a, b) = (line[0], line[line.len() - 1]);
            return canvas.disc((0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1)), DOT, colour);
        }
        Style::Line => &[],
        Style::Dashed => &[6.0, 3.0],
        Style::Dotted => &[1.5, 2.2],
        Style::DashDot => &[6.0, 2.2, 1.5, 2.2],
    };
    if let [point] = line {
        return canvas.disc(*point, DOT, colour);
    }
    let length: f64 = line.windows(2).map(|p| (p[1].0 - p[0].0).hypot(p[1].1 - p[0].1)).sum();
    // Dashes on a line this dense cannot be seen, and would be very many.
    let dense = length > 3e4;
    let pen =
        if dense { Pen::solid(DENSE_WIDTH, colour) } else { Pen { width: LINE_WIDTH, colour, pattern } };
    canvas.polyline(line, pen)
}

fn dots(
    canvas: &mut dyn Canvas,
    points: &[[f64; 2]],
    x: &Map,
    y: &Map,
    colour: Colour,
) -> Result<(), FigureError> {
    let inside = |v: f64, ends: [f64; 2]| v >= ends[0].min(ends[1]) && v <= ends[0].max(ends[1]);
    // Dots that would hide each other are drawn once.
    let mut drawn: HashSet<(i32, i32)> = HashSet::new();
    for p in points {
        if let (Some(px), Some(py)) = (x.at(p[0]), y.at(p[1])) {
            let cell = ((px * 2.0) as i32, (py * 2.0) as i32);
            if inside(px, x.points) && inside(py, y.points) && drawn.insert(cell) {
                canvas.disc((px, py), DOT, colour)?;
            }
        }
    }
    Ok(())
}

/// Gapless pieces of a band in points, `(x, top, bottom)`, within the panel.
fn band_pieces(band: &[[f64; 3]], x: &Map, y: &Map) -> Vec<Vec<(f64, f64, f64)>> {
    let [bottom, top] = y.points;
    let mut pieces = vec![Vec::new()];
    for &[v, low, high] in band {
        let inside = x.at(v).filter(|px| *px >= x.points[0] - 1e-9 && *px <= x.points[1] + 1e-9);
        match (inside, y.at(low), y.at(high)) {
            (Some(px), Some(a), Some(b)) => {
                let (upper, lower) = (a.min(b).clamp(top, bottom), a.max(b).clamp(top, bottom));
                let last = pieces.len() - 1;
                pieces[last].push((px, upper, lower));
            }
            _ => pieces.push(Vec::new()),
        }
    }
    pieces.into_iter().map(|p| thin(&p)).filter(|p| p.len() > 1).collect()
}

/// Joins the points of a band that fall into the same third of a point to their envelope.
fn thin(piece: &[(f64, f64, f64)]) -> Vec<(f64, f64, f64)> {
    let mut thinned: Vec<(f64, f64, f64)> = Vec::new();
    for &(x, upper, lower) in piece {
        match thinned.last_mut() {
            Some((kept, u, l)) if x > *kept && x - *kept < 0.3 => (*u, *l) = (u.min(upper), l.max(lower)),
            _ => thinned.push((x, upper, lower)),
        }
    }
    thinned
}

fn axes(
    canvas: &mut dyn Canvas,
    x: &Map,
    x_ticks: &Ticks,
    place: &Placed,
    labelled: bool,
) -> Result<(), FigureError> {
    let ([left, right], [bottom, top]) = (x.points, place.y.points);
    canvas.polyline(&[(left, top), (left, bottom), (right, bottom)], Pen::solid(0.9, AXES))?;
    for (values, length) in [(&minor_and_major(x_ticks), 0), (&minor_and_major(&place.ticks), 1)] {
        for &(v, long) in values {
            let reach = if long { 4.0 } else { 2.2 };
            let mark = if length == 0 {
                x.at(v).map(|at| [(at, bottom), (at, bottom + reach)])
            } else {
                place.y.at(v).map(|at| [(left, at), (left - reach, at)])
            };
            if let Some(mark) = mark {
                canvas.polyline(&mark, Pen::solid(0.8, AXES))?;
            }
        }
    }
    for (v, label) in &place.ticks.major {
        if let Some(at) = place.y.at(*v) {
            canvas.text(label, text(TICK, Anchor::End), (left - 7.0, at + 0.36 * TICK))?;
        }
    }
    if !place.ticks.note.is_empty() {
        canvas.text(&place.ticks.note, text(TICK, Anchor::Start), (left, top - 4.0))?;
    }
    if labelled {
        let mut free_from = f64::MIN;
        for (v, label) in &x_ticks.major {
            let half = 0.5 * font::width(label, TICK, false);
            if let Some(at) = x.at(*v).filter(|at| at - half > free_from) {
                canvas.text(label, text(TICK, Anchor::Middle), (at, bottom + 7.0 + TICK))?;
                free_from = at + half + 3.0;
            }
        }
    }
    Ok(())
}

fn minor_and_major(ticks: &Ticks) -> Vec<(f64, bool)> {
    let minor = ticks.minor.iter().map(|&v| (v, false));
    minor.chain(ticks.major.iter().map(|(v, _)| (*v, true))).collect()
}
