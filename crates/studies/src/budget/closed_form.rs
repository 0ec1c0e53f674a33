//! The closed form of a source that is constant or a ramp, at rest with the height held.

use schuler_frames::{T, Vec3};
use schuler_imu::Instrument;
use schuler_strapdown::Vertical;
use schuler_strapdown::static_base::{Drivers, Site, exact};

use super::alignment;
use super::scene::Scene;
use super::source::{Kind, Source};

/// Errors of one standard deviation at each row; `None` where there is no closed form.
pub fn response(scene: &Scene, source: &Source) -> Option<Vec<[f64; 9]>> {
    if scene.study.filter.is_some() || !scene.steady || scene.vertical != Vertical::Held {
        return None;
    }
    let (pva, _) = scene.moment(0.0);
    let site = Site::new(pva.position, scene.study.mechanization.gravity);
    let drivers = match &source.kind {
        Kind::Initial(initial) => {
            // The closed forms leave out the height and its rate.
            if initial.position[2] != 0.0 || initial.velocity[2] != 0.0 {
                return None;
            }
            Drivers {
                phi0: Vec3::claim(initial.phi),
                dv0: Vec3::claim(initial.velocity),
                dlat0: initial.position[0] / site.r_m,
                dlon0: initial.position[1] / (site.r_n * site.cos_lat),
                ..Drivers::default()
            }
        }
        Kind::Noise(_) => return None,
        Kind::Sensor(_) => {
            let size = source.size()?;
            let (instrument, column) = scene.regressor(source, &scene.seen(0, 1), scene.dt)?;
            let mut phi0 = [0.0; 3];
            let mut value = size.value;
            if scene.study.alignment > 0 {
                // The ramp began with the alignment.
                let window = alignment::window(scene);
                let mean = value + 0.5 * size.rate * window;
                value += size.rate * window;
                phi0 = alignment::Law::new(scene).phi(instrument, column.map(|c| c * mean));
            }
            let column: Vec3<T> = pva.c_tb * Vec3::claim(column);
            let (value, rate) = (column.scaled(value), column.scaled(size.rate));
            let phi0 = Vec3::claim(phi0);
            match instrument {
                Instrument::Gyro => Drivers { eps: value, eps_rate: rate, phi0, ..Drivers::default() },
                Instrument::Accel => Drivers { nabla: value, nabla_rate: rate, phi0, ..Drivers::default() },
            }
        }
    };
    let response = exact(&site, &drivers);
    let at = |&sample: &u64| {
        let e = response.at(scene.time(sample));
        let all = [e.dr.as_array(), e.dv.as_array(), e.phi.as_array()];
        std::array::from_fn(|k| all[k / 3][k % 3])
    };
    Some(scene.rows.iter().map(at).collect())
}
