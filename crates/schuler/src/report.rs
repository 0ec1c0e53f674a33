//! Errors as people read them: the line they are in, and what would work.

use std::io::{self, IsTerminal, Write};

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use schuler_studies::{Diagnostic, Error};

/// Tells the user on standard error.
pub fn report(error: &Error) -> io::Result<()> {
    let colours = io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let text = match error {
        Error::Input(diagnostic) => render(diagnostic, colours),
        other => format!("error: {other}"),
    };
    writeln!(io::stderr(), "{text}")
}

/// Headline, excerpt, and a line for each fact.
fn render(diagnostic: &Diagnostic, colours: bool) -> String {
    let Some(excerpt) = &diagnostic.excerpt else { return format!("error: {diagnostic}") };
    let file = diagnostic.file.display().to_string();
    let headline = diagnostic.headline();
    let span = excerpt.span.start.min(excerpt.text.len())..excerpt.span.end.min(excerpt.text.len());
    let snippet = Snippet::source(&*excerpt.text)
        .path(&file)
        .line_start(excerpt.first_line as usize)
        .annotation(AnnotationKind::Primary.span(span));
    let group: Group = Level::ERROR.primary_title(&headline).element(snippet);
    let facts: Vec<String> = diagnostic.facts().map(|(name, text)| format!("{name}: {text}")).collect();
    let group = facts.iter().fold(group, |group, fact| group.element(Level::NOTE.no_name().message(fact)));
    let renderer = if colours { Renderer::styled() } else { Renderer::plain() };
    renderer.render(&[group])
}
