//! SVG: drawn on a grid of a tenth of a point, because the library's coordinates are whole numbers.

use plotters::prelude::{
    Color, DrawingBackend, FontFamily, FontStyle, FontTransform, RGBColor, SVGBackend, ShapeStyle,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontDesc, TextStyle};

use super::canvas::{Anchor, Canvas, Pen, Point, Type};
use super::{Colour, FigureError, font};

/// Grid steps per point.
const GRID: f64 = 10.0;

/// The library divides a font's size by this to get the em.
const SIZE_PER_EM: f64 = 1.24;

/// Half the x-height of the font, in em: the library centres a text on it.
const HALF_EX: f64 = 0.273;

/// The backend, and the dash patterns met so far.
struct Vector<'a>(SVGBackend<'a>, Vec<&'static [f64]>);

/// The library writes no dashes: a line of pattern number k gets a width of k times this more than its own, which is
/// put right in the finished document.
const PATTERN_MARK: u32 = 100_000;

/// Draws with `draw` into a document.
pub(super) fn svg(
    (w, h): (u32, u32),
    draw: impl FnOnce(&mut dyn Canvas) -> Result<(), FigureError>,
) -> Result<String, FigureError> {
    let grid = |n: u32| (f64::from(n) * GRID) as u32;
    let mut document = String::new();
    let mut canvas = Vector(SVGBackend::with_string(&mut document, (grid(w), grid(h))), Vec::new());
    draw(&mut canvas)?;
    canvas.0.present().map_err(refused)?;
    let patterns = std::mem::take(&mut canvas.1);
    drop(canvas);
    for (k, pattern) in patterns.iter().enumerate() {
        let lengths: Vec<String> = pattern.iter().map(|length| (length * GRID).to_string()).collect();
        let dashed = format!("stroke-dasharray=\"{}\" stroke-width=\"", lengths.join(","));
        // 100014 for pattern 1 and a width of 14: the zeros between are part of the mark.
        document = document.replace(&format!("stroke-width=\"{}000", k + 1), &dashed);
    }
    // The view box stays on the grid; only the size in which it is shown is in points.
    let drawn = format!("width=\"{}\" height=\"{}\"", grid(w), grid(h));
    let shown = format!("width=\"{w}\" height=\"{h}\" stroke-linejoin=\"round\"");
    Ok(document.replacen(&drawn, &shown, 1))
}

fn refused(e: impl std::fmt::Display) -> FigureError {
    FigureError::Drawing(e.to_string())
}

fn on_grid((x, y): Point) -> (i32, i32) {
    ((x * GRID).round() as i32, (y * GRID).round() as i32)
}

fn rgb(Colour(r, g, b): Colour) -> RGBColor {
    RGBColor(r, g, b)
}

impl Canvas for Vector<'_> {
    fn polyline(&mut self, line: &[Point], pen: Pen) -> Result<(), FigureError> {
        let known = self.1.iter().position(|p| *p == pen.pattern);
        let mark = match known {
            _ if pen.pattern.is_empty() => 0,
            Some(k) => k + 1,
            None => {
                self.1.push(pen.pattern);
                self.1.len()
            }
        };
        let stroke_width = (pen.width * GRID).clamp(1.0, 99.0) as u32 + PATTERN_MARK * mark as u32;
        let style = ShapeStyle { color: rgb(pen.colour).to_rgba(), filled: false, stroke_width };
        self.0.draw_path(line.iter().map(|&p| on_grid(p)), &style).map_err(refused)
    }

    fn band(&mut self, band: &[(f64, f64, f64)], colour: Colour, opacity: f64) -> Result<(), FigureError> {
        let there = band.iter().map(|&(x, top, _)| on_grid((x, top)));
        let back = band.iter().rev().map(|&(x, _, low)| on_grid((x, low)));
        self.0.fill_polygon(there.chain(back), &rgb(colour).mix(opacity)).map_err(refused)
    }

    fn disc(&mut self, centre: Point, radius: f64, colour: Colour) -> Result<(), FigureError> {
        self.0.draw_circle(on_grid(centre), (radius * GRID) as u32, &rgb(colour), true).map_err(refused)
    }

    fn rect(&mut self, from: Point, to: Point, colour: Colour) -> Result<(), FigureError> {
        self.0.draw_rect(on_grid(from), on_grid(to), &rgb(colour), true).map_err(refused)
    }

    fn text(&mut self, text: &str, kind: Type, (x, y): Point) -> Result<(), FigureError> {
        let horizontal = match kind.anchor {
            Anchor::Start => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::End => HPos::Right,
        };
        let lift = HALF_EX * kind.size;
        let (turn, at) = if kind.upwards {
            (FontTransform::Rotate270, (x - lift, y))
        } else {
            (FontTransform::None, (x, y - lift))
        };
        let weight = if kind.bold { FontStyle::Bold } else { FontStyle::Normal };
        let face = FontDesc::new(FontFamily::Name(font::FAMILY), kind.size * GRID * SIZE_PER_EM, weight);
        let colour = rgb(kind.colour);
        let style =
            TextStyle::from(face.transform(turn)).color(&colour).pos(Pos::new(horizontal, VPos::Center));
        self.0.draw_text(text, &style, on_grid(at)).map_err(refused)
    }
}
