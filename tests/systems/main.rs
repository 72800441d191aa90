//! Many degrees of freedom, many clocks: every kind of model against routes that share nothing with it.

mod along;
mod elements;
mod friction;
mod intervals;
mod levels;
mod local_steps;
mod masking;
mod mesh;
mod nested_levels;
mod no_gradient;
mod rigid;
mod sparse_levels;
mod sparse_local_steps;
mod system;
mod system_scenes;
