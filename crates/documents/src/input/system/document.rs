//! The fields of a system file: how they are read, and its schema.

use std::ops::RangeInclusive;

use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::{Value, json};

use super::array::Reference;
use super::given::Given;
use super::held::Constraints;
use super::part::{Count, Index, Number, Part, parts};
use crate::input::json;
use crate::report::shape::{COUNT, COUNT_WRITTEN, Keys, Schema, Shape};
use number::{Error, Result};
use systems::Scheme;
use systems::levels::Method;

/// The sizes of steps, and of the ends of a range: their squares are doubles, too.
pub(super) const SIZES: RangeInclusive<f64> = 1e-150..=1e150;

/// The most degrees of freedom: dense matrices of this size still fit.
pub(super) const LARGEST: usize = 4096;

/// That a text names no more degrees of freedom than dense matrices may have, its lists counted before their
/// elements are built.
pub(super) fn check_lengths(text: &str) -> Result<()> {
    #[derive(Default, Deserialize)]
    #[serde(default)]
    struct Lengths {
        masses: Vec<IgnoredAny>,
        mass_matrix: Vec<IgnoredAny>,
        near: Vec<IgnoredAny>,
    }
    // Whatever is written otherwise is named by who reads it.
    let Lengths { masses, mass_matrix, near } = serde_json::from_str(text).unwrap_or_default();
    let all = [("masses", masses.len()), ("mass_matrix", mass_matrix.len()), ("near", near.len())];
    all.into_iter().try_for_each(|(field, n)| at_most(field, n))
}

/// That a list of one number for each degree of freedom is no longer than their largest number.
pub(super) fn at_most(field: &str, n: usize) -> Result<()> {
    if n <= LARGEST {
        return Ok(());
    }
    Err(Error::input(field, n, format!("at most {LARGEST} degrees of freedom")))
}

/// A matrix by rows.
pub(super) type Rows = Vec<Vec<Number>>;

/// i, j and k of a spring; j null for a wall.
pub(super) type Spring = (Index, Option<Index>, Number);

