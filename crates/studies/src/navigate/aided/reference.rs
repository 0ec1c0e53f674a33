//! A trajectory that the result is compared with.

use schuler_frames::{Euler, Geodetic, Rot, Vec3};
use schuler_strapdown::Pva;

use crate::log;
use crate::scenario::Reference;
use crate::{Context, Error, Scenario};

/// Its rows, in the order of time.
pub struct Known {
    pub file: String,
    rows: Vec<(f64, Pva)>,
}

/// Time, latitude, longitude and height are read first, then the other six of the ten columns.
const FIRST: usize = 4;

/// # Errors
/// The file is not there or wrong somewhere.
pub fn read(scenario: &Scenario, reference: &Reference, context: &Context) -> Result<Known, Error> {
    let data = context.data.as_deref();
    let file = log::find_named(&reference.file, "filter.reference.file", "", data, &scenario.file)?;
    let (columns, signs, angle) = (&reference.columns, &reference.signs, reference.angle);
    let places = log::rows(&file, &columns[..FIRST], reference.layout)?;
    let with_time: Vec<_> = columns[..1].iter().chain(&columns[FIRST..]).cloned().collect();
    let rest = log::rows(&file, &with_time, reference.layout)?;
    let rows = places.iter().zip(&rest).map(|(place, rest)| {
        let x: Vec<f64> =
            place[..FIRST].iter().chain(&rest[1..]).zip(signs).map(|(x, sign)| sign * x).collect();
        let position = Geodetic::new(angle * x[1], angle * x[2], x[3]);
        let c_tb = Rot::from_euler(Euler::new(angle * x[7], angle * x[8], angle * x[9]));
        (x[0] + reference.offset, Pva { position, v_t: Vec3::new(x[4], x[5], x[6]), c_tb })
    });
    Ok(Known { file: file.display().to_string(), rows: rows.collect() })
}

impl Known {
    /// The row whose time is within `slack` (s) of `t`.
    pub fn at(&self, t: f64, slack: f64) -> Option<&Pva> {
        let next = self.rows.partition_point(|row| row.0 < t - slack);
        self.rows.get(next).filter(|row| row.0 <= t + slack).map(|row| &row.1)
    }
}
