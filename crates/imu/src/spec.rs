//! The list of all error sources of an IMU.

use core::fmt::{self, Write};

use crate::error::Error;
use crate::readout::Readout;
use crate::{Component, Source, Truth};

/// Most sources in a specification.
pub const MAX_SOURCES: usize = 64;

/// All error sources of an IMU. Kept in place: nothing is allocated.
#[derive(Clone, Debug, PartialEq)]
pub struct Spec {
    sources: [Option<Source>; MAX_SOURCES],
    len: usize,
    /// Temperature at which thermal terms vanish, K.
    pub calibration_temperature: f64,
    /// What happens to the sum; `None` passes it through.
    pub readout: Option<Readout>,
}

impl Default for Spec {
    fn default() -> Self {
        Self::new()
    }
}

impl Spec {
    /// A perfect IMU: no sources, calibrated at 20 °C.
    pub const fn new() -> Spec {
        Spec {
            sources: [None; MAX_SOURCES],
            len: 0,
            calibration_temperature: Truth::TEMPERATURE,
            readout: None,
        }
    }

    /// Adds a source. Where one of the same instrument, term and process exists, it is `#2`, `#3`, ….
    ///
    /// # Errors
    /// There are [`MAX_SOURCES`] already.
    pub fn push(&mut self, mut source: Source) -> Result<(), Error> {
        let same = |s: &&Source| {
            s.instrument() == source.instrument()
                && s.term() == source.term()
                && s.process().kind() == source.process().kind()
        };
        let used = self.sources().filter(same).map(|s| s.occurrence).max().unwrap_or(0);
        source.occurrence = used + 1;
        let slot = self.sources.get_mut(self.len).ok_or(Error::Capacity {
            what: "sources",
            need: MAX_SOURCES + 1,
            capacity: MAX_SOURCES,
        })?;
        *slot = Some(source);
        self.len += 1;
        Ok(())
    }

    /// From a list of sources.
    ///
    /// # Errors
    /// As [`Spec::push`].
    pub fn from_sources(sources: impl IntoIterator<Item = Source>) -> Result<Spec, Error> {
        let mut spec = Spec::new();
        for source in sources {
            spec.push(source)?;
        }
        Ok(spec)
    }

    /// The sources, in the order in which they were added.
    pub fn sources(&self) -> impl Iterator<Item = &Source> {
        self.sources[..self.len].iter().flatten()
    }

    /// The components of all sources.
    pub fn components(&self) -> impl Iterator<Item = Component> {
        self.sources().flat_map(Source::components)
    }

    /// The component of that name (`gyro.bias.constant.x`), if there is one.
    pub fn component(&self, name: &str) -> Option<Component> {
        self.components().find(|c| {
            let mut rest = Rest(name);
            write!(rest, "{c}").is_ok() && rest.0.is_empty()
        })
    }

    /// Only that component, without readout; its random draws are those of the full specification.
    pub fn only(&self, component: &Component) -> Spec {
        self.keep(|c| c.is(component))
    }

    /// All but that component; the others' random draws are as they were.
    pub fn without(&self, component: &Component) -> Spec {
        Spec { readout: self.readout, ..self.keep(|c| !c.is(component)) }
    }

    /// Only the components that `wanted` says; their random draws are as they were.
    pub fn keep(&self, mut wanted: impl FnMut(&Component) -> bool) -> Spec {
        let mut spec = Spec { calibration_temperature: self.calibration_temperature, ..Spec::new() };
        for source in self.sources() {
            let active =
                source.components().filter(|c| wanted(c)).fold(0, |mask, c| mask | 1 << c.coefficient());
            if active != 0 {
                spec.sources[spec.len] = Some(source.masked(active));
                spec.len += 1;
            }
        }
        spec
    }

    /// Every coefficient times `factor`, random ones too with the same draws: -1 gives the opposite errors.
    pub fn scaled(&self, factor: f64) -> Spec {
        let mut spec = self.clone();
        for source in spec.sources[..spec.len].iter_mut().flatten() {
            source.gain *= factor;
        }
        spec
    }
}

/// What is left of a text after a prefix has been written against it.
struct Rest<'a>(&'a str);

impl Write for Rest<'_> {
    fn write_str(&mut self, s: &str) -> fmt::Result {
        self.0 = self.0.strip_prefix(s).ok_or(fmt::Error)?;
        Ok(())
    }
}
