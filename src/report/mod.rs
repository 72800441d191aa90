//! Floor 5: results on their way out, as tables and as figures.
//!
//! Nothing here knows any physics. A [`table::Table`] holds typed cells and each format is one file
//! ([`csv`], [`latex`], [`text`], and JSON through `serde`); a [`figure::Figure`] holds panels of layers and
//! is drawn as SVG, from which the PNG is rasterized; [`file`](mod@file) puts the bytes where they belong, whole or
//! not at all.

pub mod csv;
pub mod decimal;
pub mod figure;
pub mod file;
pub mod latex;
pub mod table;
pub mod text;
