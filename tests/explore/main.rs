//! The page: its answers are those of the program and the library, and its server is answered to by no one
//! else.

mod answers;
mod serve;
mod support;
