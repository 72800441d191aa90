//! Questions and their documents: words, figures, reports, citations, texts that are no input.

mod citations;
mod figures;
mod fuzz;
mod map_cli;
mod report;
mod word;
