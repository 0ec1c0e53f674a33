//! Eight navigators in lanes against the same by themselves.

use fearless_simd::Level;
use schuler_frames::{B, Euler, Geodetic, Gravity, Rot, Vec3};
use schuler_imu::random::best_level;
use schuler_strapdown::{BaroLoop, Eight, Increments, LANES, LocalLevel, LocalLevelLanes, Pva, Vertical};

fn start(lane: usize) -> Pva {
    let x = lane as f64;
    Pva {
        position: Geodetic::new(0.1 * x - 0.3, 0.2 * x, 500.0 * x),
        v_t: Vec3::new(30.0 * x, 100.0 - 20.0 * x, 0.0),
        c_tb: Rot::from_euler(Euler::new(0.1 * x, 0.2 - 0.05 * x, 0.7 * x)),
    }
}

/// A motion that is different in each lane and each step.
fn increments(lane: usize, k: usize) -> Increments {
    let (x, t) = (lane as f64 + 1.0, k as f64 * 0.01);
    Increments {
        dtheta: Vec3::<B>::new(1e-4 * (x * t).sin(), 2e-4 * (0.7 * t + x).cos(), 1e-4 * x * (0.1 * t).sin()),
        dv: Vec3::new(0.02 * (0.3 * t * x).sin(), 0.01 * (0.2 * t).cos(), -0.098 + 1e-3 * (t + x).sin()),
    }
}

fn eight(k: usize) -> Increments<Eight> {
    let each: [Increments; LANES] = std::array::from_fn(|lane| increments(lane, k));
    let turned = |part: &dyn Fn(&Increments) -> [f64; 3]| {
        Vec3::<B, Eight>::claim(std::array::from_fn(|axis| each.each_ref().map(|i| part(i)[axis])))
    };
    Increments { dtheta: turned(&|i| i.dtheta.as_array()), dv: turned(&|i| i.dv.as_array()) }
}

/// Whatever the lanes of the machine, the length of the slices and the vertical channel: the same bits.
#[test]
fn lanes_are_navigators_by_themselves() {
    let baro = BaroLoop::third_order(100.0, 3e-6, 1000.0);
    let steps: Vec<Increments<Eight>> = (0..700).map(eight).collect();
    for vertical in [Vertical::Free, Vertical::Held, Vertical::Damped(baro)] {
        for gravity in [Gravity::Normal, Gravity::Somigliana] {
            let starts: [Pva; LANES] = std::array::from_fn(start);
            for level in [best_level(), Level::baseline()] {
                let mut lanes = LocalLevelLanes::at_level(level, &starts, gravity, vertical);
                let mut rest = &steps[..];
                for length in [1, 2, 49, 50, 51, 300, 7, 240] {
                    let (now, later) = rest.split_at(length);
                    lanes.steps(now, 0.01);
                    rest = later;
                }
                assert!(rest.is_empty());
                for lane in 0..LANES {
                    let mut alone = LocalLevel::new(&starts[lane], gravity, vertical);
                    (0..steps.len()).for_each(|k| alone.step(&increments(lane, k), 0.01));
                    assert_eq!(lanes.pva(lane), alone.pva(), "{vertical:?} {gravity:?} lane {lane}");
                }
            }
        }
    }
}
