//! The closed form of a source that is constant or a ramp, at rest with the height held.

use schuler_frames::{T, Vec3};
use schuler_imu::{Input, Instrument};
use schuler_strapdown::Vertical;
use schuler_strapdown::static_base::{Drivers, Site, exact};

use super::scene::Scene;
use super::source::{Kind, Source};

/// Errors of one standard deviation at each row; `None` where there is no closed form.
pub fn response(scene: &Scene, source: &Source) -> Option<Vec<[f64; 9]>> {
    if !scene.steady || scene.vertical != Vertical::Held {
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
        Kind::Sensor(component) => {
            let size = source.size()?;
            let calibration = scene.study.imu.spec.calibration_temperature;
            let input = Input::new(component.instrument(), &scene.seen(0, 1), scene.dt, calibration);
            let column = component.term().regressor(&input).columns()[component.coefficient()];
            let column: Vec3<T> = pva.c_tb * Vec3::claim(column);
            let (value, rate) = (column.scaled(size.value), column.scaled(size.rate));
            match component.instrument() {
                Instrument::Gyro => Drivers { eps: value, eps_rate: rate, ..Drivers::default() },
                Instrument::Accel => Drivers { nabla: value, nabla_rate: rate, ..Drivers::default() },
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
