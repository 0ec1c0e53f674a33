//! The rows of a budget: each component of an error source, each component of the initial error.

use nalgebra::SMatrix;
use schuler_imu::process::ParameterUnit;
use schuler_imu::{Component, Spec, Unit};
use schuler_strapdown::filter::{Form, Model, NavStates};

use super::alignment;
use super::scene::Scene;
use crate::scenario::{Aid, Aiding, Budget, Initial, MeasuredKind, Vertical};

/// States of one component beside the nine navigation errors: no process has more.
pub const ROOM: usize = 9 + schuler_imu::process::MAX_STATES;

/// The process that is none in continuous time.
pub const ROUNDING: &str = "quantization";

/// Covariance of the nine navigation errors in the order of [`schuler_strapdown::NavError::as_array`].
pub type Nine = SMatrix<f64, 9, 9>;
/// Covariance of navigation errors and the states of one component.
pub type Joint = SMatrix<f64, ROOM, ROOM>;
/// States of one component.
pub type Joined = Model<ROOM>;

/// One row of a budget.
#[derive(Clone)]
pub struct Source {
    /// `gyro.bias.constant.x` or `initial.tilt.n`.
    pub name: String,
    /// What it is.
    pub kind: Kind,
}

/// What a row is.
#[derive(Clone)]
pub enum Kind {
    /// One coefficient of a sensor error.
    Sensor(Box<Component>),
    /// One initial error; its numbers are standard deviations.
    Initial(Initial),
    /// One component of the noise of a measurement.
    Noise(Noise),
}

/// One component of the noise of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Of what.
    pub kind: MeasuredKind,
    /// Number of the component.
    pub axis: usize,
}

/// A coefficient that is known but for its size: standard deviations of its value at t = 0 and of its rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size {
    /// In the coefficient's unit.
    pub value: f64,
    /// In the coefficient's unit per second.
    pub rate: f64,
}

/// All rows; components of size zero ("not this axis") are left out.
pub fn sources(study: &Budget) -> Vec<Source> {
    let sensors = study
        .imu
        .spec
        .components()
        .map(|c| Source { name: c.to_string(), kind: Kind::Sensor(Box::new(c)) })
        .filter(|s| s.size().is_none_or(|size| size.value != 0.0 || size.rate != 0.0));
    let initial =
        study.initial_sigmas.iter().map(|i| Source { name: i.name.into(), kind: Kind::Initial(*i) });
    sensors.chain(initial).chain(noises(study)).collect()
}

/// The noises of the measurements, components that the vertical channel or a size of zero leaves out are left out.
fn noises(study: &Budget) -> Vec<Source> {
    let mut all = Vec::new();
    if let Some(filter) = &study.filter {
        for (kind, aid) in measurements(&filter.aiding) {
            for (axis, name) in kind.parts().iter().enumerate() {
                let seen = axis != 2 || study.mechanization.vertical != Vertical::Held;
                if seen && aid.sigma[axis] > 0.0 {
                    let kind = Kind::Noise(Noise { kind, axis });
                    all.push(Source { name: format!("aiding.{name}"), kind });
                }
            }
        }
    }
    all
}

/// What is measured.
pub fn measurements(aiding: &Aiding) -> impl Iterator<Item = (MeasuredKind, &Aid)> {
    [
        (MeasuredKind::Position, &aiding.position),
        (MeasuredKind::Velocity, &aiding.velocity),
        (MeasuredKind::Height, &aiding.height),
        (MeasuredKind::Heading, &aiding.heading),
    ]
    .into_iter()
    .filter_map(|(kind, aid)| Some((kind, aid.as_ref()?)))
}

