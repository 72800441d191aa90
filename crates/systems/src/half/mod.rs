//! The half period, composed kick by kick.
//!
//! | file | what |
//! |---|---|
//! | `compose` | kicks and drifts that touch only the degrees of freedom of their potential, in any ring |
//! | `float` | in doubles, with a proven bound on what rounding did |
//! | `period` | whole periods in doubles, too, with friction or a stiffness of its own for each kick |
//! | `norm` | norms of matrices in doubles, from above |

pub(super) mod compose;
pub(super) mod float;
pub(super) mod norm;
pub(super) mod period;
