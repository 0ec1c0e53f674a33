//! The frames as zero-sized types.

use core::fmt::Debug;

/// A right-handed Cartesian frame. Implement it for your own sensor or platform axes.
pub trait Frame: Copy + Debug + Default + PartialEq + Send + Sync + 'static {
    /// The letter used in symbols, as in `omega_ib_b`.
    const NAME: &'static str;
}

macro_rules! frame {
    ($(#[$doc:meta])* $name:ident, $letter:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct $name;
        impl Frame for $name {
            const NAME: &'static str = $letter;
        }
    };
}

frame!(
    /// Earth-centred inertial. Its z axis is the Earth's spin axis; x is fixed by the epoch of the run.
    I, "i"
);
frame!(
    /// Earth-centred, Earth-fixed: x through latitude 0, longitude 0; z through the north pole.
    E, "e"
);
frame!(
    /// Navigation frame (the literature's n): local level, north-east-down.
    T, "t"
);
frame!(
    /// Body: forward-right-down.
    B, "b"
);
frame!(
    /// Local level east-north-up, for the edges only: nothing inside computes in it.
    Enu, "enu"
);
