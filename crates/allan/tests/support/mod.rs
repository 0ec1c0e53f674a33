//! What several tests share.
pub mod cases;
pub mod series;
pub mod simulate;
