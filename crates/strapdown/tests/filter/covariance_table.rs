//! Covariance of static alignment against `tests/data/static_theory/align_kf_cov.csv`, which independent code computed
//! (its README says how).

use schuler_strapdown::filter::{Filter, Now, ZeroVelocity, measurement};

use crate::common::*;

#[test]
fn every_row_of_the_reference_table_to_1e_9() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/static_theory/align_kf_cov.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let rows: Vec<Vec<f64>> =
        text.lines().skip(1).map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect();
    assert!(rows.len() == 30);
    let mut compared = 0;
    let mut start = 0;
    while start < rows.len() {
        let case = &rows[start][..5];
        let end = start + rows[start..].iter().take_while(|r| &r[..5] == case).count();
        let [lat, rot, arw, vrw, sigma] = [case[0] * DEG, case[1] * DEG, case[2], case[3], case[4]];
        let model = ten_states(&sensors(arw * DEGPRTH, vrw * UG, 0.01 * DEGPH, 50.0 * UG));
        let sigmas = [0.0, 0.0, 0.0, 1.0, 1.0, 0.0, DEG, DEG, 5.0 * DEG];
        let mut filter = Filter::new(model, &sigmas).unwrap();
        let steps = [0.0, rot].map(|yaw| {
            let pva = at_rest(lat, yaw);
            (pva, at_rest_step(filter.model(), &pva, 1.0))
        });
        let mut t = 0.0;
        for row in &rows[start..end] {
            while t < row[5] {
                let (pva, step) = &steps[usize::from(t >= 300.0)];
                t += 1.0;
                filter.propagate(step);
                let still = ZeroVelocity { sigma, axes: measurement::HORIZONTAL };
                filter.update(&still, &Now::at(pva)).unwrap();
            }
            for k in 0..10 {
                let off = (filter.sigma(k) / row[6 + k] - 1.0).abs();
                assert!(off < 1e-9, "{case:?} at {t} s, state {}: {off:e}", filter.model().name(k));
                compared += 1;
            }
        }
        start = end;
    }
    assert_eq!(compared, 300);
}
