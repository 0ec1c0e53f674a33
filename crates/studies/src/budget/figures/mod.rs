//! Pictures of a budget: for each subject the shares of its variance, its size over time, and a tornado of the end.

mod curves;
mod look;
mod shares;
mod tornado;

use super::Contribution;
use super::scene::Scene;
use super::subject::{size, words};
use crate::figure::{Axis, Figure};
use crate::scenario::Required;
use look::Look;

/// Sources that a picture names at most; the rest is one.
const NAMED: usize = 9;

/// The same sources at times closer together, up to the first row.
pub struct Beginning<'a> {
    pub scene: &'a Scene<'a>,
    pub contributions: &'a [Contribution],
}

/// The pictures of each of `subjects`: `shares_heading`, `sigma_heading`, `tornado_heading`. A source has one colour in all of
/// them.
pub fn figures(
    title: &str,
    subjects: &[Required],
    scene: &Scene,
    contributions: &[Contribution],
    beginning: &Beginning,
) -> Vec<(String, Figure)> {
    let conditions = format!(
        "{}, latitude {:.4}°, {} Hz",
        scene.study.motion.words(),
        scene.study.start.position.lat.to_degrees(),
        scene.study.imu.rate
    );
    let figure =
        |what: &str, x: Axis| Figure::new(format!("{title}: {what}"), x).subtitle(conditions.clone());
    let look = Look::new(subjects, contributions);
    let mut all = Vec::new();
    for &of in subjects {
        let (name, what) = (of.name(), words(of));
        let shares = shares::panel(of, &look, scene, contributions, beginning);
        let drawn = figure(&format!("shares of the variance of {what}"), Axis::time("time")).panel(shares);
        all.push((format!("shares_{name}"), drawn));
        let curves = curves::panel(of, &look, scene, contributions);
        let drawn = figure(&format!("{what}, 1 σ"), Axis::time("time")).panel(curves);
        all.push((format!("sigma_{name}"), drawn));
        let (x, rows) = tornado::panel(of, &look, scene, contributions);
        let end = scene.time(scene.end());
        all.push((format!("tornado_{name}"), figure(&format!("{what} at {end} s, 1 σ"), x).panel(rows)));
    }
    all
}
