//! The motion of a study, read from a file where it is recorded in one.

use std::{
    fs::File,
    io::Read,
    path::{Path, PathBuf},
};

use flate2::read::MultiGzDecoder;
use schuler_frames::{Euler, Geodetic};

use crate::{
    Context, Diagnostic, Error, Scenario,
    scenario::{Motion, Simulate, TrajectoryFile},
    trajectory::{Recorded, Residual, Row, Shaken, Trajectory},
};

/// The trajectory of `motion`, and how well splines follow the rows of a file.
///
/// # Errors
/// The file is not there, has a wrong row, or is no possible trajectory.
pub fn trajectory(
    scenario: &Scenario,
    study: &Simulate,
    motion: &Motion,
    context: &Context,
) -> Result<(Box<dyn Trajectory>, Option<Residual>), Error> {
    match motion {
        Motion::File(spec) => {
            let file = find(spec, context.data.as_deref(), &scenario.file)?;
            let recorded = read(spec, &file)?;
            let end = recorded.duration().unwrap_or_default();
            let asked = study.samples as f64 / study.imu.rate;
            if asked > end * (1.0 + 1e-12) {
                return Err(Diagnostic::new(&file, "the trajectory ends before the duration")
                    .expected(format!("`duration` of {end:.3} s or less"))
                    .found(format!("{asked} s"))
                    .into());
            }
            let residual = recorded.residual();
            Ok((Box::new(recorded), Some(residual)))
        }
        Motion::Shaken(carrier, axes) => {
            let (carrier, residual) = trajectory(scenario, study, carrier, context)?;
            Ok((Box::new(Shaken::new(carrier, axes.clone())), residual))
        }
        _ => {
            let dt = 1.0 / study.imu.rate;
            let trajectory = motion.trajectory(&study.start, study.gravity, study.samples, dt);
            let possible = trajectory.ok().flatten();
            Ok((
                possible.expect("invariant: the motion of a valid scenario is possible, and not zero truth"),
                None,
            ))
        }
    }
}

/// What a reader of the numbers must know of the fit.
pub fn note(residual: &Residual) -> String {
    let [n, e, d] = residual.position_rms;
    let [roll, pitch, yaw] = residual.attitude_rms.map(f64::to_degrees);
    format!(
        "The splines are off the recorded rows by {n:.3e}, {e:.3e}, {d:.3e} m (north, east, down, rms; at most {:.3e} m) and by {roll:.3e}, {pitch:.3e}, {yaw:.3e} deg (roll, pitch, yaw; at most {:.3e} deg)",
        residual.position_largest,
        residual.attitude_largest.to_degrees()
    )
}

/// In the data folder, then beside the scenario.
fn find(spec: &TrajectoryFile, data: Option<&Path>, scenario: &Path) -> Result<PathBuf, Error> {
    let beside = scenario.parent().unwrap_or(Path::new(""));
    let places: Vec<PathBuf> =
        data.into_iter().chain([beside]).map(|folder| folder.join(&spec.file)).collect();
    if let Some(found) = places.iter().find(|place| place.is_file()) {
        return Ok(found.clone());
    }
    let looked: Vec<String> = places.iter().map(|place| place.display().to_string()).collect();
    Err(Diagnostic::new(scenario, format!("the trajectory {} is not there", spec.file))
        .path("motion.file.file")
        .found(format!("no such file: {}", looked.join(", ")))
        .help("give its folder with `--data DIR` or the environment variable SCHULER_DATA")
        .into())
}

/// Rows of comma-separated numbers under a header; empty lines and lines that begin with `#` are skipped.
fn read(spec: &TrajectoryFile, file: &Path) -> Result<Recorded, Error> {
    let text = text(file).map_err(|source| Error::Read { path: file.into(), source })?;
    let lines = text.lines().enumerate().map(|(k, line)| (k as u64 + 1, line.trim_start_matches('\u{feff}')));
    let mut lines = lines.filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    let Some((number, header)) = lines.next() else {
        return Err(Diagnostic::new(file, "the trajectory is empty").into());
    };
    let titles: Vec<&str> = header.split(',').map(|title| title.trim().trim_matches('"')).collect();
    let mut places = [0; 7];
    for (place, column) in places.iter_mut().zip(&spec.columns) {
        *place = titles.iter().position(|title| title == column).ok_or_else(|| {
            Diagnostic::new(file, "the trajectory has no such column")
                .at(number, 0)
                .path(column.clone())
                .found(titles.join(", "))
        })?;
    }
    let mut rows = Vec::new();
    let mut numbers = Vec::new();
    for (line, text) in lines {
        let fields: Vec<&str> = text.split(',').collect();
        let mut values = [0.0; 7];
        for ((value, place), column) in values.iter_mut().zip(places).zip(&spec.columns) {
            let field = fields.get(place).copied().unwrap_or_default().trim();
            *value = field.parse().ok().filter(|x: &f64| x.is_finite()).ok_or_else(|| {
                Diagnostic::new(file, "no number")
                    .at(line, 0)
                    .path(column.clone())
                    .found(format!("`{field}`"))
            })?;
        }
        let [t, lat, lon, h, roll, pitch, yaw] = values;
        let k = spec.angle;
        rows.push(Row {
            t,
            position: Geodetic::new(k * lat, k * lon, h),
            attitude: Euler::new(k * roll, k * pitch, k * yaw),
        });
        numbers.push(line);
    }
    Recorded::new(&rows, spec.knots).map_err(|fault| {
        let line = fault.part.and_then(|k| numbers.get(k)).copied().unwrap_or(number);
        Diagnostic::new(file, fault.problem).at(line, 0).expected(fault.expected).into()
    })
}

/// The text of a file, unpacked where it is gzip.
fn text(file: &Path) -> std::io::Result<String> {
    let mut bytes = Vec::new();
    File::open(file)?.read_to_end(&mut bytes)?;
    let mut text = String::new();
    match bytes[..] {
        [0x1f, 0x8b, ..] => MultiGzDecoder::new(&bytes[..]).read_to_string(&mut text)?,
        _ => (&bytes[..]).read_to_string(&mut text)?,
    };
    Ok(text)
}