/// One potential or more.
const POTENTIALS: Shape = Shape::With(&<Vec<PotentialDocument>>::SHAPE, r#"{"minItems": 1}"#);
/// One level or more.
const LEVELS: Shape = Shape::With(&<Vec<LevelDocument>>::SHAPE, r#"{"minItems": 1}"#);
const METHODS: Shape = Shape::Words(|| Method::all().map(|method| method.name().into()).collect());
/// Bonds with the numbers that their forms need.
const BONDS: Shape = Shape::List(&Shape::With(
    &BondDocument::SHAPE,
    r#"{"oneOf": [
        {"properties": {"form": {"const": "harmonic"}}, "required": ["k"]},
        {"properties": {"form": {"const": "quartic"}}, "required": ["k", "beta"]},
        {"properties": {"form": {"const": "lennard-jones"}}, "required": ["epsilon", "sigma"]}
    ]}"#,
));
/// A mesh whose steps are given in one way.
const MESH: Shape = Shape::With(
    &MeshDocument::SHAPE,
    r#"{"oneOf": [
        {"required": ["step"], "properties": {"classes": false}},
        {"required": ["steps"]},
        {"required": ["courant"], "properties": {"classes": false}}
    ]}"#,
);
const NODES: Shape = Shape::List(&Shape::With(&<Vec<Number>>::SHAPE, r#"{"minItems": 1, "maxItems": 3}"#));
const ELEMENTS: Shape = Shape::List(&Shape::With(&<Vec<Index>>::SHAPE, r#"{"minItems": 2, "maxItems": 4}"#));

parts! {
    /// A system file.
    struct Document {
        /// Its kind.
        schema: String,
        /// Shown on figures.
        title: Option<String>,
        /// The name of the unit of steps and periods, as ps: answers name it.
        time_unit: Option<String>,
        /// One for each degree of freedom; beside stiffnesses by reference, one for each three will do.
        masses: Option<Given<Vec<Number>>>,
        /// In place of masses, by rows; beside stiffnesses by reference a diagonal one by reference.
        mass_matrix: Option<Given<Rows>>,
        /// The forces, each with its clock.
        potentials: Option<Vec<PotentialDocument>> [POTENTIALS],
        /// Positions near the equilibrium of the bonds, which is searched from there; 0 unless given.
        near: Option<Vec<Number>>,
        /// One of the usual systems, in place of masses and potentials.
        build: Option<Build>,
        /// Linear finite elements, each with a step of its own, in place of masses and potentials: bars (2
        /// nodes), triangles in the plane (3), tetrahedra (4); isotropic linear elasticity, lumped masses.
        mesh: Option<MeshDocument> [MESH],
        /// What each degree of freedom is called, or each particle of three: of molecules the atom, its kind
        /// of residue and its number, as H1 HOH 4.
        labels: Option<Vec<String>>,
        /// A rate per unit time: v becomes exp(-friction t) v in the middle of every drift over t of the
        /// whole schedule, also of what only some of the clocks act on.
        friction: Option<Number>,
        /// false: a force is no gradient, as one that is learned and predicted directly; stiffness is minus
        /// its derivative, whose asymmetry is no error.
        symmetric: Option<bool>,
        /// Local time steps: all potentials have one step, masses are diagonal, levels say what takes
        /// substeps. lts: leapfrog, forces on the rest stand still (Diaz and Grote); avi: the elements of a
        /// mesh kick with steps of their own (Lew, Marsden, Ortiz and West).
        scheme: Option<String> [Shape::OneOf(Scheme::NAMES)],
        /// Two levels: the integrator, respa unless given. Of rational numbers implicit-explicit is decided
        /// exactly, the others in doubles.
        method: Option<String> [METHODS],
        /// Of local time steps, the coarsest first, each a part of the one above.
        levels: Option<Vec<LevelDocument>> [LEVELS],
        /// Whether stiffnesses are divided by the roots of the masses.
        #[serde(default)]
        mass_weighted: bool,
        /// Three coordinates for each particle: by these, rigid motions are projected out.
        positions: Option<Reference>,
        /// Whether the particles are in a periodic box: then three translations are rigid, and no rotation.
        #[serde(default)]
        periodic: bool,
        /// How well stiffnesses are known, relative to their norms; 1e-6 unless given.
        accuracy: Option<Number>,
        /// Distances that are held: h-bonds (each hydrogen, of mass 1.1 and less, to the nearest heavier
        /// particle), or pairs counted from 0. Then each potential has a force.
        constraints: Option<Constraints>,
        /// Hydrogens (of mass 1.1 and less) get this mass, taken from the nearest heavier particle.
        hydrogen_mass: Option<Number>,
        /// Whether no rigid motions are projected out: there are none, as of atoms among others that stand
        /// still.
        #[serde(default)]
        keep_rigid: bool,
        /// Whether stiffnesses are those along half a period of the integrator's own orbit, arrays (k, n, n),
        /// a matrix for each kick from t = 0 to T/2, both counted, not mass-weighted.
        #[serde(default)]
        along_orbit: bool,
        /// Along an orbit: the positions after half a period, where it turns.
        turned: Option<Reference>,
        /// Along an orbit, in place of positions and turned: an array (2, n, r) of free motions,
        /// mass-weighted columns where the orbit starts and where it turns.
        rigid: Option<Reference>,
        /// The symbol of each particle of three coordinates; unless given, its mass tells.
        elements: Option<Vec<String>>,
        /// Pairs of particles that are bonded; unless given, distances tell.
        bonded: Option<Vec<[usize; 2]>>,
    }

    /// What takes substeps, see the reader of local steps.
    struct LevelDocument {
        /// The degrees of freedom that take substeps; of a sparse stiffness also by reference.
        fine: Option<Given<Vec<Index>>>,
        /// In place of them: elements of the mesh, with all their nodes.
        elements: Option<Vec<Index>>,
        /// In a step of the level above: 1 to 1024.
        substeps: Count [Shape::With(&COUNT_WRITTEN, r#"{"minimum": 1}"#)],
    }

    /// One potential; what it holds is added.
    struct PotentialDocument {
        /// For people, and for paths of scans.
        name: Option<String>,
        /// The time between its kicks.
        step: Number,
        /// When it kicks first, in steps: 0 unless given, or 1/2.
        phase: Option<Number>,
        /// A factor of all that it holds; may hold pi.
        scale: Option<Number>,
        /// i, j, k each; j null for a wall. k may hold pi.
        #[serde(default)]
        springs: Vec<Spring>,
        /// By rows, whose numbers may hold pi; or measured doubles by reference.
        stiffness: Option<Given<Rows>>,
        /// Of named forms: the system is the linear one at their equilibrium.
        #[serde(default)]
        bonds: Vec<BondDocument> [BONDS],
        /// At the positions and not mass-weighted; constraints need it.
        force: Option<Reference>,
    }

    /// A bond between i and j, without j to a wall at 0; r is its extension, of lennard-jones its length.
    struct BondDocument {
        /// A degree of freedom.
        i: Index,
        /// Another one.
        j: Option<Index>,
        /// The potential. harmonic: k r^2/2; quartic: k r^2/2 + beta r^4/4; lennard-jones: 4 epsilon
        /// ((sigma/r)^12 - (sigma/r)^6).
        form: String [Shape::OneOf(&["harmonic", "quartic", "lennard-jones"])],
        /// The stiffness at rest.
        k: Option<Number>,
        /// The quartic part.
        beta: Option<Number>,
        /// The depth of the well.
        epsilon: Option<Number>,
        /// Where the potential is 0.
        sigma: Option<Number>,
    }

    /// Unit masses between two walls, the springs in turn of several kinds.
    struct Chain {
        /// The number of masses.
        masses: Count,
        /// The stiffness of each kind of springs.
        stiffness: Vec<Number>,
        /// The step of each kind of springs.
        steps: Vec<Number>,
    }

    /// Unit masses between soft walls, stiff springs joined by soft ones of stiffness 1.
    struct StiffSoft {
        /// The number of stiff springs.
        pairs: Count,
        /// The stiffness of each.
        stiff: Number,
        /// The step of the stiff springs, and of the soft ones.
        steps: [Number; 2],
    }

    /// A bar in groups of equal length, from coarse elements at the wall to fine ones.
    struct GradedBar {
        /// The number of elements.
        elements: Count,
        /// The number of groups.
        classes: Count,
        /// The step of an element is this fraction of its length.
        courant: Number,
    }

    /// Two masses joined by a stiff bond, the first one tethered to a wall.
    struct TetheredPair {
        /// The mass of the tethered one, and of the other.
        masses: [Number; 2],
        /// The stiffness of the bond, and of the tether.
        stiffness: [Number; 2],
        /// The step of the bond, and of the tether.
        steps: [Number; 2],
    }

    /// Finite elements, see the reader of meshes.
    struct MeshDocument {
        /// 1 to 3 coordinates each.
        nodes: Vec<Vec<Number>> [NODES],
        /// The nodes of each: 2 of a bar, 3 of a triangle in the plane, 4 of a tetrahedron.
        elements: Vec<Vec<Index>> [ELEMENTS],
        /// Nodes that do not move, or pairs of a node and an axis.
        #[serde(default)]
        fixed: Vec<Fixed>,
        /// Young's modulus.
        young: Number,
        /// Mass per unit volume.
        density: Number,
        /// Poisson's ratio; 0 unless given.
        poisson: Option<Number>,
        /// Of plates; of bars the cross-section; 1 unless given.
        thickness: Option<Number>,
        /// Of triangles: stress unless given.
        plane: Option<Plane>,
        /// The step of all elements.
        step: Option<Number>,
        /// One an element, or one a class.
        steps: Option<Vec<Number>>,
        /// The class of each element.
        classes: Option<Vec<Index>>,
        /// Of bars: the step of each is that times its length over the speed of sound.
        courant: Option<Number>,
    }
}

/// One of the usual systems.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub(super) enum Build {
    Chain(Chain),
    StiffSoft(StiffSoft),
    GradedBar(GradedBar),
    TetheredPair(TetheredPair),
}

impl Part for Build {
    const SHAPE: Shape = Shape::Any(&[
        Shape::Object(|| kind(r#"{"const": "chain"}"#).and(Chain::keys())),
        Shape::Object(|| kind(r#"{"const": "stiff-soft"}"#).and(StiffSoft::keys())),
        Shape::Object(|| kind(r#"{"const": "graded-bar"}"#).and(GradedBar::keys())),
        Shape::Object(|| kind(r#"{"const": "tethered-pair"}"#).and(TetheredPair::keys())),
    ]);
}

fn kind(name: &'static str) -> Keys {
    Keys::new().key("kind", Shape::Plain(name), "")
}

#[derive(Clone, Debug, Deserialize)]
#[serde(untagged, expecting = "this is neither a node nor a node and an axis, as 3 or [3, 1]")]
pub(super) enum Fixed {
    Axis([Index; 2]),
    Node(Index),
}

impl Part for Fixed {
    const SHAPE: Shape = Shape::Any(&[COUNT, <[Index; 2]>::SHAPE]);
}

#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Plane {
    Stress,
    Strain,
}

impl Part for Plane {
    const SHAPE: Shape = Shape::OneOf(&["stress", "strain"]);
}

/// Fields that stand beside one kind of stiffnesses alone: numbers in the file, or arrays by reference.
struct Beside {
    remedy: &'static str,
    fields: &'static [&'static str],
    of_potentials: &'static [&'static str],
}

const NUMBERS: Beside = Beside {
    remedy: "stands beside numbers in the file alone, and a stiffness is by reference: leave it out",
    fields: &["near", "build", "mesh", "friction"],
    of_potentials: &["phase", "springs", "bonds"],
};

const REFERENCES: Beside = Beside {
    remedy: "stands beside stiffnesses by reference alone: leave it out",
    fields: &[
        "mass_weighted",
        "positions",
        "periodic",
        "accuracy",
        "constraints",
        "hydrogen_mass",
        "keep_rigid",
        "along_orbit",
        "turned",
        "rigid",
        "elements",
        "bonded",
    ],
    of_potentials: &["force"],
};

/// Whether some stiffness of the file stands by reference.
pub(super) fn is_by_reference(source: &Value) -> bool {
    let is_reference = |value: &Value| value.get("stiffness").is_some_and(Value::is_object);
    potentials(source).any(is_reference)
}

fn potentials(source: &Value) -> impl Iterator<Item = &Value> {
    source.get("potentials").and_then(Value::as_array).into_iter().flatten()
}

impl Beside {
    /// What is wrong in words, and where; an unknown field is in the object of its place. These fields are
    /// none that would help.
    fn fault(&self, cause: &serde_json::Error, path: &str) -> Error {
        let words = json::plain(cause);
        let is_unknown = words.starts_with("unknown field");
        let place = if is_unknown { path.rsplit_once('.').map_or(".", |(place, _)| place) } else { path };
        let is_root = place == ".";
        let beside = if is_root { self.fields } else { self.of_potentials };
        let words = beside.iter().fold(words, |words, field| words.replace(&format!(", `{field}`"), ""));
        let error = no_system(cause, &words);
        if is_root { error } else { error.at(place) }
    }

    /// That a file has none of these.
    fn refuse(&self, source: &Value) -> Result<()> {
        let given = |object: &Value, fields: &[&'static str]| {
            fields.iter().copied().find(|field| object.get(field).is_some())
        };
        let of_potential =
            |(k, potential)| Some(format!("potentials[{k}].{}", given(potential, self.of_potentials)?));
        let found = given(source, self.fields).map(String::from);
        let found = found.or_else(|| potentials(source).enumerate().find_map(of_potential));
        found.map_or(Ok(()), |field| Err(Error::input(&field, "given", self.remedy)))
    }

    /// The keyword `properties` of files that have none of these: more about their fields and those of their
    /// potentials.
    fn absent(&self, mut fields: Value, mut of_potential: Value) -> Value {
        self.of_potentials.iter().for_each(|field| of_potential[field] = false.into());
        self.fields.iter().for_each(|field| fields[field] = false.into());
        fields["potentials"] = json!({"items": {"properties": of_potential}});
        fields
    }
}

impl Document {
    /// The fields of a file; an error names the line where there is a text.
    pub fn parse(source: &Value, text: Option<&str>) -> Result<Document> {
        let other = if is_by_reference(source) { NUMBERS } else { REFERENCES };
        other.refuse(source)?;
        let read = serde_path_to_error::deserialize(source).or_else(|fault| match text {
            Some(text) => {
                let text = text.strip_prefix('\u{feff}').unwrap_or(text);
                serde_path_to_error::deserialize(&mut serde_json::Deserializer::from_str(text))
            }
            None => Err(fault),
        });
        read.map_err(|fault| {
            let path = fault.path().to_string();
            other.fault(&fault.into_inner(), &path)
        })
    }

    /// The schema of system files, by their name.
    pub fn schema() -> (&'static str, Value) {
        let list = json!({"type": "array"});
        let fine = json!({"items": {"properties": {"fine": list}}});
        let numbers =
            REFERENCES.absent(json!({"masses": list, "mass_matrix": list, "levels": fine}), json!({}));
        let array = json!({"type": "object"});
        let fine = json!({"items": {"required": ["fine"], "properties": {"elements": false}}});
        let mut references =
            NUMBERS.absent(json!({"mass_matrix": array, "levels": fine}), json!({"stiffness": array}));
        references["potentials"]["items"]["required"] = json!(["stiffness"]);
        let one_of = |all: &[&str]| all.iter().map(|field| json!({"required": [field]})).collect::<Vec<_>>();
        let rules = json!({
            "oneOf": one_of(&["build", "mesh", "potentials"]),
            "if": {"properties": {"potentials": {"items": {"properties": {"stiffness": {"not": array}}}}}},
            "then": {"oneOf": one_of(&["build", "mesh", "masses", "mass_matrix"]), "properties": numbers},
            "else": {"properties": references},
        });
        let schema = Schema::new(
            "A system of many clocks and degrees of freedom",
            Document::keys().without(&["schema"]),
        );
        let about = "Masses and potentials with their clocks, or one of the usual cases by name. All quantities are exact, in units of the file's own; indices count from 0.";
        ("system", schema.about(about).rules(rules.to_string()).file("system"))
    }
}

/// The two ends of what joins i and j, j `None` for a wall.
pub(super) fn ends(field: &str, i: &Index, j: Option<&Index>, n: usize) -> Result<(usize, Option<usize>)> {
    let i = i.read(field, n)?;
    let j = j.map(|j| j.read(field, n)).transpose()?;
    if j == Some(i) {
        return Err(Error::input(field, i, "joins two different indices, or one and null"));
    }
    Ok((i, j))
}

/// Why a text is no system.
pub(super) fn no_system(cause: &serde_json::Error, words: &str) -> Error {
    let (line, column) = (cause.line(), cause.column());
    let place = if line > 0 { format!("line {line}, column {column}") } else { "this file".into() };
    Error::input(
        "system",
        place,
        format!(
            "{}; write one JSON object as in data/scenes/diatomic-tether.json",
            words.trim_end_matches('?')
        ),
    )
}
