//! The cases of the reference tables `tests/data/static_theory` (latitude 45 deg, level, heading 0).

use schuler_frames::{Geodetic, Gravity, Rot, T, Vec3};
use schuler_strapdown::static_base::{Drivers, Site};

pub const ARCSEC: f64 = std::f64::consts::PI / 648_000.0;
pub const DEG_PER_HOUR: f64 = std::f64::consts::PI / 648_000.0;
pub const UG: f64 = 9.80665e-6;

/// A reference table: its time column and the other columns row by row.
pub fn table(name: &str) -> Vec<(f64, Vec<f64>)> {
    let path = format!("{}/../../tests/data/static_theory/{name}.csv", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    let rows = text.lines().skip(1).map(|line| {
        let mut numbers = line.split(',').map(|x| x.parse::<f64>().unwrap());
        (numbers.next().unwrap(), numbers.collect())
    });
    rows.collect()
}

pub fn place() -> Geodetic {
    Geodetic::new(45f64.to_radians(), 0.0, 0.0)
}

pub fn site() -> Site {
    Site::new(place(), Gravity::Somigliana)
}

/// A case: errors along body axes, which are north, east, down here.
#[derive(Clone, Copy, Default)]
pub struct Case {
    pub initial: Drivers,
    pub b_g: [f64; 3],
    pub b_a: [f64; 3],
    pub k_g: [[f64; 3]; 3],
    pub k_a: [[f64; 3]; 3],
    pub ramp_g: [f64; 3],
    pub ramp_a: [f64; 3],
}

impl Case {
    /// Mean measured minus true rate or force over an interval around `t`.
    pub fn error(b: [f64; 3], k: [[f64; 3]; 3], ramp: [f64; 3], u: [f64; 3], t: f64) -> [f64; 3] {
        std::array::from_fn(|i| b[i] + ramp[i] * t + (0..3).map(|j| k[i][j] * u[j]).sum::<f64>())
    }

    /// What the case is for the closed form.
    pub fn drivers(&self) -> Drivers {
        let site = site();
        let o = site.omega_ie;
        let omega = [o * site.cos_lat, 0.0, -o * site.sin_lat];
        let f = [0.0, 0.0, -site.g];
        Drivers {
            eps: Vec3::claim(Self::error(self.b_g, self.k_g, [0.0; 3], omega, 0.0)),
            nabla: Vec3::claim(Self::error(self.b_a, self.k_a, [0.0; 3], f, 0.0)),
            eps_rate: Vec3::claim(self.ramp_g),
            nabla_rate: Vec3::claim(self.ramp_a),
            ..self.initial
        }
    }
}

/// The named cases, sizes as the tables' README says.
pub fn case(name: &str) -> Case {
    let (g, a, tilt) = (0.01 * DEG_PER_HOUR, 100.0 * UG, 10.0 * ARCSEC);
    let (p, m) = (1e-4, 20.0 * ARCSEC);
    let z = Case::default();
    let phi = |n, e, d| Case {
        initial: Drivers { phi0: Vec3::<T>::new(n, e, d), ..Drivers::default() },
        ..Case::default()
    };
    let vel = |n, e| Case {
        initial: Drivers { dv0: Vec3::new(n, e, 0.0), ..Drivers::default() },
        ..Case::default()
    };
    match name {
        "gyro_N" => Case { b_g: [g, 0.0, 0.0], ..z },
        "gyro_E" => Case { b_g: [0.0, g, 0.0], ..z },
        "gyro_D" => Case { b_g: [0.0, 0.0, g], ..z },
        "acc_N" => Case { b_a: [a, 0.0, 0.0], ..z },
        "acc_E" => Case { b_a: [0.0, a, 0.0], ..z },
        "tilt_N" => phi(tilt, 0.0, 0.0),
        "tilt_E" => phi(0.0, tilt, 0.0),
        "heading" => phi(0.0, 0.0, 60.0 * ARCSEC),
        "vel_N" => vel(0.1, 0.0),
        "vel_E" => vel(0.0, 0.1),
        "lat0" => Case { initial: Drivers { dlat0: 1e-5, ..Drivers::default() }, ..z },
        "gyroramp_E" => Case { ramp_g: [0.0, 0.001 * DEG_PER_HOUR / 3600.0, 0.0], ..z },
        "accramp_N" => Case { ramp_a: [10.0 * UG / 3600.0, 0.0, 0.0], ..z },
        "gyroSF_100ppm" => Case { k_g: [[p, 0.0, 0.0], [0.0, p, 0.0], [0.0, 0.0, p]], ..z },
        "gyro_misal_yx_20as" => Case { k_g: [[0.0; 3], [m, 0.0, 0.0], [0.0; 3]], ..z },
        "acc_misal_xz_20as" => Case { k_a: [[0.0, 0.0, m], [0.0; 3], [0.0; 3]], ..z },
        "all_mix" => Case {
            b_g: [g, -g, g / 2.0],
            b_a: [a, -a / 2.0, 0.0],
            k_g: [[p, 0.0, 0.0], [m, p, 0.0], [0.0, m, -p]],
            k_a: [[p, 0.0, m], [0.0, p, 0.0], [0.0, 0.0, -p]],
            initial: Drivers {
                phi0: Vec3::new(tilt, -tilt / 2.0, 60.0 * ARCSEC),
                dv0: Vec3::new(0.1, -0.05, 0.0),
                dlat0: 1e-5,
                dlon0: -1e-5,
                ..Drivers::default()
            },
            ..z
        },
        "free_h0_10m" => z,
        "free_vD_0p1" => {
            Case { initial: Drivers { dv0: Vec3::new(0.0, 0.0, 0.1), ..Drivers::default() }, ..z }
        }
        "free_accD_100ug" => Case { b_a: [0.0, 0.0, a], ..z },
        "free_gyroE" => Case { b_g: [0.0, g, 0.0], ..z },
        _ => panic!("no case {name}"),
    }
}

/// `C_computed = exp(-[phi ×])` for a true attitude of no rotation.
pub fn attitude<A: schuler_frames::Frame>(phi: Vec3<T>) -> Rot<T, A> {
    let n = phi.norm();
    let k = if n == 0.0 { -0.5 } else { -(n / 2.0).sin() / n };
    Rot::claim([(n / 2.0).cos(), k * phi[0], k * phi[1], k * phi[2]])
}
