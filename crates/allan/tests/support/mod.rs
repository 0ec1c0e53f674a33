//! What several tests share.
pub mod series;
pub mod simulate;
