//! Grades: one device or class of figures stands for each.

use super::devices::figure;
use super::units::{
    ARCSEC, DEG_H, DEG_S, DEG_S_G, DEG_S_SQRT_HZ, DEG_SQRT_H, MG, MPS_SQRT_H, PPM, UG, UG_SQRT_HZ,
};
use super::{Kind, Preset, Role};
use crate::Instrument::{Accel, Gyro};

/// Grades: one device or class of figures stands for each.
pub const GRADES: &[Preset] = &[
    Preset {
        name: "consumer",
        device: "Consumer grade",
        source: "Bosch BMI270 (Luxonis documentation) with the offsets of BMI160 (csdn article 103731233)",
        kind: Kind::Grade,
        figures: &[
            figure(Gyro, Role::Bias, "±3 deg/s", 3.0, DEG_S),
            figure(Gyro, Role::White, "0.007 deg/s/sqrt(Hz)", 0.007, DEG_S_SQRT_HZ),
            figure(Gyro, Role::Instability, "6 deg/h", 6.0, DEG_H),
            figure(Accel, Role::Bias, "±60 mg", 60.0, MG),
            figure(Accel, Role::White, "160 ug/sqrt(Hz)", 160.0, UG_SQRT_HZ),
        ],
        note: "One device stands for the class.",
    },
    Preset {
        name: "industrial",
        device: "Industrial grade",
        source: "Xsens MTi-300, Movella leaflet, May 2023",
        kind: Kind::Grade,
        figures: &[
            figure(Gyro, Role::Instability, "10 deg/h", 10.0, DEG_H),
            figure(Gyro, Role::White, "0.01 deg/s/sqrt(Hz)", 0.01, DEG_S_SQRT_HZ),
            figure(Gyro, Role::GSensitivity, "0.003 deg/s/g", 0.003, DEG_S_G),
            figure(Accel, Role::Instability, "15 ug", 15.0, UG),
            figure(Accel, Role::White, "60 ug/sqrt(Hz)", 60.0, UG_SQRT_HZ),
        ],
        note: "One device stands for the class; bias from run to run not in the leaflet.",
    },
    Preset {
        name: "tactical",
        device: "Tactical grade",
        source: "Honeywell HG1700 (N61-1619, quoted by NavToolkit)",
        kind: Kind::Grade,
        figures: &[
            figure(Gyro, Role::Bias, "1 deg/h", 1.0, DEG_H),
            figure(Gyro, Role::White, "0.125 deg/sqrt(h)", 0.125, DEG_SQRT_H),
            figure(Accel, Role::Bias, "1000 ug", 1000.0, UG),
            figure(Accel, Role::White, "0.0198 m/s/sqrt(h)", 0.0198, MPS_SQRT_H),
        ],
        note: "El-Sheimy and Youssef 2020, table 1, give 1 to 10 deg/h and 1 to 5 mg for the class.",
    },
    Preset {
        name: "navigation",
        device: "Navigation grade",
        source: "PSINS imuerrset, case 2",
        kind: Kind::Grade,
        figures: &[
            figure(Gyro, Role::Bias, "0.01 deg/h", 0.01, DEG_H),
            figure(Gyro, Role::White, "0.001 deg/sqrt(h)", 0.001, DEG_SQRT_H),
            figure(Gyro, Role::ScaleFactor, "10 ppm", 10.0, PPM),
            figure(Gyro, Role::Misalignment, "10 arcsec", 10.0, ARCSEC),
            figure(Accel, Role::Bias, "100 ug", 100.0, UG),
            figure(Accel, Role::White, "10 ug/sqrt(Hz)", 10.0, UG_SQRT_HZ),
            figure(Accel, Role::ScaleFactor, "10 ppm", 10.0, PPM),
            figure(Accel, Role::Misalignment, "10 arcsec", 10.0, ARCSEC),
        ],
        note: "El-Sheimy and Youssef 2020, table 1, give below 0.01 deg/h and 100 ug for the class.",
    },
    Preset {
        name: "strategic",
        device: "Strategic grade",
        source: "El-Sheimy and Youssef 2020, doi 10.1186/s43020-019-0001-5, table 1",
        kind: Kind::Grade,
        figures: &[
            figure(Gyro, Role::Bias, "0.001 deg/h", 0.001, DEG_H),
            figure(Gyro, Role::White, "0.002 deg/sqrt(h)", 0.002, DEG_SQRT_H),
            figure(Accel, Role::Bias, "1 ug", 1.0, UG),
        ],
        note: "Upper ends of the ranges of the class: 0.0001 to 0.001 deg/h, below 0.002 deg/sqrt(h), 0.1 to 1 ug. No figure for velocity random walk was seen.",
    },
];
