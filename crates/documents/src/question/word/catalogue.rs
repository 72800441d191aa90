//! The catalogue of published integrators, each linted.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use super::asked::Word;
use super::linted::Linted;
use crate::question::asking::{Question, Work, question};
use crate::question::field::StepRange;
use crate::report::document::Document;
use crate::report::record::Record;
use crate::report::shape::{FLAG, INTEGER, Keys, Schema, Shape, TEXT, WIDE_ENCLOSURE};
use crate::report::table::{Cell, Column};
use num_traits::Zero;
use number::parallel::try_map;
use number::{Ball, Laurent, Rational, Result, Sign};
use words::{Edge, METHODS, Method};

question! {
    /// The catalogue: published integrators, each with its order, cost and stable steps.
    struct Methods {}
}

impl Question for Methods {
    const NAME: &'static str = "methods";
    type Answer = &'static [Listed];

    fn schema() -> Option<Schema> {
        const METHODS: Shape =
            Shape::With(&Shape::List(&Shape::Object(|| record().keys())), r#"{"minItems": 1}"#);
        let body = Keys::new().key("methods", METHODS, "The integrators.");
        Some(Schema::new("The catalogue of integrators", body))
    }

    fn answer(&self, work: &Work) -> Result<Self::Answer> {
        // It is the same whenever it is asked for.
        static KNOWN: OnceLock<Vec<Listed>> = OnceLock::new();
        if let Some(known) = KNOWN.get() {
            return Ok(known);
        }
        let lint = |method: &'static Method| {
            let alone = Word { method: Some(method.name.into()), ..Word::default() };
            let linted = alone.answer(work)?;
            let two = || Word {
                lambda1: Some(16.into()),
                lambda2: Some(1.into()),
                h_range: Some(slow_range()),
                ..alone
            };
            // Long decimals make orders dear.
            let orders = |_: &words::Word| (linted.order.clone(), linted.general.clone());
            let two = if linted.word.names_forces() { Some(two().answer_with(work, orders)?) } else { None };
            Ok(Listed { method, linted, two })
        };
        let methods: Vec<&'static Method> = METHODS.iter().collect();
        let all = try_map(&methods, |&method| lint(method))?;
        Ok(KNOWN.get_or_init(|| all))
    }

    fn show(&self, all: &Self::Answer) -> Document {
        let table = record().table(
            "methods",
            "Published integrators: order on oscillators, cost a step, stable steps, efficiency, engines",
            all.iter(),
        );
        let mut lines = vec![
            format!("{} integrators; kickdrift word --method NAME shows one in full", all.len()),
            "order on oscillators; general: on all problems; Nystrom: where the kinetic energy is quadratic"
                .into(),
            "two forces: omega1 h below which they are stable at lambda2/lambda1 = 1/16 (periods 1:4)".into(),
            "free: no unstable step there before the slow force's own limit omega2 h = 2".into(),
        ];
        lines.push(processed(all));
        lines.extend(all.iter().filter_map(Listed::disagreement));
        // A narrow terminal leaves out the last ones.
        let people = table.only(&[
            "name",
            "order",
            "evaluations",
            "edge",
            "efficiency",
            "coupled_edge",
            "free",
            "general_order",
            "nystrom_order",
            "palindrome",
            "nominal_edge",
            "engines",
        ]);
        Document::new(Self::NAME).rows(table).for_people(people).summary(&lines).with_all_rows()
    }
}

const EDGE: Shape = Shape::OrNull(&WIDE_ENCLOSURE);

