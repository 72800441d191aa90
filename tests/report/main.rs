//! Reports: tables in each format, certificates, streams.

mod certificate;
mod csv;
mod decimal;
mod latex;
mod stream;
mod table;
mod text;
