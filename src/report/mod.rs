//! Floor 5: results on their way out, as tables and as figures.
//!
//! The lower half knows no physics. A [`table::Table`] holds typed cells and each format is one file
//! ([`csv`], [`latex`], [`text`], and JSON through `serde`), [`npz`] holds arrays too large for memory; a [`plot::Figure`] holds
//! panels of layers; [`file`](mod@file) puts the bytes where they belong, whole or not at all. On it stand a
//! [`document::Document`] for every kind of result, one file or folder each, and the drawings of the (h1, h2) [`plane`].

#[cfg(feature = "advise")]
pub mod advise;
pub mod bands;
pub mod certificate;
pub mod closings;
pub mod compare;
pub mod csv;
pub mod curves;
pub mod decimal;
pub mod document;
#[cfg(feature = "figure")]
pub mod figure;
pub mod file;
#[cfg(feature = "system")]
mod friction;
pub mod latex;
pub mod map;
#[cfg(feature = "cli")]
pub mod npz;
#[cfg(feature = "figure")]
pub mod plane;
pub mod polynomial;
pub mod proposition;
pub mod record;
pub mod simulate;
pub mod stream;
#[cfg(feature = "figure")]
pub mod strength;
pub mod survey;
#[cfg(feature = "system")]
pub mod system;
pub mod table;
pub mod text;
pub mod tongues;
pub mod verdict;
