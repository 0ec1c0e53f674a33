//! The legend: above the panels in a few rows, or right of them in a column. It never lies on data.

use super::canvas::{Anchor, Canvas, Point, Type};
use super::{Colour, Data, Figure, FigureError, Series, Style, colour, font};

/// Em size of the texts, in points.
const SIZE: f64 = 10.0;
const ROW: f64 = 15.0;
/// Length of the sample stroke and the space after it.
const SAMPLE: f64 = 24.0;
const AFTER_SAMPLE: f64 = 6.0;
const BETWEEN: f64 = 16.0;
const MOST_ROWS_ABOVE: usize = 3;
const WIDEST_COLUMN: f64 = 240.0;

/// One line of the legend.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    pub label: String,
    pub colour: Colour,
    pub style: Option<Style>,
    pub band: bool,
    pub solid: bool,
}

/// Where the legend goes, with the entries placed in rows.
pub(super) enum Plan {
    None,
    Above(Vec<Vec<Entry>>),
    /// Entries and width of the column in points.
    Right(Vec<Entry>, f64),
}

/// Colour and line style of series number `k` of a panel.
pub(super) fn look(figure: &Figure, series: &Series, k: usize) -> (Colour, Style) {
    // The same label means the same thing in every panel; without a label the place in the panel counts.
    let same = |s: &&Series| s.label == series.label;
    let labels = unique_labels(figure);
    let number = labels.iter().position(|l| *l == series.label).unwrap_or(k);
    let all = || figure.panels.iter().flat_map(|p| &p.series);
    let chosen = if series.label.is_empty() {
        series.colour
    } else {
        series.colour.or_else(|| all().filter(same).find_map(|s| s.colour))
    };
    (chosen.unwrap_or(Colour::palette(number)), series.style.unwrap_or(colour::style_of(number)))
}

fn unique_labels(figure: &Figure) -> Vec<&str> {
    let mut labels: Vec<&str> = Vec::new();
    for series in figure.panels.iter().flat_map(|p| &p.series) {
        if !series.label.is_empty() && !labels.contains(&series.label.as_str()) {
            labels.push(&series.label);
        }
    }
    labels
}

fn entries(figure: &Figure) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    for panel in &figure.panels {
        for (k, series) in panel.series.iter().enumerate().filter(|(_, s)| !s.label.is_empty()) {
            let (colour, style) = look(figure, series, k);
            let band = matches!(series.data, Data::Band(_));
            match entries.iter_mut().find(|e| e.label == series.label) {
                Some(known) => {
                    known.band |= band;
                    known.style = known.style.or((!band).then_some(style));
                }
                None => {
                    let style = (!band).then_some(style);
                    let (label, solid) = (series.label.clone(), series.solid);
                    entries.push(Entry { label, colour, style, band, solid });
                }
            }
        }
    }
    entries
}

fn width(entry: &Entry) -> f64 {
    SAMPLE + AFTER_SAMPLE + font::width(&entry.label, SIZE, false)
}

/// Decides where the legend goes, for a figure with `room` points beside its y labels.
pub(super) fn plan(figure: &Figure, room: f64) -> Plan {
    let entries = entries(figure);
    if entries.is_empty() {
        return Plan::None;
    }
    let mut rows: Vec<Vec<Entry>> = Vec::new();
    let mut used = 0.0;
    for entry in &entries {
        let w = width(entry) + BETWEEN;
        used += w;
        match rows.last_mut() {
            Some(row) if used <= room + BETWEEN => row.push(entry.clone()),
            _ => {
                rows.push(vec![entry.clone()]);
                used = w;
            }
        }
    }
    if rows.len() <= MOST_ROWS_ABOVE {
        return Plan::Above(rows);
    }
    let widest = entries.iter().map(width).fold(0.0, f64::max).min(WIDEST_COLUMN);
    Plan::Right(entries, widest)
}

impl Plan {
    /// Height above the panels, points.
    pub fn height_above(&self) -> f64 {
        match self {
            Plan::Above(rows) => ROW * rows.len() as f64 + 4.0,
            _ => 0.0,
        }
    }

    /// Width right of the panels, points.
    pub fn width_right(&self) -> f64 {
        match self {
            Plan::Right(_, width) => width + 24.0,
            _ => 0.0,
        }
    }

    /// Height that the column needs, points.
    pub fn height_right(&self) -> f64 {
        match self {
            Plan::Right(entries, _) => ROW * entries.len() as f64,
            _ => 0.0,
        }
    }

    /// Draws the legend; `above` and `right` are its top left corners in either place, `height` what the column has.
    pub fn draw(
        &self,
        canvas: &mut dyn Canvas,
        above: Point,
        right: Point,
        height: f64,
    ) -> Result<(), FigureError> {
        match self {
            Plan::None => Ok(()),
            Plan::Above(rows) => {
                for (k, row) in rows.iter().enumerate() {
                    let mut x = above.0;
                    for entry in row {
                        sample(canvas, entry, (x, above.1 + ROW * k as f64), f64::INFINITY)?;
                        x += width(entry) + BETWEEN;
                    }
                }
                Ok(())
            }
            Plan::Right(entries, width) => {
                // More entries than lines: the last line says how many are missing.
                let lines = ((height / ROW) as usize).max(1);
                let shown = if entries.len() <= lines { entries.len() } else { lines - 1 };
                for (k, entry) in entries[..shown].iter().enumerate() {
                    sample(canvas, entry, (right.0, right.1 + ROW * k as f64), *width)?;
                }
                if shown < entries.len() {
                    let more = format!("… and {} more", entries.len() - shown);
                    let at = (right.0 + SAMPLE + AFTER_SAMPLE, right.1 + ROW * shown as f64 + 0.75 * ROW);
                    canvas.text(&more, KIND, at)?;
                }
                Ok(())
            }
        }
    }
}

const KIND: Type =
    Type { size: SIZE, bold: false, colour: Colour::BLACK, anchor: Anchor::Start, upwards: false };

fn sample(canvas: &mut dyn Canvas, entry: &Entry, (x, y): Point, room: f64) -> Result<(), FigureError> {
    let middle = y + 0.5 * ROW;
    if entry.band {
        let ends = [x, x + SAMPLE].map(|x| (x, middle - 4.5, middle + 4.5));
        super::chart::area(canvas, &ends, entry.colour, entry.solid)?;
    }
    if let Some(style) = entry.style {
        super::chart::stroke(canvas, &[(x, middle), (x + SAMPLE, middle)], style, entry.colour)?;
    }
    let text = font::fit(&entry.label, SIZE, false, room - SAMPLE - AFTER_SAMPLE);
    canvas.text(&text, KIND, (x + SAMPLE + AFTER_SAMPLE, middle + 0.36 * SIZE))
}
