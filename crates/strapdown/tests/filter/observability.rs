//! Rank, null space and limit covariance of static alignment against their closed forms.

use nalgebra::{SMatrix, SVector};
use schuler_imu::Spec;
use schuler_strapdown::filter::{
    Filter, Form, IntegratedVelocity, Measurement, Model, NavStates, Now, Observability, Observation,
    ZeroVelocity, limit_covariance, measurement,
};

use crate::common::*;

const LAT: f64 = 45.0 * DEG;
const SIGMAS: [f64; 9] = [100.0, 100.0, 100.0, 1.0, 1.0, 1.0, DEG, DEG, 5.0 * DEG];

fn still(sigma: f64, axes: [bool; 3]) -> Observation {
    ZeroVelocity { sigma, axes }.observe(&Now::at(&at_rest(LAT, 0.0)))
}

fn observed<const N: usize>(model: &Model<N>, yaws: &[f64], observation: &Observation) -> Observability<N> {
    let p0 = model.p0(&SIGMAS).unwrap();
    let sigma = std::array::from_fn(|k| p0[(k, k)].sqrt());
    let mut observability = Observability::new(model.len(), sigma);
    for &yaw in yaws {
        let pva = at_rest(LAT, yaw);
        let system = model.form().system(&HELD, &pva, felt(&pva).1);
        observability.add_observation(model, &system, &seen(&pva), observation, &Now::at(&pva));
    }
    observability
}

fn biases() -> Spec {
    sensors(0.003 * DEGPRTH, 10.0 * UG, 0.01 * DEGPH, 50.0 * UG)
}

/// The three combinations that alignment at rest never sees, in states [dv_N dv_E phi nab_N nab_E eps_N eps_E eps_D] (all
/// equilibria of the error equations): v1: phi_N = 1, nab_E = g, phi_D = -tan L; v2: phi_D = 1, eps_E = Ω cos L;
/// v3: phi_E = 1, nab_N = -g, eps_N = -Ω sin L, eps_D = -Ω cos L.
fn never_seen() -> SMatrix<f64, 10, 3> {
    let pva = at_rest(LAT, 0.0);
    let g = GRAVITY.gravity_t(pva.position)[2];
    let o = schuler_frames::wgs84::OMEGA;
    let (s, c) = LAT.sin_cos();
    let mut v = SMatrix::zeros();
    (v[(2, 0)], v[(6, 0)], v[(4, 0)]) = (1.0, g, -s / c);
    (v[(4, 1)], v[(8, 1)]) = (1.0, o * c);
    (v[(3, 2)], v[(5, 2)], v[(7, 2)], v[(9, 2)]) = (1.0, -g, -o * s, -o * c);
    v
}

/// Largest part of the columns of `null` outside of the space of `expected`, in units of `sigma`.
fn outside<const N: usize>(
    null: &SMatrix<f64, N, N>,
    nullity: usize,
    expected: &SMatrix<f64, N, 3>,
    sigma: &[f64; N],
) -> f64 {
    let scaled = |v: SVector<f64, N>| {
        SVector::<f64, N>::from_fn(|i, _| if sigma[i] > 0.0 { v[i] / sigma[i] } else { 0.0 })
    };
    let mut basis: Vec<SVector<f64, N>> = Vec::new();
    for k in 0..3 {
        let mut v = scaled(expected.column(k).into_owned()).normalize();
        for b in &basis {
            v -= b * b.dot(&v);
        }
        basis.push(v.normalize());
    }
    (0..nullity)
        .map(|k| {
            let mut v = scaled(null.column(k).into_owned()).normalize();
            for b in &basis {
                v -= b * b.dot(&v);
            }
            v.norm()
        })
        .fold(0.0, f64::max)
}

#[test]
fn rank_and_null_space_at_rest() {
    let model = ten_states(&biases());
    let p0 = model.p0(&SIGMAS).unwrap();
    let sigma = std::array::from_fn(|k| p0[(k, k)].sqrt());
    let one = observed(&model, &[0.0], &still(0.01, measurement::HORIZONTAL));
    assert_eq!((one.rank(), one.states()), (7, 10));
    let (null, nullity) = one.null_space();
    assert_eq!(nullity, 3);
    let off = outside(&null, nullity, &never_seen(), &sigma);
    assert!(off < 1e-9, "{off:e}");
    // Any turn about the vertical makes everything observable.
    for turn in [5.0, 90.0, 180.0] {
        let two = observed(&model, &[0.0, turn * DEG], &still(0.01, measurement::HORIZONTAL));
        assert_eq!(two.rank(), 10, "{turn} deg");
    }
}

#[test]
fn rank_with_vertical_channel_and_with_position() {
    // Velocity, attitude, both triads, free vertical channel: rank 9 of 12 by three velocities.
    let model = Model::<12>::new(Form::Phi, NavStates::NO_POSITION, &biases()).unwrap();
    let free = schuler_strapdown::ErrorDynamics { vertical: schuler_strapdown::Vertical::Free, ..HELD };
    let pva = at_rest(LAT, 0.0);
    let system = model.form().system(&free, &pva, felt(&pva).1);
    let p0 = model.p0(&SIGMAS).unwrap();
    let sigma: [f64; 12] = std::array::from_fn(|k| p0[(k, k)].sqrt());
    let mut observability = Observability::new(12, sigma);
    let now = Now::at(&pva);
    observability.add_observation(&model, &system, &seen(&pva), &still(0.01, measurement::ALL), &now);
    assert_eq!(observability.rank(), 9);

    // With position north and east: rank 7 of 12 by velocity, 9 by position.
    let spec = biases().keep(|c| !(c.instrument() == schuler_imu::Instrument::Accel && c.label() == "z"));
    let model = Model::<12>::new(Form::Phi, NavStates::HELD, &spec).unwrap();
    assert_eq!(observed(&model, &[0.0], &still(0.01, measurement::HORIZONTAL)).rank(), 7);
    let way = IntegratedVelocity {
        integral: schuler_frames::Vec3::ZERO,
        sigma: 0.01,
        axes: measurement::HORIZONTAL,
    };
    let by_position = observed(&model, &[0.0], &way.observe(&Now::at(&at_rest(LAT, 0.0))));
    assert_eq!(by_position.rank(), 9);
}

