//! The rows of a document of tongues.

use crate::question::Tongues;
use crate::verify::written::{Column, Decimal, Ends, Written};
use clocks::tongue::{Entry, Resonance, Side};
use number::Rational;

rows! {
    /// `kickdrift/tongues/1`.
    pub struct Claim {
        pub input: Tongues,
        pub tongues: Vec<Tongue>,
    }

    /// A row.
    pub struct Tongue [p, q, m] {
        pub p: u64,
        pub q: u64,
        pub m: u64,
        pub a: i64 | null,
        pub b: i64 | null,
        pub lower: Edge,
        pub upper: Edge | null,
        pub closed: bool,
        pub width: Ends | null,
        #[serde(default)]
        pub growth: Column<Growth>,
        #[serde(default)]
        pub predicted: Column<Predicted>,
        #[serde(default)]
        pub first_order: Column<FirstOrder>,
    }
}

rows! {
    /// An edge as it is written.
    pub struct Edge {
        pub lo: f64,
        pub hi: f64,
        pub decimal: Option<Decimal>,
        pub entry: Written<Entry>,
        #[serde(default)]
        pub exact: Column<Written<Rational>>,
        #[serde(default)]
        pub on: Column<Written<Resonance>>,
        pub h1: Option<Quantity>,
        pub h2: Option<Quantity>,
    }

    pub struct Quantity {
        pub lo: f64,
        pub hi: f64,
        pub decimal: Option<Decimal>,
    }

    /// The fastest growth inside.
    #[derive(Copy)]
    pub struct Growth {
        pub s: f64,
        pub ln_multiplier: f64,
        pub rate: f64,
        pub steps_until_tenfold: f64,
        pub growth_rate: Option<f64>,
    }

    /// The point p θ = m π against the tongue.
    pub struct Predicted {
        pub s: f64,
        pub side: String,
        pub position: Written<Side>,
        pub distance: f64,
    }

    /// The law of first order, and the tongue minus the law.
    #[derive(Copy)]
    pub struct FirstOrder {
        pub centre: f64,
        pub width: f64,
        pub ln_multiplier: f64,
        pub centre_error: Ends,
        pub width_error: Ends,
        pub width_ratio: Ends,
    }
}
