//! Numbers: the rings, their exact signs, parsing.

mod cyclotomic;
mod interval;
mod laurent;
mod parse;
mod polynomial;
mod prime_field;
mod quantity;
mod ratio;
mod rational;