/// States of a model that are not zero in a combination, and their sizes.
fn combination<const N: usize>(model: &Model<N>, parts: &[(&str, f64)]) -> SVector<f64, N> {
    let mut v = SVector::zeros();
    for (name, size) in parts {
        v[model.index(name).unwrap_or_else(|| panic!("no state {name}"))] = *size;
    }
    v
}

/// v1, v2 and v3 of every model with biases of all axes, in its own order; with position also the one that turns with the
/// meridian and the longitude, which velocity never sees. All stand still and are not measured, and there are as many as the rank
/// says, so that they are all there are.
#[test]
fn null_vectors_of_twelve_states() {
    let pva = at_rest(LAT, 0.0);
    let g = GRAVITY.gravity_t(pva.position)[2];
    let o = schuler_frames::wgs84::OMEGA;
    let (s, c) = LAT.sin_cos();
    let [acc_x, acc_y] = ["accel.bias.constant.x", "accel.bias.constant.y"];
    let [gyro_x, gyro_y, gyro_z] = ["gyro.bias.constant.x", "gyro.bias.constant.y", "gyro.bias.constant.z"];
    let three = [
        vec![("phi_n", 1.0), (acc_y, g), ("phi_d", -s / c)],
        vec![("phi_d", 1.0), (gyro_y, o * c)],
        vec![("phi_e", 1.0), (acc_x, -g), (gyro_x, -o * s), (gyro_z, -o * c)],
    ];
    let r_m = schuler_frames::wgs84::r_m(s);
    let by_velocity = [vec![("dr_e", 1.0)], vec![("dr_n", r_m), ("phi_e", -1.0), (acc_x, g)]];
    let way = IntegratedVelocity {
        integral: schuler_frames::Vec3::ZERO,
        sigma: 0.01,
        axes: measurement::HORIZONTAL,
    };
    let way = way.observe(&Now::at(&pva));

    let check = |model: &Model<12>, observation: &Observation, vectors: &[Vec<(&str, f64)>]| {
        let step = at_rest_step(model, &pva, 1.0);
        let p0 = model.p0(&SIGMAS).unwrap();
        for parts in vectors {
            let v = combination(model, parts);
            let moved = step.phi() * v - v;
            let unit = (0..12).map(|k| v[k].abs() / p0[(k, k)].sqrt()).fold(0.0, f64::max);
            for k in 0..12 {
                let off = moved[k] / p0[(k, k)].sqrt() / unit;
                assert!(off.abs() < 1e-8, "{parts:?}: {} {off:e}", model.name(k));
            }
        }
        assert_eq!(observed(model, &[0.0], observation).rank(), 12 - vectors.len());
    };
    let still = still(0.01, measurement::HORIZONTAL);
    let with_position = Model::new(Form::Phi, NavStates::HELD, &ten(&biases())).unwrap();
    check(&with_position, &way, &three);
    check(&with_position, &still, &[&three[..], &by_velocity[..]].concat());
}

/// P tends to N (N' P0⁻¹ N)⁻¹ N'; the numbers are those of 40-digit arithmetic for these priors (1, 1, 5 deg; 50 µg;
/// 0.01 deg/h) at 45 deg.
#[test]
fn covariance_without_noise_tends_to_its_limit() {
    let model = ten_states(&sensors(0.0, 0.0, 0.01 * DEGPH, 50.0 * UG));
    let p0 = model.p0(&SIGMAS).unwrap();
    let (null, nullity) = observed(&model, &[0.0], &still(0.01, measurement::HORIZONTAL)).null_space();
    let limit = limit_covariance(&null, nullity, &p0, 10);
    let by_hand = {
        let n = never_seen();
        n * (n.transpose() * p0.try_inverse().unwrap() * n).try_inverse().unwrap() * n.transpose()
    };
    let published = [5.00020924e-5, 4.98612839e-5, 9.41508702e-4];
    for k in 0..3 {
        assert!((limit[(2 + k, 2 + k)].sqrt() / published[k] - 1.0).abs() < 3e-9);
    }
    for i in 0..10 {
        for j in 0..10 {
            let size = (p0[(i, i)] * p0[(j, j)]).sqrt();
            assert!((limit[(i, j)] - by_hand[(i, j)]).abs() < 1e-12 * size, "({i}, {j})");
        }
    }
    // The filter itself, with measurements that leave nothing to be learnt.
    let pva = at_rest(LAT, 0.0);
    let step = at_rest_step(&model, &pva, 60.0);
    let mut filter = Filter::new(model, &SIGMAS).unwrap();
    for _ in 0..600 {
        filter.propagate(&step);
        filter.update_with(&still(1e-5, measurement::HORIZONTAL), &Now::at(&pva)).unwrap();
    }
    for k in 2..10 {
        let off = (filter.p[(k, k)] / limit[(k, k)]).sqrt() - 1.0;
        assert!(off.abs() < 1e-6, "{}: {off:e}", filter.model().name(k));
    }
}
