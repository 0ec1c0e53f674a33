//! The few strokes that a chart is made of, in points from the top left corner.

use super::{Colour, FigureError};

/// A position in points, y downwards.
pub(super) type Point = (f64, f64);

/// Which end of a text stands at its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pen {
    /// Points.
    pub width: f64,
    pub colour: Colour,
    /// Lengths of stroke, gap, stroke, gap, … in points; empty for a solid line.
    pub pattern: &'static [f64],
}

impl Pen {
    /// A solid line.
    pub fn solid(width: f64, colour: Colour) -> Self {
        Pen { width, colour, pattern: &[] }
    }
}

/// How a text is set.
#[derive(Clone, Copy, Debug)]
pub(super) struct Type {
    /// Em size in points.
    pub size: f64,
    pub bold: bool,
    pub colour: Colour,
    pub anchor: Anchor,
    /// Turned a quarter counter-clockwise: it reads upwards.
    pub upwards: bool,
}

/// What a chart is drawn on: pixels or an SVG document.
pub(super) trait Canvas {
    /// An open line.
    fn polyline(&mut self, line: &[Point], pen: Pen) -> Result<(), FigureError>;
    /// The area between two lines over the same x, translucent or opaque (1). `band` is `(x, y_top, y_bottom)`.
    fn band(&mut self, band: &[(f64, f64, f64)], colour: Colour, opacity: f64) -> Result<(), FigureError>;
    /// A filled disc.
    fn disc(&mut self, centre: Point, radius: f64, colour: Colour) -> Result<(), FigureError>;
    /// A filled rectangle.
    fn rect(&mut self, from: Point, to: Point, colour: Colour) -> Result<(), FigureError>;
    /// A line of text whose baseline passes through `at`.
    fn text(&mut self, text: &str, kind: Type, at: Point) -> Result<(), FigureError>;
}

/// Opacity of bands that lie on others.
pub(super) const BAND_OPACITY: f64 = 0.22;
