//! What changes in an IMU from step to step.

use core::fmt::Write;

use crate::Spec;
use crate::bank::BankState;
use crate::random::Fnv;
use crate::readout::ChainState;

/// Everything in an IMU that changes from step to step: save it, restore it, and the samples repeat
/// bit for bit.
///
/// With the feature `serde` it can be written and read; the text carries the version of its format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Of the list of sources, so that a state is not taken for that of another sensor.
    pub(crate) fingerprint: u64,
    pub(crate) bank: BankState,
    pub(crate) readout: [ChainState; 2],
}

impl State {
    pub(crate) fn start(spec: &Spec, bank: BankState) -> State {
        let mut hash = Fnv::new();
        for component in spec.components() {
            write!(hash, "{component},").expect("invariant: hashing accepts every text");
        }
        State { fingerprint: hash.0, bank, readout: [ChainState::START; 2] }
    }

    /// Number of steps since the start.
    pub fn step(&self) -> u64 {
        self.bank.step
    }
}

#[cfg(feature = "serde")]
mod text {
    use core::fmt;

    use serde::de::{self, SeqAccess, Visitor};
    use serde::ser::SerializeSeq;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use super::{BankState, ChainState, State};
    use crate::bank::{MAX_FIRST, MAX_SECOND};

    /// Version of the written form; raised when a number is added or its meaning changes.
    const VERSION: u32 = 2;

    /// Room for every number of a state.
    const MAX_NUMBERS: usize = 2 + 2 * MAX_FIRST + 5 * MAX_SECOND + 2 * ChainState::NUMBERS;

    #[derive(Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Written {
        version: u32,
        fingerprint: u64,
        step: u64,
        numbers: Numbers,
    }

    /// All numbers of a state in a fixed order, without the zeros at the end.
    struct Numbers([f64; MAX_NUMBERS]);

    impl State {
        /// Hands every number to `each` in a fixed order, to be read or replaced.
        fn visit(&mut self, mut each: impl FnMut(&mut f64)) {
            let bank = &mut self.bank;
            let mut alike = f64::from(bank.alike);
            each(&mut alike);
            bank.alike = alike as u32;
            each(&mut bank.dt);
            bank.first.iter_mut().for_each(&mut each);
            bank.first_covariance.iter_mut().for_each(&mut each);
            bank.second.as_flattened_mut().iter_mut().for_each(&mut each);
            bank.second_covariance.as_flattened_mut().iter_mut().for_each(&mut each);
            self.readout.iter_mut().for_each(|r| r.visit(&mut each));
        }
    }

    impl Serialize for State {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            let (mut numbers, mut i) = (Numbers([0.0; MAX_NUMBERS]), 0);
            let mut state = *self;
            state.visit(|x| {
                numbers.0[i] = *x;
                i += 1;
            });
            let (fingerprint, step) = (self.fingerprint, self.bank.step);
            Written { version: VERSION, fingerprint, step, numbers }.serialize(serializer)
        }
    }

    impl<'de> Deserialize<'de> for State {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            let w = Written::deserialize(deserializer)?;
            if w.version != VERSION {
                let (found, need) = (w.version, VERSION);
                return Err(de::Error::custom(format_args!(
                    "state of an IMU has version {found}, but {need} is needed"
                )));
            }
            let bank = BankState { step: w.step, ..BankState::START };
            let mut state = State { fingerprint: w.fingerprint, bank, readout: [ChainState::START; 2] };
            let mut numbers = w.numbers.0.iter();
            state.visit(|x| *x = numbers.next().copied().unwrap_or(0.0));
            Ok(state)
        }
    }

    impl Serialize for Numbers {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            // Compared by bits: a negative zero is kept.
            let used = self.0.iter().rposition(|x| x.to_bits() != 0).map_or(0, |last| last + 1);
            let mut seq = serializer.serialize_seq(Some(used))?;
            self.0[..used].iter().try_for_each(|x| seq.serialize_element(x))?;
            seq.end()
        }
    }

    impl<'de> Deserialize<'de> for Numbers {
        fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
            deserializer.deserialize_seq(NumbersVisitor)
        }
    }

    struct NumbersVisitor;

    impl<'de> Visitor<'de> for NumbersVisitor {
        type Value = Numbers;

        fn expecting(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(out, "at most {MAX_NUMBERS} numbers")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Numbers, A::Error> {
            let (mut numbers, mut i) = (Numbers([0.0; MAX_NUMBERS]), 0);
            while let Some(x) = seq.next_element()? {
                *numbers.0.get_mut(i).ok_or_else(|| de::Error::invalid_length(i + 1, &self))? = x;
                i += 1;
            }
            Ok(numbers)
        }
    }
}
