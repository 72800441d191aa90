//! The paper's integrators as kicks and drifts: velocity Verlet, r-RESPA, AVI.

pub mod avi;
pub mod respa;
pub mod verlet;
