//! The cases of a drift study: each error source alone, and all together.

use schuler_frames::{T, Vec3};
use schuler_imu::process::Polynomial;
use schuler_imu::{Component, Instrument, Spec};
use schuler_strapdown::static_base::Drivers;

use super::scene::Scene;
use crate::scenario::{Drift, Initial};

/// One case: the error sources that act in it.
#[derive(Clone)]
pub struct Case {
    /// `gyro.bias.constant.x`, `initial.tilt.n`, `gyro.bias.white` or `all`.
    pub name: String,
    /// Sensor errors.
    pub spec: Spec,
    /// Initial errors.
    pub initial: Vec<Initial>,
}

/// All cases of a study. What is known as a function of time stands alone component by component; random
/// sources stand alone with all their axes, as their laws are stated.
pub fn cases(drift: &Drift) -> Vec<Case> {
    let spec = &drift.imu.spec;
    let mut cases = Vec::new();
    for source in spec.sources() {
        let (known, random): (Vec<_>, Vec<_>) =
            source.components().partition(|c| c.evolution().deterministic().is_some());
        // A component given as zero says "not this axis".
        for c in known.iter().filter(|c| c.evolution().deterministic().is_some_and(acts)) {
            cases.push(Case { name: c.to_string(), spec: spec.only(c), initial: Vec::new() });
        }
        if !random.is_empty() {
            let wanted = |c: &Component| random.iter().any(|r| r.is(c));
            cases.push(Case {
                name: source.name().to_string(),
                spec: spec.keep(wanted),
                initial: Vec::new(),
            });
        }
    }
    for initial in &drift.initial_errors {
        cases.push(Case { name: initial.name.into(), spec: Spec::new(), initial: vec![*initial] });
    }
    cases.push(Case { name: "all".into(), spec: spec.clone(), initial: drift.initial_errors.clone() });
    cases
}

fn acts(p: Polynomial) -> bool {
    p.value != 0.0 || p.rate != 0.0
}

impl Case {
    /// Whether anything in it is drawn at random.
    pub fn is_random(&self) -> bool {
        self.spec.components().any(|c| c.evolution().deterministic().is_none())
    }

    /// Whether its sensor errors are the same in every sample of a base at rest.
    pub fn is_steady(&self) -> bool {
        self.spec.components().all(|c| c.evolution().deterministic().is_some_and(|p| p.rate == 0.0))
    }

    /// Initial errors in t: position (m), velocity (m/s), phi (rad).
    pub fn initial_errors(&self) -> [[f64; 3]; 3] {
        let mut sum = [[0.0; 3]; 3];
        for i in &self.initial {
            for (part, more) in sum.iter_mut().zip([i.position, i.velocity, i.phi]) {
                (0..3).for_each(|k| part[k] += more[k]);
            }
        }
        sum
    }

    /// Known sensor errors along body axes: constant part and rate, of gyro and accelerometer.
    pub fn known_errors(&self, scene: &Scene) -> [[[f64; 3]; 2]; 2] {
        let mut sum = [[[0.0; 3]; 2]; 2];
        for c in self.spec.components() {
            let Some(p) = c.evolution().deterministic() else { continue };
            let column = column(&c, scene);
            for (part, factor) in sum[c.instrument() as usize].iter_mut().zip([p.value, p.rate]) {
                (0..3).for_each(|k| part[k] += column[k] * factor);
            }
        }
        sum
    }

    /// The known part as drivers of the closed forms.
    pub fn drivers(&self, scene: &Scene) -> Drivers {
        let [position, velocity, phi] = self.initial_errors();
        let to_t = |x: [f64; 3]| -> Vec3<T> { scene.truth.c_tb * Vec3::claim(x) };
        let [[eps, eps_rate], [nabla, nabla_rate]] = self.known_errors(scene);
        let site = &scene.site;
        Drivers {
            phi0: Vec3::claim(phi),
            dv0: Vec3::claim(velocity),
            dlat0: position[0] / site.r_m,
            dlon0: position[1] / (site.r_n * site.cos_lat),
            eps: to_t(eps),
            nabla: to_t(nabla),
            eps_rate: to_t(eps_rate),
            nabla_rate: to_t(nabla_rate),
        }
    }
}

/// Output error along body axes of a unit coefficient, on this base.
pub fn column(c: &Component, scene: &Scene) -> [f64; 3] {
    c.term().regressor(&scene.input(c.instrument())).columns()[c.coefficient()]
}

const _: () = assert!(Instrument::Gyro as usize == 0, "gyro first in the order of known_errors");
