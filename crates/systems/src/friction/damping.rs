//! A period with friction: damped or growing.

use number::named;

named! {
    /// Where the spectral radius of a period with friction lies.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Damping {
        /// Below 1: means and covariances are bounded.
        Damped = "damped",
        /// At 1, exactly: a free direction, whose covariance grows linearly.
        Marginal = "marginal",
        /// Above 1: exponential growth in spite of the friction.
        Growing = "growing",
    }
}
