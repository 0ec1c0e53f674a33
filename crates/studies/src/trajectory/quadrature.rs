//! Quadrature by Gauss and Legendre, with as many nodes as rounding asks for.

/// Nodes and weights on 0..1, exact for polynomials of degree 5.
const THREE: [(f64, f64); 3] = [
    (0.112_701_665_379_258_31, 0.277_777_777_777_777_78),
    (0.5, 0.444_444_444_444_444_44),
    (0.887_298_334_620_741_69, 0.277_777_777_777_777_78),
];

/// Nodes and weights on 0..1, exact for polynomials of degree 7.
const FOUR: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_13, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_29, 0.173_927_422_568_726_93),
];

/// Nodes and weights on 0..1, exact for polynomials of degree 9.
const FIVE: [(f64, f64); 5] = [
    (0.046_910_077_030_668_004, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_55, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// `n` nodes err by (n!)⁴ / ((2n + 1) (2n)!³) x^2n of a sine's amplitude over an interval of x = omega dt: three nodes by
/// 5e-7 x⁶, four by 6e-10 x⁸, five by 4e-13 x¹⁰. Up to these x that is below 1e-16.
const X_THREE: f64 = 0.024;
const X_FOUR: f64 = 0.14;
const X_FIVE: f64 = 0.43;

/// Calls `add(time, weight)` for each node of the interval from `t` to `t + dt` (s), whose integrand has angular
/// frequencies up to `fastest` (time to rad/s) and jumps at `joints` (increasing). The weights sum up to `dt`.
pub fn nodes(t: f64, dt: f64, fastest: impl Fn(f64) -> f64, joints: &[f64], mut add: impl FnMut(f64, f64)) {
    // What is closer to an end than this is the end, met with rounding.
    let margin = 1e-9 * dt;
    let first = joints.partition_point(|joint| *joint <= t + margin);
    let mut begin = 0.0;
    for joint in joints[first..].iter().map(|joint| joint - t).take_while(|joint| *joint < dt - margin) {
        smooth(t, begin, joint - begin, &fastest, &mut add);
        begin = joint;
    }
    smooth(t, begin, dt - begin, &fastest, &mut add);
}

/// From `t + begin` on, `dt` long, without a joint.
fn smooth(t: f64, begin: f64, dt: f64, fastest: &impl Fn(f64) -> f64, add: &mut impl FnMut(f64, f64)) {
    let x = fastest(t + (begin + 0.5 * dt)) * dt;
    if x < X_FOUR {
        let nodes: &[(f64, f64)] = if x < X_THREE { &THREE } else { &FOUR };
        for (node, weight) in nodes {
            add(t + (begin + node * dt), weight * dt);
        }
        return;
    }
    let parts = (x / X_FIVE).ceil().max(1.0);
    let part = dt / parts;
    for k in 0..parts as u64 {
        for (node, weight) in FIVE {
            add(t + (begin + (k as f64 + node) * part), weight * part);
        }
    }
}
