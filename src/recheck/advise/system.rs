//! Advice on a system's file, computed again as its input asks.

use serde_json::Value;

use crate::error::Result;
use crate::question::{Advised, Question, Safe, Work};
use crate::recheck::again::Left;
use crate::recheck::context::Context;
use crate::scene::Arrays;

/// The leaves that nothing follows from.
pub const LEFT: &[Left] =
    &[("input.file", "a name"), ("engine", "the text that it was read from is not part of the document")];

/// The document and what it holds, the arrays read from the folder of the recheck.
pub fn again(input: &Advised, context: &Context) -> Result<(Value, Safe)> {
    let arrays = Arrays::from(&context.options.folder);
    let safe = input.answer(&Work { arrays: Some(&arrays), ..context.work() })?;
    Ok((input.document(&safe).value(), safe))
}
