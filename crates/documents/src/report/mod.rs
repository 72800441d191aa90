//! Results on their way out: rows and documents, and what is drawn of them.
//!
//! A [`document::Document`] holds a result and renders every form. Beneath it, and hidden from these pages: a
//! table of typed cells, a file for each form (CSV, LaTeX, text, NumPy's arrays), the files themselves, which
//! appear whole or not at all, and the charts, which the crate `plot` draws.

pub mod advise;
pub mod aperture;
pub mod bands;
#[doc(hidden)]
pub mod certificate;
#[doc(hidden)]
pub mod csv;
#[doc(hidden)]
pub mod decimal;
pub mod document;
#[doc(hidden)]
pub mod figure;
#[doc(hidden)]
pub mod file;
pub mod friction;
#[doc(hidden)]
pub mod latex;
pub mod map;
#[doc(hidden)]
pub mod npz;
#[doc(hidden)]
pub mod plane;
#[doc(hidden)]
pub mod record;
pub mod shape;
pub mod simulate;
#[doc(hidden)]
pub mod stream;
#[doc(hidden)]
pub mod strength;
pub mod system;
#[doc(hidden)]
pub mod table;
#[doc(hidden)]
pub mod text;
pub mod tongues;
