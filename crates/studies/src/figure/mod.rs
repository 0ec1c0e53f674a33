//! Static figures: PNG and SVG, with the same look on every machine.
//!
//! A [`Figure`] is data: a title, one x axis and one or several [`Panel`]s above each other that share it.
//! Everything that has to do with the drawing library stays inside this module.
//!
//! ```no_run
//! use schuler_studies::figure::{Axis, Figure, Panel, Series};
//! # fn main() -> Result<(), schuler_studies::figure::FigureError> {
//! let curve = (0..=1440).map(|k| [60.0 * k as f64, (k as f64 / 13.43).sin()]);
//! Figure::new("Schuler oscillation", Axis::time("time"))
//!     .subtitle("100 µg on the north accelerometer")
//!     .panel(Panel::new(Axis::linear("north error (km)")).with(Series::line("exact", curve)))
//!     .write_png("drift.png".as_ref())?;
//! # Ok(())
//! # }
//! ```

mod canvas;
mod chart;
mod colour;
mod decimate;
mod font;
mod legend;
mod map;
mod raster;
mod series;
#[cfg(test)]
mod tests;
mod ticks;
mod unit;
mod vector;

use std::path::{Path, PathBuf};

pub use colour::Colour;
pub use series::{Data, Panel, Series, Style};
pub use unit::{Quantity, Shown};

/// What an axis measures along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Numbers as they are.
    Linear,
    /// Decades; values that are not positive are left out.
    Log,
    /// Values are seconds; ticks stand at whole seconds, minutes, hours or days, and the unit is added to the label.
    Time,
}

/// An axis: its label with the unit in it (`north error (m)`), its scale, and its ends where the data shall not set them.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity and unit, as in `heading error (arcmin)`; a time axis gets its unit from the ticks.
    pub label: String,
    /// Linear, logarithmic or time.
    pub scale: Scale,
    /// Ends in data units; `None` means as wide as the data.
    pub range: Option<[f64; 2]>,
    /// Of an axis of rows, what stands at -0, -1, -2 and so on in place of numbers; else empty.
    pub names: Vec<String>,
}

impl Axis {
    /// A linear axis as wide as the data.
    pub fn linear(label: impl Into<String>) -> Self {
        Axis { label: label.into(), scale: Scale::Linear, range: None, names: Vec::new() }
    }

    /// A logarithmic axis as wide as the positive data.
    pub fn log(label: impl Into<String>) -> Self {
        Axis { label: label.into(), scale: Scale::Log, range: None, names: Vec::new() }
    }

    /// A time axis: the data are seconds, the label carries no unit.
    pub fn time(label: impl Into<String>) -> Self {
        Axis { label: label.into(), scale: Scale::Time, range: None, names: Vec::new() }
    }

    /// An axis of rows, the first on top at 0, the next at -1 and so on, each with its name.
    pub fn rows(names: Vec<String>) -> Self {
        let count = names.len() as f64;
        Axis { names, ..Axis::linear("") }.from_to(0.5 - count, 0.5)
    }

    /// The same axis from `low` to `high` (data units); what lies outside is cut off.
    pub fn from_to(mut self, low: f64, high: f64) -> Self {
        self.range = Some([low, high]);
        self
    }
}

/// A figure of one or several panels that share the x axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// First line, bold; wrapped if it is long.
    pub title: String,
    /// Second line, grey: the conditions (`lat 45°, 24 h, 100 Hz`). May be empty.
    pub subtitle: String,
    /// The x axis of all panels.
    pub x: Axis,
    /// Panels from top to bottom.
    pub panels: Vec<Panel>,
    /// One unit of x is as long as one unit of y (maps); for linear axes only.
    pub equal_aspect: bool,
    /// Width and height in points; `None` takes 800 × a height that suits the number of panels.
    pub size: Option<(u32, u32)>,
}

impl Figure {
    /// A figure without panels yet.
    pub fn new(title: impl Into<String>, x: Axis) -> Self {
        Figure {
            title: title.into(),
            subtitle: String::new(),
            x,
            panels: Vec::new(),
            equal_aspect: false,
            size: None,
        }
    }

    /// The figure with its second line.
    pub fn subtitle(mut self, text: impl Into<String>) -> Self {
        self.subtitle = text.into();
        self
    }

    /// The figure with one more panel at the bottom.
    pub fn panel(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// The figure with equal scales along x and y.
    pub fn equal_aspect(mut self) -> Self {
        self.equal_aspect = true;
        self
    }

    /// The figure as an SVG document of [`Figure::points`] size.
    ///
    /// # Errors
    /// [`FigureError::Drawing`] if the drawing library refuses.
    pub fn to_svg(&self) -> Result<String, FigureError> {
        vector::svg(self.points(), |canvas| chart::draw(self, canvas))
    }

    /// Writes the figure as SVG.
    ///
    /// # Errors
    /// [`FigureError::Write`] if the file cannot be written, [`FigureError::Drawing`] if the drawing library refuses.
    pub fn write_svg(&self, path: &Path) -> Result<(), FigureError> {
        std::fs::write(path, self.to_svg()?)
            .map_err(|e| FigureError::Write { path: path.into(), reason: e.to_string() })
    }

    /// Writes the figure as PNG of [`Figure::points`] × [`PIXELS_PER_POINT`] pixels.
    ///
    /// # Errors
    /// [`FigureError::Write`] if the file cannot be written, [`FigureError::Drawing`] if the drawing library refuses.
    pub fn write_png(&self, path: &Path) -> Result<(), FigureError> {
        raster::png(self.points(), path, |canvas| chart::draw(self, canvas))
    }

    /// Width and height in points.
    pub fn points(&self) -> (u32, u32) {
        // Below this nothing would be left of the panels; above it memory is wasted.
        let bounded = |n: u32| n.clamp(240, 4000);
        let height = match self.panels.len() {
            0 | 1 => 500,
            n => 140 + 175 * n.min(20) as u32,
        };
        let (w, h) = self.size.unwrap_or((800, height));
        let h = if self.size.is_some() {
            h
        } else {
            chart::height_with_legend(self, f64::from(w), f64::from(h)) as u32
        };
        (bounded(w), bounded(h))
    }
}

/// Pixels of a PNG per point of [`Figure::points`].
pub const PIXELS_PER_POINT: f64 = 1.5;

/// Why a figure could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// The file could not be written.
    #[error("cannot write figure {}: {reason}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system or the encoder said.
        reason: String,
    },
    /// The drawing library refused.
    #[error("cannot draw figure: {0}")]
    Drawing(String),
}