impl Source {
    /// The number of the scenario that it is as large as: its name, its SI unit and its size.
    pub fn parameter(&self, scene: &Scene) -> (&'static str, Unit, f64) {
        const SPEED: Unit = Unit::METRE.over(Unit::SECOND);
        const SIGMA: &str = "sigma";
        match &self.kind {
            Kind::Sensor(component) => {
                let evolution = component.evolution();
                let form = evolution.kind.forms()[evolution.arguments.form];
                let sized =
                    |p: &&schuler_imu::process::Parameter| matches!(p.unit, ParameterUnit::Coefficient(_));
                let number = form.iter().position(|p| sized(&p)).unwrap_or(0);
                let size = (evolution.gain * evolution.arguments.values[number]).abs();
                (form[number].name, form[number].unit_for(component.unit()), size)
            }
            Kind::Initial(i) => {
                let size = |x: [f64; 3]| x.into_iter().sum::<f64>();
                let all = [(Unit::METRE, i.position), (SPEED, i.velocity), (Unit::RADIAN, i.phi)];
                let (unit, of) = all.into_iter().find(|(_, x)| size(*x) != 0.0).unwrap_or(all[0]);
                (SIGMA, unit, size(of))
            }
            Kind::Noise(noise) => {
                let unit = match noise.kind {
                    MeasuredKind::Position | MeasuredKind::Height => Unit::METRE,
                    MeasuredKind::Velocity => SPEED,
                    MeasuredKind::Heading => Unit::RADIAN,
                };
                let filter = scene.study.filter.as_ref();
                let aid = filter.and_then(|f| measurements(&f.aiding).find(|(k, _)| *k == noise.kind));
                (SIGMA, unit, aid.map_or(0.0, |(_, aid)| aid.sigma[noise.axis]))
            }
        }
    }

    /// The nine initial errors of one standard deviation.
    pub fn initial(&self) -> [f64; 9] {
        match &self.kind {
            Kind::Sensor(_) | Kind::Noise(_) => [0.0; 9],
            Kind::Initial(i) => {
                let all = [i.position, i.velocity, i.phi];
                std::array::from_fn(|k| all[k / 3][k % 3])
            }
        }
    }

    /// The list of sensor errors with this one alone.
    pub fn spec(&self, all: &Spec) -> Spec {
        match &self.kind {
            Kind::Sensor(component) => all.only(component),
            Kind::Initial(_) | Kind::Noise(_) => Spec::new(),
        }
    }

    /// Navigation errors and states of the source. One component always has room.
    pub fn model(&self, all: &Spec) -> Joined {
        Model::new(Form::Phi, NavStates::ALL, &self.spec(all))
            .expect("invariant: no component has more states than there is room for")
    }

    /// The coefficient whose integral is rounded, and the standard deviation of that, if it is such a source.
    pub fn rounding(&self) -> Option<(Component, f64)> {
        let Kind::Sensor(component) = &self.kind else { return None };
        let evolution = component.evolution();
        let q = evolution.gain.abs() * evolution.arguments.values[0];
        (evolution.kind.name() == ROUNDING).then_some((**component, q))
    }

    /// Second moment of all states at t = 0, after the alignment where there is one. A fixed value counts as a standard
    /// deviation of its size.
    pub fn start(&self, scene: &Scene, model: &Joined) -> Joint {
        let p = model.p0(&self.initial()).expect("invariant: standard deviations of a valid scenario");
        let x = model.x0();
        let p = p + x * x.transpose();
        match (&self.kind, scene.study.alignment) {
            (Kind::Sensor(_), 1..) => alignment::covariance(scene, model, &p),
            _ => p,
        }
    }

    /// The size of a coefficient that is constant or a ramp, at the beginning of the alignment or at t = 0 without; `None`
    /// of a process that is random in time, and of what is no sensor error.
    pub fn size(&self) -> Option<Size> {
        let Kind::Sensor(component) = &self.kind else { return None };
        let m = component.evolution().linear_model();
        let moves = m.white != 0.0 || m.q.iter().flatten().any(|q| *q != 0.0);
        let size = |k: usize| m.c[0].abs() * (m.p0[k][k] + m.x0[k] * m.x0[k]).sqrt();
        match m.n {
            1 if !moves && m.a[0][0] == 0.0 => Some(Size { value: size(0), rate: 0.0 }),
            2 if !moves && m.a[0][..2] == [0.0, 1.0] && m.a[1][..2] == [0.0; 2] && size(0) == 0.0 => {
                Some(Size { value: 0.0, rate: size(1) })
            }
            _ => None,
        }
    }
}
