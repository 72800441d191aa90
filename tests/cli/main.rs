//! The program from outside: what a person or a script types, and what comes back.

#[cfg(target_os = "linux")]
mod action;
mod advice_first;
mod advise;
mod answers;
mod claims;
mod files;
mod golden;
mod help;
mod manners;
mod mcp;
mod names;
mod pictures;
mod refusals;
mod remedies;
mod scenes;
mod side;
mod support;
mod tamper;
#[cfg(target_os = "linux")]
mod terminal;
mod tongues;
mod verify;
