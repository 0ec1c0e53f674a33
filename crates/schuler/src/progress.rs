//! A progress bar, where somebody looks.

use std::io::IsTerminal;
use std::sync::Mutex;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use schuler_studies::Progress;

/// A bar on standard error, hidden where that is no terminal.
pub struct Bar {
    bar: Mutex<ProgressBar>,
    visible: bool,
}

impl Bar {
    /// A bar that nothing has begun on; `quiet` hides it.
    pub fn new(quiet: bool) -> Self {
        Bar { bar: Mutex::new(ProgressBar::hidden()), visible: !quiet && std::io::stderr().is_terminal() }
    }

    /// Takes the bar off the screen.
    pub fn finish(&self) {
        if let Ok(bar) = self.bar.lock() {
            bar.finish_and_clear();
        }
    }
}

impl Progress for Bar {
    fn begin(&self, what: &str, units: u64) {
        let Ok(mut bar) = self.bar.lock() else { return };
        bar.finish_and_clear();
        if self.visible {
            *bar = ProgressBar::with_draw_target(Some(units), ProgressDrawTarget::stderr());
            if let Ok(style) = ProgressStyle::with_template("{msg} {bar:40} {percent:>3} %  {eta} left") {
                bar.set_style(style);
            }
            bar.set_message(what.to_string());
        }
    }

    fn advance(&self, units: u64) {
        if let Ok(bar) = self.bar.lock() {
            bar.inc(units);
        }
    }
}
