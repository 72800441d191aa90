//! Reports: tables in each format, certificates, streams.

mod certificate;
mod csv;
mod decimal;
mod file;
mod latex;
mod stream;
mod table;
mod text;
