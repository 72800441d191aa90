//! Safe steps: periods and bonds, hot bonds, inputs of engines.

mod advise;
mod aperture;
mod engine_inputs;
mod engines;
