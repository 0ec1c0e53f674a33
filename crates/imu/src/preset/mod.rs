//! Presets: the figures of real devices as their sources print them, and the sources of error they become.

use crate::error::Error;
use crate::{Instrument, Source, Spec, Unit, Value};

mod devices;
mod grades;
mod units;

pub use devices::DEVICES;
pub use grades::GRADES;
pub use units::PrintedUnit;

/// A device or a grade of devices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preset {
    /// Name in files, `stim300`.
    pub name: &'static str,
    /// Who makes it and what it is called.
    pub device: &'static str,
    /// Where its figures were seen, with the revision of the sheet where it is known.
    pub source: &'static str,
    /// What kind of figures they are.
    pub kind: Kind,
    /// The figures, also those that no source is made from.
    pub figures: &'static [Figure],
    /// Disagreements between sources, and what a figure leaves open.
    pub note: &'static str,
}

/// How far the figures of a preset can be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// From the maker's data sheet, directly or quoted.
    Sheet,
    /// Measured or collected by somebody else.
    ThirdParty,
    /// What another program uses for the device; not data-sheet values.
    Program,
    /// One device or class stands for a grade.
    Grade,
}

/// A figure as printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// On which instrument.
    pub instrument: Instrument,
    /// What it becomes.
    pub role: Role,
    /// The figure as its source prints it, `0.15 deg/sqrt(h)`.
    pub printed: &'static str,
    /// Its number.
    pub number: f64,
    /// Its unit.
    pub unit: PrintedUnit,
}

/// What a figure becomes. Figures printed as ± or as a maximum count as one standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Role {
    /// White noise of the bias: angle or velocity random walk, noise density.
    White,
    /// Bias from run to run.
    Bias,
    /// Bias instability: the lowest point of the Allan deviation, 0.6643 B, flat over [`BAND`].
    Instability,
    /// Correlated bias of this correlation time, s.
    Markov(f64),
    /// Scale factor error.
    ScaleFactor,
    /// Misalignment or non-orthogonality.
    Misalignment,
    /// Sensitivity of the rate to specific force.
    GSensitivity,
    /// Sensitivity of the bias to temperature.
    Thermal,
    /// Sensitivity of the scale factor to temperature.
    ThermalScaleFactor,
    /// Second-order non-linearity.
    Quadratic,
    /// Kept as text: another figure of the same thing is used, or it is no error of the sum.
    Shown(&'static str),
}

/// Band of averaging times over which a bias instability is taken to be flat, s. Sheets do not say.
pub const BAND: [f64; 2] = [10.0, 10_000.0];

/// sqrt(2 ln 2/pi): flat Allan deviation of flicker noise of B = 1.
const FLAT: f64 = 0.664_282_466_158_506_3;

impl Figure {
    /// The figure in SI units with angles in radians.
    pub fn si(&self) -> f64 {
        self.number * self.unit.factor
    }

    /// Dimension of the figure.
    pub fn dimension(&self) -> Unit {
        self.unit.unit
    }

    /// The source of error that the figure becomes, if it becomes one.
    ///
    /// # Errors
    /// The figure is negative or no number; none of [`DEVICES`] and [`GRADES`] is.
    pub fn as_source(&self) -> Result<Option<Source>, Error> {
        let si = self.si();
        let source = |term: &str, process: &str, given: &[(&str, Value<'_>)]| {
            Source::named(self.instrument, term, process, given).map(Some)
        };
        let drawn = |term: &str| source(term, "constant", &[("sigma", si.into())]);
        match self.role {
            Role::White => source("bias", "white", &[("density", si.into())]),
            Role::Bias => drawn("bias"),
            Role::Instability => source(
                "bias",
                "flicker",
                &[
                    ("instability", (si / FLAT).into()),
                    ("tau_min", BAND[0].into()),
                    ("tau_max", BAND[1].into()),
                ],
            ),
            Role::Markov(tau) => source("bias", "gauss_markov", &[("sigma", si.into()), ("tau", tau.into())]),
            Role::ScaleFactor => drawn("scale_factor"),
            Role::Misalignment => drawn("misalignment"),
            Role::GSensitivity => drawn("g_sensitivity"),
            Role::Thermal => drawn("thermal"),
            Role::ThermalScaleFactor => drawn("thermal_scale_factor"),
            Role::Quadratic => drawn("quadratic"),
            Role::Shown(_) => Ok(None),
        }
    }
}

impl Preset {
    /// The specification that the figures make, on every axis the same.
    ///
    /// # Errors
    /// As [`Figure::as_source`].
    pub fn spec(&self) -> Result<Spec, Error> {
        let mut spec = Spec::new();
        for figure in self.figures {
            if let Some(source) = figure.as_source()? {
                spec.push(source)?;
            }
        }
        Ok(spec)
    }
}

/// All presets: devices, then grades.
pub fn presets() -> impl Iterator<Item = &'static Preset> {
    DEVICES.iter().chain(GRADES)
}

/// The preset called `name`, if there is one.
pub fn preset(name: &str) -> Option<&'static Preset> {
    presets().find(|p| p.name == name)
}
