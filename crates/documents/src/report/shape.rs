//! Shapes: what the values of a document may be, declared beside the record or the question that makes them.
//! The schemas in `data/schema` are written from them.

use std::borrow::Cow;

use serde_json::{Map, Value, json};

/// What a value of JSON may be. Schemas are texts of JSON here.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// A schema.
    Plain(&'static str),
    /// A schema that stands once in a document's schema, under this name.
    Named(&'static str, &'static str),
    /// One of these texts.
    OneOf(&'static [&'static str]),
    /// One of these texts, where they are no constant.
    Words(fn() -> Vec<String>),
    /// Of one of these shapes.
    Any(&'static [Shape]),
    /// Of this shape, or null.
    OrNull(&'static Shape),
    /// An array of such values.
    List(&'static Shape),
    /// An array of one value of each shape.
    Row(&'static [Shape]),
    /// An object with these keys alone.
    Object(fn() -> Keys),
    /// Of this shape, with further keywords of a schema.
    With(&'static Shape, &'static str),
}

/// Two doubles about a value, each a number within what `$limit` says.
macro_rules! enclosure {
    ($name:literal $(, $limit:literal)?) => {
        Shape::Named(
            $name,
            concat!(
                r#"{
        "description": "An enclosure: the exact value lies between the two doubles.",
        "type": "object",
        "required": ["lo", "hi"],
        "additionalProperties": false,
        "properties": {
            "lo": {"type": "number", "#,
                $($limit, ", ",)?
                r#""description": "A double not above the value."},
            "hi": {"type": "number", "#,
                $($limit, ", ",)?
                r#""description": "A double not below the value."}
        }
    }"#
            ),
        )
    };
}

/// Any text.
pub const TEXT: Shape = Shape::Plain(r#"{"type": "string"}"#);
/// True or false.
pub const FLAG: Shape = Shape::Plain(r#"{"type": "boolean"}"#);
/// What a flag of a question is, where it is set.
pub const SET: Shape = Shape::Plain(r#"{"const": "true"}"#);
/// An integer.
pub const INTEGER: Shape = Shape::Plain(r#"{"type": "integer"}"#);
/// A number of things.
pub const COUNT: Shape = Shape::Plain(r#"{"type": "integer", "minimum": 0}"#);
/// An integer from 1 on.
pub const POSITIVE: Shape = Shape::Plain(r#"{"type": "integer", "minimum": 1}"#);
/// −1, 0 or 1.
pub const SIGN: Shape = Shape::Plain(r#"{"enum": [-1, 0, 1]}"#);
/// The members of a group, whose keys follow.
pub const GROUP: Shape = Shape::Plain(r#"{"type": "object"}"#);
/// The members of a group that may be null.
pub const GROUP_OR_NULL: Shape = Shape::Plain(r#"{"type": ["object", "null"]}"#);
/// A whole number as a text.
pub const WHOLE: Shape = Shape::Named("whole", r#"{"type": "string", "pattern": "^[0-9]+$"}"#);
/// A rational number as a text.
pub const RATIONAL: Shape = Shape::Named(
    "rational",
    r#"{"type": "string", "pattern": "^-?[0-9]+(/[0-9]+)?$", "description": "A rational number, exactly."}"#,
);
/// A ratio of steps as a text.
pub const RATIO: Shape = Shape::Named("ratio", r#"{"type": "string", "pattern": "^[0-9]+/[0-9]+$"}"#);
/// An exact number as a text.
pub const EXACT: Shape = Shape::Named(
    "exact",
    r#"{"type": "string", "pattern": "^[-0-9pi^*/+() ]+$", "description": "An exact number, as 7/2 or pi^2/25."}"#,
);
/// A closed range of exact numbers as a text.
pub const RANGE: Shape = Shape::Named(
    "range",
    r#"{
        "type": "string",
        "pattern": "^[-0-9pi^*/+() ]+[.][.][-0-9pi^*/+() ]+$",
        "description": "A closed range of exact numbers."
    }"#,
);
/// A closed range of rational numbers as a text.
pub const RATIONAL_RANGE: Shape = Shape::Named(
    "rational_range",
    r#"{
        "type": "string",
        "pattern": "^-?[0-9]+(/[0-9]+)?[.][.]-?[0-9]+(/[0-9]+)?$",
        "description": "A closed range of rational numbers."
    }"#,
);
/// A closed range of integers as a text.
pub const INTEGERS: Shape = Shape::Named(
    "integers",
    r#"{"type": "string", "pattern": "^-?[0-9]+[.][.]-?[0-9]+$", "description": "A closed range of integers."}"#,
);
/// An exact number as a person may write it.
pub const QUANTITY: Shape = Shape::Named(
    "quantity",
    r#"{
        "type": ["string", "number"],
        "minLength": 1,
        "maxLength": 20000,
        "description": "An exact number, as \"3/10\", \"pi^2/25\" or 0.3, which is 3/10: a JSON number is read from its text, no double between."
    }"#,
);
/// A number of things as a person may write it.
pub const COUNT_WRITTEN: Shape =
    Shape::Named("count", r#"{"type": ["integer", "string"], "minimum": 0, "pattern": "^[0-9]+$"}"#);
const RANGE_WRITTEN: Shape = Shape::Named(
    "range",
    r#"{"type": "string", "pattern": "^.+[.][.].+$", "description": "A closed range LO..HI of exact numbers."}"#,
);
/// A double near the value.
pub const ROUNDED: Shape =
    Shape::Named("rounded", r#"{"type": "number", "description": "A rounded double."}"#);
/// Two doubles about the value.
pub const ENCLOSURE: Shape = enclosure!("enclosure");
/// Two doubles about a value that may be beyond all doubles.
pub const WIDE_ENCLOSURE: Shape = Shape::Named(
    "wide_enclosure",
    r#"{
        "description": "An enclosure: the exact value lies between the two doubles.",
        "type": "object",
        "required": ["lo", "hi"],
        "additionalProperties": false,
        "properties": {
            "lo": {
                "type": ["number", "null"],
                "description": "A double not above the value; null: below the least double."
            },
            "hi": {
                "type": ["number", "null"],
                "description": "A double not below the value; null: beyond the largest double."
            }
        }
    }"#,
);
/// Two doubles not below 0 about the value.
pub const ENCLOSURE_FROM_0: Shape = enclosure!("enclosure_from_0", r#""minimum": 0"#);
/// The same, or null.
pub const ENCLOSED_OR_NULL: Shape = Shape::OrNull(&WIDE_ENCLOSURE);
/// A double near a number above 0.
pub const ABOVE_0: Shape = Shape::With(&ROUNDED, r#"{"exclusiveMinimum": 0}"#);
/// A double near the value, or null.
pub const ROUNDED_OR_NULL: Shape = Shape::OrNull(&ROUNDED);
/// True, false, or null.
pub const FLAG_OR_NULL: Shape = Shape::OrNull(&FLAG);
/// Rounded doubles.
pub const ALL_ROUNDED: Shape = Shape::List(&ROUNDED);
/// Sentences.
pub const TEXTS: Shape = Shape::List(&TEXT);
/// Decimal digits of a number that is not below 0.
pub const DECIMAL: Shape =
    Shape::Named("decimal", r#"{"type": "string", "pattern": "^[0-9]+([.][0-9]+)?(e-?[0-9]+)?$"}"#);
/// A rational number that is not below 0, or null.
pub const RATIONAL_OR_NULL: Shape =
    Shape::Plain(r#"{"type": ["string", "null"], "pattern": "^[0-9]+(/[0-9]+)?$"}"#);
/// Two doubles above 0 about the value.
pub const POSITIVE_ENCLOSURE: Shape = enclosure!("positive_enclosure", r#""exclusiveMinimum": 0"#);
/// The kind of a verdict.
pub const KIND: Shape =
    Shape::Named("kind", r#"{"enum": ["elliptic", "hyperbolic", "parabolic", "coexistence"]}"#);

/// The same, or that none is decided.
pub const KIND_IF_DECIDED: Shape = Shape::Named(
    "kind_if_decided",
    r#"{"enum": ["elliptic", "hyperbolic", "parabolic", "coexistence", "not decided"]}"#,
);

/// One key of an object.
#[derive(Clone, Debug)]
struct Key {
    /// As in a [`Record`](super::record::Record): `work.kicks` is in the group `work`.
    path: Cow<'static, str>,
    shape: Shape,
    says: Cow<'static, str>,
}

/// The keys of an object, each with its shape and a sentence.
#[derive(Clone, Debug, Default)]
#[must_use]
pub struct Keys {
    keys: Vec<Key>,
    /// Groups and keys that some objects lack.
    optional: Vec<String>,
}

impl Keys {
    /// No keys.
    pub fn new() -> Keys {
        Keys::default()
    }

    /// One more key.
    pub fn key(
        self,
        path: impl Into<Cow<'static, str>>,
        shape: Shape,
        says: impl Into<Cow<'static, str>>,
    ) -> Keys {
        self.with(path, shape, says, true)
    }

    /// One more key, which some objects lack.
    pub fn optional(
        self,
        path: impl Into<Cow<'static, str>>,
        shape: Shape,
        says: impl Into<Cow<'static, str>>,
    ) -> Keys {
        self.with(path, shape, says, false)
    }

    /// One more key, which is required or not.
    pub fn with(
        mut self,
        path: impl Into<Cow<'static, str>>,
        shape: Shape,
        says: impl Into<Cow<'static, str>>,
        is_required: bool,
    ) -> Keys {
        let key = Key { path: path.into(), shape, says: says.into() };
        if !is_required {
            self.optional.push(key.path.to_string());
        }
        self.keys.push(key);
        self
    }

    /// The keys of both.
    pub fn and(mut self, more: Keys) -> Keys {
        self.keys.extend(more.keys);
        self.optional.extend(more.optional);
        self
    }

    /// Says that objects with the keys of `less` alone are such objects, too: what is not there is optional,
    /// whole groups or keys inside of them.
    pub fn or_only(mut self, less: &Keys) -> Keys {
        let has = |path: &str| {
            let inside = |key: &Key| key.path.strip_prefix(path).is_some_and(|rest| rest.starts_with('.'));
            less.keys.iter().any(|key| key.path == path || inside(key))
        };
        for key in &self.keys {
            let ends = key.path.match_indices('.').map(|(end, _)| end).chain([key.path.len()]);
            let missing = ends.map(|end| &key.path[..end]).find(|path| !has(path));
            self.optional.extend(missing.map(String::from));
        }
        self
    }

    /// Those of other names.
    pub fn without(mut self, names: &[&str]) -> Keys {
        self.keys.retain(|key| !names.contains(&key.path.as_ref()));
        self
    }

    /// Says that every object has these.
    pub fn requiring(mut self, names: &[&str]) -> Keys {
        self.optional.retain(|path| !names.contains(&path.as_str()));
        self
    }

    /// The same as a person may write them in a file, each at its place there, and required only as `names`
    /// say.
    pub fn written(mut self, place: impl Fn(&str) -> Option<&'static str>, names: &[&str]) -> Keys {
        for key in &mut self.keys {
            key.path = place(&key.path).map_or_else(|| key.path.clone(), Cow::from);
            key.shape = match key.shape {
                Shape::Named("exact" | "rational" | "ratio", _) => QUANTITY,
                Shape::Named("whole", _) => COUNT_WRITTEN,
                Shape::Named("range" | "rational_range" | "integers", _) => RANGE_WRITTEN,
                other => other,
            };
        }
        let all = self.keys.iter().flat_map(|key| {
            key.path.split_once('.').map(|(group, _)| group).into_iter().chain([key.path.as_ref()])
        });
        self.optional = all.filter(|path| !names.contains(path)).map(String::from).collect();
        self
    }

    /// The schema of the object; `defs` takes the schemas that have names.
    fn schema(&self, defs: &mut Map<String, Value>) -> Map<String, Value> {
        self.group("", json!({"type": "object"}), defs)
    }

    /// The schema of the group at a path, which ends in a dot, from that of the group's own key.
    fn group(&self, path: &str, own: Value, defs: &mut Map<String, Value>) -> Map<String, Value> {
        let Value::Object(mut schema) = own else { unreachable!("a group is an object") };
        let member = |key: &Key| {
            let rest = key.path.strip_prefix(path)?;
            Some(rest.split_once('.').map_or(rest, |(name, _)| name).to_string())
        };
        let known = schema.remove("properties");
        let mut properties = known.and_then(|known| known.as_object().cloned()).unwrap_or_default();
        let known = schema.remove("required");
        let mut required = known.and_then(|known| known.as_array().cloned()).unwrap_or_default();
        for name in self.keys.iter().filter_map(member) {
            if properties.contains_key(&name) {
                continue;
            }
            let whole = format!("{path}{name}");
            let key = self.keys.iter().find(|key| key.path == whole);
            if !self.optional.contains(&whole) {
                required.push(name.as_str().into());
            }
            properties.insert(name, self.property(&whole, key, defs));
        }
        if !required.is_empty() {
            schema.insert("required".into(), required.into());
        }
        schema.insert("additionalProperties".into(), false.into());
        schema.insert("properties".into(), properties.into());
        schema
    }

    /// The schema of the value at a path.
    fn property(&self, path: &str, key: Option<&Key>, defs: &mut Map<String, Value>) -> Value {
        let inside = format!("{path}.");
        let says = key.map(|key| key.says.as_ref()).filter(|says| !says.is_empty());
        if !self.keys.iter().any(|key| key.path.starts_with(&inside)) {
            let key = key.expect("a path without others inside is a key");
            return described(key.shape.schema(defs), says);
        }
        let own = key.map_or(GROUP, |key| key.shape).whole();
        described(self.group(&inside, own, defs).into(), says)
    }
}

/// A schema with a sentence in place of its own; behind a reference, before anything else.
fn described(schema: Value, says: Option<&str>) -> Value {
    let Value::Object(schema) = schema else { unreachable!("a schema is an object") };
    let own = schema.get("description").cloned();
    let Some(says) = says.map(Value::from).or(own) else { return schema.into() };
    let (references, keywords): (Vec<_>, Vec<_>) =
        schema.into_iter().filter(|(key, _)| key != "description").partition(|(key, _)| key == "$ref");
    let says = [("description".to_string(), says)];
    references.into_iter().chain(says).chain(keywords).collect::<Map<String, Value>>().into()
}

fn read(text: &str) -> Value {
    serde_json::from_str(text).expect("a shape is JSON")
}

impl Shape {
    /// The schema with all its words.
    fn whole(&self) -> Value {
        match self {
            Shape::Named(_, text) | Shape::Plain(text) => read(text),
            other => unreachable!("no group is made of {other:?}"),
        }
    }

    /// The schema; `defs` takes those that have names.
    fn schema(&self, defs: &mut Map<String, Value>) -> Value {
        match self {
            Shape::Plain(text) => read(text),
            Shape::Named(name, text) => {
                defs.insert((*name).into(), read(text));
                json!({"$ref": format!("#/$defs/{name}")})
            }
            Shape::OneOf(words) => json!({"enum": words}),
            Shape::Words(words) => json!({"enum": words()}),
            Shape::Any(shapes) => {
                let shapes: Vec<Value> = shapes.iter().map(|shape| shape.schema(defs)).collect();
                json!({"anyOf": shapes})
            }
            Shape::OrNull(shape) => json!({"anyOf": [shape.schema(defs), {"type": "null"}]}),
            Shape::List(shape) => json!({"type": "array", "items": shape.schema(defs)}),
            Shape::Row(shapes) => {
                let (all, n): (Vec<Value>, _) =
                    (shapes.iter().map(|shape| shape.schema(defs)).collect(), shapes.len());
                json!({"type": "array", "prefixItems": all, "minItems": n, "maxItems": n})
            }
            Shape::Object(keys) => keys().schema(defs).into(),
            Shape::With(shape, more) => {
                let (Value::Object(mut schema), Value::Object(more)) = (shape.schema(defs), read(more))
                else {
                    unreachable!("a schema is an object")
                };
                schema.extend(more);
                schema.into()
            }
        }
    }
}

/// The schema of a kind of documents.
#[derive(Clone, Debug)]
#[must_use]
pub struct Schema {
    /// One line on what such a document is.
    title: &'static str,
    /// More about it; empty where the title says all.
    about: &'static str,
    /// The keys beside the head and the `input`.
    body: Keys,
    /// Further keywords, for what no single key can say; `{}` where there are none.
    rules: Cow<'static, str>,
}

impl Schema {
    /// Documents with these keys beside their head and their `input`; the title is one line on them.
    pub fn new(title: &'static str, body: Keys) -> Schema {
        Schema { title, about: "", body, rules: "{}".into() }
    }

    /// Adds a sentence or two on the documents.
    pub fn about(self, about: &'static str) -> Schema {
        Schema { about, ..self }
    }

    /// Adds keywords for what no single key can say.
    pub fn rules(self, rules: impl Into<Cow<'static, str>>) -> Schema {
        Schema { rules: rules.into(), ..self }
    }

    /// The schema of `kickdrift/NAME/1` as JSON, whose `input` has these keys.
    pub fn value(&self, name: &'static str, input: &Keys) -> Value {
        let mut defs = Map::new();
        let head = json!({
            "type": "object",
            "description": "The version that wrote the document, and the command that makes it.",
            "required": ["version", "command"],
            "additionalProperties": false,
            "properties": {
                "version": {"type": "string"},
                "command": {"const": super::document::command(name)},
            },
        });
        let input = input.schema(&mut defs);
        let head = [("kickdrift", head), ("input", input.into())];
        self.with_head(name, head.into_iter().map(|(key, value)| (key.into(), value)).collect(), defs)
    }

    /// The schema of a file that a person writes, `kickdrift/NAME/1`.
    pub fn file(&self, name: &'static str) -> Value {
        self.with_head(name, Map::new(), Map::new())
    }

    fn with_head(&self, name: &str, head: Map<String, Value>, mut defs: Map<String, Value>) -> Value {
        let id = format!("kickdrift/{name}/1");
        let mut properties = Map::new();
        properties.insert("schema".into(), json!({"const": id}));
        properties.extend(head);
        let required: Vec<&String> = properties.keys().collect();
        let own = json!({"type": "object", "required": required, "properties": properties});
        let mut schema = Map::new();
        schema.insert("$schema".into(), "https://json-schema.org/draft/2020-12/schema".into());
        schema.insert("$id".into(), id.into());
        schema.insert("title".into(), self.title.into());
        if !self.about.is_empty() {
            schema.insert("description".into(), self.about.into());
        }
        schema.extend(self.body.group("", own, &mut defs));
        let Value::Object(rules) = read(&self.rules) else { unreachable!("rules are keywords") };
        schema.extend(rules);
        if !defs.is_empty() {
            defs.sort_keys();
            schema.insert("$defs".into(), defs.into());
        }
        schema.into()
    }
}
