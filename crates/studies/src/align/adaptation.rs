//! The strategy that a scenario chose.

use nalgebra::SMatrix;
use schuler_strapdown::filter::Outcome;
use schuler_strapdown::filter::strategy::{
    AdaptiveFading, BatchNoise, ExponentialFading, Moment, MultipleFading, ResidualNoise, SageHusa, Square3,
    Strategy, StrongTracking, VariableForgetting,
};

use crate::scenario::StrategyKind;

/// Innovations in a window.
const WINDOW: usize = 30;

/// Any of the strategies, behind one type.
pub struct Adaptation<const N: usize>(Box<dyn Strategy<N> + Send>);

impl<const N: usize> Adaptation<N> {
    pub fn new(kind: StrategyKind) -> Self {
        Adaptation(match kind {
            StrategyKind::Plain => Box::new(()),
            StrategyKind::Fading(lambda) => Box::new(ExponentialFading { lambda }),
            StrategyKind::SingleFactor(p) => Box::new(AdaptiveFading::<WINDOW>::new(p)),
            StrategyKind::MultipleFading(p) => Box::new(MultipleFading::<WINDOW>::new(p)),
            StrategyKind::StrongTracking(beta) => Box::new(StrongTracking::<N>::new(beta)),
            StrategyKind::Forgetting(memory) => Box::new(VariableForgetting::new(memory)),
            StrategyKind::ResidualNoise => Box::new(ResidualNoise::<WINDOW>::new()),
            StrategyKind::BatchNoise(length) => Box::new(BatchNoise::new(length)),
            StrategyKind::SageHusa(b) => Box::new(SageHusa::new(b)),
        })
    }
}

impl<const N: usize> Strategy<N> for Adaptation<N> {
    fn before(&mut self, p: &mut SMatrix<f64, N, N>, moment: &Moment<'_, N>) -> Square3 {
        self.0.before(p, moment)
    }

    fn after(&mut self, p: &mut SMatrix<f64, N, N>, outcome: &Outcome) {
        self.0.after(p, outcome);
    }
}
