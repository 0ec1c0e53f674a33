//! What is drawn in a panel.

use super::{Axis, Colour};

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Solid line.
    Line,
    /// Long dashes: by custom the closed form beside a simulated curve.
    Dashed,
    /// Dots on a line.
    Dotted,
    /// Dash, dot.
    DashDot,
    /// A disc at each point, no line.
    Points,
}

/// The numbers of a series. A value that is not finite interrupts the line.
#[derive(Clone, Debug, PartialEq)]
pub enum Data {
    /// `[x, y]`.
    Points(Vec<[f64; 2]>),
    /// `[x, low, high]`: the area between, for example a confidence band.
    Band(Vec<[f64; 3]>),
}

/// One curve or band.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Text in the legend; an empty one stays out of it.
    pub label: String,
    /// The numbers, in the units of the axes.
    pub data: Data,
    /// Line style; without effect on a band.
    pub style: Option<Style>,
    /// Colour; `None` takes the next of the palette, the same in all panels for the same label.
    pub colour: Option<Colour>,
    /// Of a band: opaque, with an edge, as one of several that are stacked; else what lies below it can be seen.
    pub solid: bool,
}

impl Series {
    /// A solid line through `points`.
    pub fn line(label: impl Into<String>, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let data = Data::Points(points.into_iter().collect());
        Series { label: label.into(), data, style: None, colour: None, solid: false }
    }

    /// The area between `low` and `high` of `[x, low, high]`.
    pub fn band(label: impl Into<String>, band: impl IntoIterator<Item = [f64; 3]>) -> Self {
        let data = Data::Band(band.into_iter().collect());
        Series { label: label.into(), data, style: None, colour: None, solid: false }
    }

    /// The series in another line style.
    pub fn style(mut self, style: Style) -> Self {
        self.style = Some(style);
        self
    }

    /// The band as an opaque area.
    pub fn solid(mut self) -> Self {
        self.solid = true;
        self
    }

    /// The series in a colour of the caller's choice.
    pub fn colour(mut self, colour: Colour) -> Self {
        self.colour = Some(colour);
        self
    }
}

/// One y axis and its series.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// The y axis.
    pub y: Axis,
    /// Drawn in this order: later ones lie above earlier ones.
    pub series: Vec<Series>,
}

impl Panel {
    /// An empty panel.
    pub fn new(y: Axis) -> Self {
        Panel { y, series: Vec::new() }
    }

    /// The panel with one more series.
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }
}
