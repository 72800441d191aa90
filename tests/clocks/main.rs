//! Two clocks on one oscillator: schedules, propagators, verdicts, resonances, tongues, bands, maps.

mod avi;
mod bands;
mod map;
mod methods;
mod own_orbit;
mod propagator;
mod rates;
mod resonance;
mod schedule;
mod stress;
mod thin_tongues;
mod tongue;
mod verdict;
