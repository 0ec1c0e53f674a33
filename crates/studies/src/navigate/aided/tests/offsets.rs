//! Times of logs that do not fall on samples, clocks that differ, other formats, and starts that are badly wrong.

use super::*;

/// The flight without any error of instruments, at `rate`, a position `phase` after a whole second.
fn exact(name: &str, rate: &str, phase: &str) -> Record {
    let position = format!(
        "aiding={{ position: {{ rate: 1 Hz, sigma: 0 m, lever_arm: [1 m, 0.5 m, -1.5 m], phase: {phase} }} }}"
    );
    let overrides = [&format!("imu={{ rate: {rate} }}"), position.as_str()];
    let data = Data::simulated(name, FLIGHT, &overrides);
    let log = format!("log.rate={rate}");
    // So confident a filter that it takes nothing out: the innovations are what interpolation gets wrong.
    let sigma = "filter.measurements.position.sigma=1 km";
    data.navigate(&[&log, sigma]).unwrap()
}

/// Fixes half way through the 20 ms of a sample, at up to 80 m/s with turns. What the navigator itself has gathered in errors since the
/// start (a centimetre at this rate) shows in a fix at the end of a sample too; what remains is what the split costs: a change of
/// the force within a sample makes j dt³/16, a micrometre. The nearest sample would be wrong by 0.8 m.
#[test]
fn a_fix_within_a_sample_is_met_where_it_was_taken() {
    let (split, whole) = (exact("split", "50 Hz", "10 ms"), exact("whole", "50 Hz", "0 s"));
    let [split, whole] = [&split, &whole].map(|record| numbers(record, "innovations", "innovation"));
    assert!(split.len() == 477 && whole.len() == 480, "{} {}", split.len(), whole.len());
    for (k, (split, whole)) in split.iter().zip(whole).enumerate() {
        assert!((split - whole).abs() < 1e-4 && whole.abs() < 0.02, "{k}: {split} {whole}");
    }
}

/// A third of a sample, in the time of another clock.
#[test]
fn clocks_that_differ() {
    let aiding = "aiding.position={ rate: 1 Hz, sigma: 1 m, lever_arm: [1 m, 0.5 m, -1.5 m], phase: 3.3 ms, offset: 250 ms }";
    let data = Data::simulated("clocks", FLIGHT, &["seed=2", aiding]);
    let told = data.navigate_from_a_drawn_start(2, &["filter.measurements.position.offset=250 ms"]);
    assert_within(update(&told, "position", "nis_ratio"), band(477, 1e-4), "NIS");
    for (t, error, sigma) in errors(&told) {
        assert!((0..9).all(|k| error[k].abs() < 5.0 * sigma[k]), "{t}: {error:?} {sigma:?}");
    }
    assert!(told.notes.iter().all(|note| !note.contains("NOT CONSISTENT")), "{:?}", told.notes);
    // Not told, 80 m/s times 0.25 s is 20 m.
    let silent = data.navigate_from_a_drawn_start(2, &[]);
    let words = ["the mean NIS of position is", "the mean NEES of a degree of freedom is"];
    for words in words {
        assert!(
            silent.notes.iter().any(|note| note.starts_with("NOT CONSISTENT") && note.contains(words)),
            "{words}: {:?}",
            silent.notes
        );
    }
}

/// A start that is badly wrong is told, with and without a gate.
#[test]
fn a_start_that_is_badly_wrong_is_told() {
    let data = Data::flight("wrong", 4);
    let about = "start.attitude={ roll: 0 deg, pitch: 0 deg, yaw: 150 deg }";
    for (overrides, words) in [
        (&[about][..], "the mean NIS of position is"),
        (
            &[about, "filter.gate=0.01 %"],
            "scalar measurements of position are refused: the navigator is lost",
        ),
        (&["start.position={ lat: 48.2 deg, lon: 11 deg, h: 800 m }"], "the mean NIS of position is"),
    ] {
        let record = data.navigate(overrides).unwrap();
        let told =
            |words: &str| record.notes.iter().any(|n| n.starts_with("NOT CONSISTENT") && n.contains(words));
        assert!(told(words), "{overrides:?}: {:?}", record.notes);
        assert!(told("the mean NEES of a degree of freedom is"), "{overrides:?}: {:?}", record.notes);
    }
    let right = data.navigate_from_a_drawn_start(4, &[]);
    assert!(right.notes.iter().all(|note| !note.contains("NOT CONSISTENT")), "{:?}", right.notes);
}

/// The same logs in the text formats of KF-GINS give the same navigation: degrees and radians differ by rounding alone.
#[test]
fn text_of_kf_gins_goes_round() {
    let data = Data::simulated(
        "kf_gins",
        FLIGHT,
        &["seed=6", "output={ every: 1 s, formats: [csv], imu: rates, logs: [kf_gins] }"],
    );
    let text = NAVIGATE
        .replace("  file: imu.csv\n", "  file: imu.txt\n  format: kf_gins\n")
        .replace("position: { file: position.csv,", "position: { file: gnss.txt, format: kf_gins,")
        .replace("reference: { file: truth.csv }", "reference: { file: truth.nav, format: kf_gins }");
    let begin = text.find("  content: increments").unwrap();
    let end = text.find("mechanization:").unwrap();
    let text = format!("{}{}", &text[..begin], &text[end..]);
    let there = data.navigate_as(&text, &[]).unwrap();
    let rates = NAVIGATE
        .replace("content: increments", "content: rates")
        .replace(
            "[dtheta_x_rad, dtheta_y_rad, dtheta_z_rad]",
            "[omega_x_radps, omega_y_radps, omega_z_radps]",
        )
        .replace("[dv_x_mps, dv_y_mps, dv_z_mps]", "[f_x_mps2, f_y_mps2, f_z_mps2]")
        .replace("gyro: 1 rad, accel: 1 m/s", "gyro: 1 rad/s, accel: 1 m/s^2");
    let here = data.navigate_as(&rates, &[]).unwrap();
    assert_eq!(errors(&there).len(), 161);
    for ((t, a, sigma), (_, b, _)) in errors(&there).into_iter().zip(errors(&here)) {
        assert!((0..9).all(|k| (a[k] - b[k]).abs() < 1e-6 * sigma[k]), "{t}: {a:?} {b:?}");
    }
}
