//! Sources made from the registries, for laws that hold for all of them.

use schuler_imu::process::Form;
use schuler_imu::{Instrument, PROCESSES, Process, ProcessKind, Source, Value, term};

/// The process with the example numbers of its form.
pub fn process(kind: &'static dyn ProcessKind, form: Form) -> Process {
    let given: Vec<(&str, Value<'_>)> = form.iter().map(|p| (p.name, p.example.into())).collect();
    Process::new(kind, &given).unwrap()
}

/// Every process in each of its forms.
pub fn processes() -> impl Iterator<Item = (String, Process)> {
    PROCESSES.iter().flat_map(|kind| {
        kind.forms().iter().map(|form| {
            let names: Vec<_> = form.iter().map(|p| p.name).collect();
            (format!("{} {{{}}}", kind.name(), names.join(", ")), process(*kind, form))
        })
    })
}

/// The process on the bias of the gyroscopes: the coefficients are the outputs.
pub fn on_bias(process: Process) -> Source {
    Source::new(Instrument::Gyro, term("bias").unwrap(), process).unwrap()
}
