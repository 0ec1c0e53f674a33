//! Mixed-up frames must not compile.

use core::ops::{Add, Mul, Sub};

use schuler_frames::{B, Dcm, E, I, Rate, Rot, T, Vec3};

/// Whole programs with the message that their author sees. Only mistakes whose message is short stand
/// there: a missing operator lists every implementation, which no test should freeze; see below.
#[test]
fn wrong_frames_do_not_compile() {
    trybuild::TestCases::new().compile_fail("tests/wrong/*.rs");
}

/// Compiles only if `$left` does not implement `$operator<$right>`: if it did, two implementations of
/// `Either` would fit and `_` could not be inferred.
macro_rules! undefined {
    ($left:ty, $operator:ident, $right:ty) => {
        const _: fn() = || {
            trait Either<Which> {
                fn chosen() {}
            }
            impl<X> Either<()> for X {}
            struct Defined;
            impl<X: $operator<$right>> Either<Defined> for X {}
            let _ = <$left as Either<_>>::chosen;
        };
    };
}

// A rotation takes vectors and rates of its right-hand frame, and joins rotations at a common frame.
undefined!(Rot<T, B>, Mul, Vec3<T>);
undefined!(Rot<T, B>, Mul, Vec3<E>);
undefined!(Rot<T, B>, Mul, Rate<T, I, T>);
undefined!(Rot<T, B>, Mul, Rot<T, B>);
undefined!(Rot<I, E>, Mul, Rot<T, B>);
undefined!(Dcm<T, B>, Mul, Vec3<T>);
undefined!(Dcm<T, B>, Mul, Rate<T, I, T>);
undefined!(Dcm<I, E>, Mul, Dcm<T, B>);
// Vectors add within a frame.
undefined!(Vec3<T>, Add, Vec3<B>);
undefined!(Vec3<T>, Sub, Vec3<E>);
// Rates add along a chain, resolved in one frame; a rate is no plain vector.
undefined!(Rate<B, T, B>, Add, Rate<T, I, T>);
undefined!(Rate<B, T, T>, Add, Rate<E, I, T>);
undefined!(Rate<T, I, T>, Add, Rate<T, I, T>);
undefined!(Rate<B, I, B>, Sub, Rate<B, T, B>);
undefined!(Rate<B, I, B>, Sub, Rate<T, E, B>);
undefined!(Rate<T, I, T>, Add, Vec3<T>);

// The same products in right order are there.
const _: fn() = || {
    fn defined<X: Mul<Y>, Y>() {}
    defined::<Rot<T, B>, Vec3<B>>();
    defined::<Rot<I, E>, Rot<E, T>>();
};