/// The row of an entry of the catalogue.
fn record() -> Record<'static, Listed> {
    type Of<'a> = &'a Listed;
    let exact = |listed: Of| listed.linted.edge().and_then(Edge::rational).map_or(Cell::Missing, Cell::exact);
    let of = |edge: Option<Ball>| -> Cell { edge.map(|edge| edge.to_f64_enclosure()).into() };
    let engines = |listed: Of| match listed.method.engines {
        [] => Cell::Missing,
        all => Cell::Text(all.join("; ")),
    };
    Record::new()
        .field(Column::new("name").left(), |listed: Of| listed.method.name.into())
        .says(TEXT, "The name that --method takes.")
        .field(Column::new("order"), |listed| listed.linted.order.nominal.into())
        .says(INTEGER, "The order on oscillators when error coefficients below 2^-30 count as 0, friction aside.")
        .field(Column::new("general_order").in_words("general"), |listed| {
            listed.linted.general.as_ref().ok().map(|orders| orders.general.nominal).into()
        })
        .says(Shape::OrNull(&INTEGER), "The order on all problems that split into drifts and kicks, when coefficients below 2^-30 count as 0; null where a letter is no exponential of commutators.")
        .field(Column::new("nystrom_order").in_words("Nystrom"), |listed| {
            listed.linted.general.as_ref().ok().map(|orders| orders.nystrom.nominal).into()
        })
        .says(Shape::OrNull(&INTEGER), "The same where the kinetic energy is quadratic and the forces are those of a potential.")
        .field(Column::new("evaluations").in_words("cost"), |listed| listed.linted.cost.total().into())
        .says(INTEGER, "Evaluations, gradients, solves and exact flows of a step.")
        .field(Column::new("palindrome").left(), |listed| listed.linted.word.asymmetry().is_none().into())
        .says(FLAG, "Whether it is symmetric in time.")
        .field(
            Column::new("edge").titled("omega h below", "$\\omega h$ below").enclosure(),
            move |listed| of(listed.linted.edge_omega_h()),
        )
        .says(EDGE, "The end of the stable interval of omega h that begins at 0; null for two forces and where there is no end.")
        .field(Column::new("nominal_edge").in_words("nominally").enclosure(), move |listed| {
            of(listed.linted.nominal_edge())
        })
        .says(EDGE, "The same edge, in omega h, when unstable intervals below 2^-30 of their size do not count, as rounded coefficients open them.")
        .field(Column::new("edge_s").in_words("(omega h)^2").aside(), exact)
        .says(Shape::OrNull(&TEXT), "Its square where it is rational.")
        .field(Column::new("efficiency").enclosure(), |listed| listed.linted.efficiency().into())
        .says(EDGE, "omega h at the nominal edge per evaluation, gradient and solve.")
        .field(
            Column::new("coupled_edge").titled("omega1 h below", "$\\omega_1 h$ below").enclosure(),
            move |listed| of(listed.two.as_ref().and_then(Linted::edge_omega_h)),
        )
        .says(EDGE, "For two forces with lambda2/lambda1 = 1/16: sqrt(lambda1) h below which every step is stable; null for one force and where there is no such end.")
        .field(Column::new("free").titled("free", "free").left(), |listed| listed.is_free().into())
        .says(Shape::OrNull(&FLAG), "For two forces with lambda2/lambda1 = 1/16: whether no step is unstable before sqrt(lambda2) h = 2; null for one force.")
        .field(Column::new("engines").left(), engines)
        .says(Shape::OrNull(&TEXT), "Programs that have it, each with what to write there; null where none is known here.")
        .field(Column::new("published_order").aside(), |listed| listed.method.order.into())
        .says(INTEGER, "The order that its source states, where the kinetic energy is quadratic.")
        .field(Column::new("processed_order").aside(), |listed| listed.method.processed.into())
        .says(Shape::OrNull(&INTEGER), "The same between a processor and its inverse, which change no stable step; null for a method without them.")
        .field(Column::new("published_edge").aside(), |listed| {
            listed.method.limit().map_or(Cell::Missing, |limit| Cell::Text(limit.below.into()))
        })
        .says(Shape::OrNull(&TEXT), "omega h, or omega1 h of two forces, below which it is published to be stable; \"infinity\" where no step is unstable; \"free\" where two forces have no resonance; null where no such limit is known here.")
        .field(Column::new("published_edge_source").left().aside(), |listed| {
            listed.method.limit().map_or(Cell::Missing, |limit| Cell::Text(limit.source.into()))
        })
        .says(Shape::OrNull(&TEXT), "Where that is published.")
        .field(Column::new("disagreement").left().aside(), |listed| {
            let reason = listed.method.limit().and_then(|limit| limit.disagrees);
            reason.map_or(Cell::Missing, |reason| Cell::Text(reason.into()))
        })
        .says(Shape::OrNull(&TEXT), "Why the edge is another one than that; null where it is not.")
        .field(Column::new("word").left().aside(), |listed| Cell::exact(&listed.linted.word))
        .says(TEXT, "The word, its coefficients exact.")
        .field(Column::new("source").left().aside(), |listed| listed.method.source.into())
        .says(TEXT, "Where the coefficients come from.")
}

/// The orders of methods that are meant to stand between a processor and its inverse.
fn processed(all: &[Listed]) -> String {
    let mut names: BTreeMap<u64, Vec<&str>> = BTreeMap::new();
    for Method { name, processed, .. } in all.iter().map(|listed| listed.method) {
        processed.iter().for_each(|&order| names.entry(order).or_default().push(name));
    }
    let each: Vec<String> =
        names.iter().map(|(order, names)| format!("order {order}: {}", names.join(", "))).collect();
    format!("between a processor and its inverse, which change no stable step: {}", each.join("; "))
}

/// An entry of the catalogue.
#[derive(Clone, Debug)]
pub struct Listed {
    pub method: &'static Method,
    pub linted: Linted,
    /// The answer for Λ1 = 16, Λ2 = 1, where the word names forces.
    pub two: Option<Linted>,
}

/// Steps up to √Λ2 h = 2, at which the slow force alone has its edge: √Λ1 h = 8.
fn slow_range() -> StepRange {
    (Laurent::zero(), Laurent::from_integer(2))
}

impl Listed {
    /// Where a published limit is not the one found here, and why.
    fn disagreement(&self) -> Option<String> {
        let (name, limit) = (self.method.name, self.method.limit()?);
        let (linted, omega) = match &self.two {
            Some(two) => (two, "omega1"),
            None => (&self.linted, "omega"),
        };
        let (published, edge) = (limit.below, linted.edge_omega_h()?.mid_f64());
        Some(format!("{name}: published {omega} h below {published}, here {edge:.5}: {}", limit.disagrees?))
    }

    /// Whether no step below √Λ2 h = 2 is unstable at Λ2/Λ1 = 1/16: that is free of resonance. `None` for one
    /// force, and where edges that touch are not separated.
    pub fn is_free(&self) -> Option<bool> {
        let two = self.two.as_ref()?;
        let limit = Rational::from_integer(64.into());
        match (&two.stability, &two.pieces) {
            (Some(stability), _) => Some(match stability.first_edge() {
                Some(edge) => edge.compare(&limit) != Sign::Negative,
                None => stability.begins_stable(),
            }),
            (_, Some(pieces)) if pieces.is_free => Some(true),
            (_, Some(pieces)) if pieces.all.iter().any(|piece| !piece.stable) => Some(false),
            (_, Some(pieces)) => (pieces.all.len() == 1).then_some(true),
            _ => None,
        }
    }
}
