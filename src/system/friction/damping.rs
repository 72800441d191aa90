//! A period with friction: damped or growing.

/// Where the spectral radius of a period with friction lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Damping {
    /// Below 1: means and covariances are bounded.
    Damped,
    /// At 1, exactly: a free direction, whose covariance grows linearly.
    Marginal,
    /// Above 1: exponential growth in spite of the friction.
    Growing,
}

impl Damping {
    /// The name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Damping::Damped => "damped",
            Damping::Marginal => "marginal",
            Damping::Growing => "growing",
        }
    }
}
