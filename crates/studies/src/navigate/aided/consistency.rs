//! Words for a filter whose numbers are finite and wrong.

use super::Row;

/// Begin of every such note.
pub const WARNING: &str = "NOT CONSISTENT";

/// Mean NIS, 1 in a consistent filter, beyond which it is no matter of chance, where it is above its band too.
const FAR_NIS: f64 = 2.0;

/// Mean NEES beyond which errors are more than twice what the filter claims; it is correlated over all of a run and has no band.
const FAR_NEES: f64 = 4.0;

/// Share of refused measurements from which on it is the navigator that is lost.
const MOST: f64 = 0.5;

/// What the innovations of `name` say: `offered` and `refused` scalars, and the sum of the normalized squares of those taken, `high` being the upper end of the band of
/// their mean.
pub fn innovations(name: &str, offered: u64, refused: u64, nis: f64, high: f64) -> Option<String> {
    let taken = offered - refused;
    let mean = nis / taken as f64;
    if refused as f64 > MOST * offered as f64 {
        return Some(format!(
            "{WARNING}: {refused} of {offered} scalar measurements of {name} are refused: the navigator is lost, or the standard deviations at the start or of the measurements are too small; look at the start, the units, `offset` and `lever_arm`"
        ));
    }
    (taken > 0 && mean > FAR_NIS.max(high)).then(|| {
        format!(
            "{WARNING}: the mean NIS of {name} is {mean:.1}, not 1: innovations are {:.1} times what the filter expects; look at the start and its standard deviations, at those of the measurements, and at units, `offset`, `lever_arm` and the error sources of the filter",
            mean.sqrt()
        )
    })
}

/// What the errors against the reference say: NEES of the rows.
pub fn errors(rows: &[Row]) -> Option<String> {
    let ratios: Vec<(f64, f64)> = rows
        .iter()
        .filter_map(|row| Some((row.t, row.error.as_ref()?.1?)))
        .map(|(t, (nees, dof))| (t, nees / dof as f64))
        .collect();
    let mean = ratios.iter().map(|(_, ratio)| ratio).sum::<f64>() / ratios.len() as f64;
    if ratios.is_empty() || mean <= FAR_NEES {
        return None;
    }
    let (worst, largest) = ratios
        .iter()
        .fold((f64::NAN, 0.0), |(at, most), &(t, ratio)| if ratio > most { (t, ratio) } else { (at, most) });
    Some(format!(
        "{WARNING}: the mean NEES of a degree of freedom is {mean:.1}, not 1, and {largest:.1} at {worst} s: errors against the reference are {:.1} times what the filter claims",
        mean.sqrt()
    ))
}
