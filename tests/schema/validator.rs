//! JSON Schema (2020-12) as far as `data/schema` uses it. A schema with any other keyword is refused, for
//! what is not understood would not be checked.

use regex_lite::Regex;
use serde_json::{Map, Value};

/// A schema document.
pub struct Validator {
    root: Value,
}

impl Validator {
    /// Takes a schema, or says what in it is none.
    pub fn new(root: Value) -> Result<Validator, String> {
        let validator = Validator { root };
        validator.understands(&validator.root, "#")?;
        Ok(validator)
    }

    pub fn is_valid(&self, instance: &Value) -> bool {
        self.errors(instance).is_empty()
    }

    /// All that is wrong, each with its place.
    pub fn errors(&self, instance: &Value) -> Vec<String> {
        let mut errors = Vec::new();
        self.check(&self.root, instance, "", &mut errors);
        errors
    }

    /// Every keyword inside is known and has a value of its kind; every reference leads somewhere.
    fn understands(&self, schema: &Value, at: &str) -> Result<(), String> {
        let Value::Object(keywords) = schema else {
            return if schema.is_boolean() { Ok(()) } else { Err(format!("{at}: {schema} is no schema")) };
        };
        for (key, value) in keywords {
            let at = format!("{at}/{key}");
            match key.as_str() {
                "additionalProperties" | "items" | "if" | "then" | "else" | "not" => {
                    self.understands(value, &at)?;
                }
                "oneOf" | "anyOf" | "allOf" | "prefixItems" => {
                    let all = value.as_array().filter(|all| !all.is_empty()).ok_or(at.clone())?;
                    all.iter().try_for_each(|schema| self.understands(schema, &at))?;
                }
                "properties" | "$defs" => {
                    let all = value.as_object().ok_or(at.clone())?;
                    all.iter()
                        .try_for_each(|(name, schema)| self.understands(schema, &format!("{at}/{name}")))?;
                }
                _ => plain(key, value).then_some(()).ok_or(format!("{at}: {value}"))?,
            }
            if key == "$ref" && self.target(value).is_none() {
                return Err(format!("{at}: {value} leads nowhere"));
            }
        }
        Ok(())
    }

    fn target(&self, reference: &Value) -> Option<&Value> {
        self.root.pointer(reference.as_str()?.strip_prefix('#')?)
    }

    fn fits(&self, schema: &Value, instance: &Value) -> bool {
        let mut errors = Vec::new();
        self.check(schema, instance, "", &mut errors);
        errors.is_empty()
    }

    fn check(&self, schema: &Value, instance: &Value, at: &str, errors: &mut Vec<String>) {
        let Value::Object(keywords) = schema else {
            if schema == &Value::Bool(false) {
                errors.push(format!("{at}: {instance} is not allowed here"));
            }
            return;
        };
        for (key, value) in keywords {
            match key.as_str() {
                "$ref" => self.check(self.target(value).expect("was followed before"), instance, at, errors),
                "properties" | "additionalProperties" | "items" | "prefixItems" => {
                    self.parts(keywords, key, instance, at, errors);
                }
                "then" | "else" => {
                    let holds = keywords.get("if").is_some_and(|condition| self.fits(condition, instance));
                    if keywords.contains_key("if") && holds == (key == "then") {
                        self.check(value, instance, at, errors);
                    }
                }
                _ if self.holds(key, value, instance) => {}
                _ => errors.push(format!("{at}: {instance} fails {key} {value}")),
            }
        }
    }

    /// The members of an object or the elements of an array: those with a schema of their own, and the
    /// others.
    fn parts(
        &self,
        all: &Map<String, Value>,
        key: &str,
        instance: &Value,
        at: &str,
        errors: &mut Vec<String>,
    ) {
        let (named, parts): (&str, Vec<(String, &Value)>) = match (key, instance) {
            ("properties" | "additionalProperties", Value::Object(members)) => {
                ("properties", members.iter().map(|(name, member)| (name.clone(), member)).collect())
            }
            ("prefixItems" | "items", Value::Array(elements)) => (
                "prefixItems",
                elements.iter().enumerate().map(|(i, element)| (i.to_string(), element)).collect(),
            ),
            _ => return,
        };
        for (name, part) in parts {
            let own = all.get(named).and_then(|schemas| match schemas {
                Value::Array(first) => first.get(name.parse::<usize>().expect("an index")),
                schemas => schemas.get(&name),
            });
            let schema = if key == named { own } else { all.get(key).filter(|_| own.is_none()) };
            if let Some(schema) = schema {
                self.check(schema, part, &format!("{at}/{name}"), errors);
            }
        }
    }

    /// Keywords that say yes or no to the instance as a whole; of another type than theirs they say nothing.
    fn holds(&self, key: &str, value: &Value, instance: &Value) -> bool {
        let options = || value.as_array().into_iter().flatten();
        let number = |holds: fn(f64, f64) -> bool| {
            instance.as_f64().zip(value.as_f64()).is_none_or(|(x, bound)| holds(x, bound))
        };
        let count = |length: Option<usize>, holds: fn(u64, u64) -> bool| {
            length.zip(value.as_u64()).is_none_or(|(length, bound)| holds(length as u64, bound))
        };
        let letters = instance.as_str().map(|text| text.chars().count());
        let elements = instance.as_array().map(Vec::len);
        match key {
            "type" if value.is_array() => options().any(|name| is_a(name, instance)),
            "type" => is_a(value, instance),
            // 0 and 0.0 are one number, in whatever digits it is written.
            "const" => value == instance || value.as_f64().is_some_and(|x| instance.as_f64() == Some(x)),
            "enum" => options().any(|option| option == instance),
            "required" => instance.as_object().is_none_or(|members| {
                options().filter_map(Value::as_str).all(|name| members.contains_key(name))
            }),
            "oneOf" => options().filter(|schema| self.fits(schema, instance)).count() == 1,
            "anyOf" => options().any(|schema| self.fits(schema, instance)),
            "allOf" => options().all(|schema| self.fits(schema, instance)),
            "not" => !self.fits(value, instance),
            "pattern" => {
                let pattern = value.as_str().and_then(|text| Regex::new(text).ok()).expect("was read before");
                instance.as_str().is_none_or(|text| pattern.is_match(text))
            }
            "minimum" => number(|x, bound| x >= bound),
            "maximum" => number(|x, bound| x <= bound),
            "exclusiveMinimum" => number(|x, bound| x > bound),
            "exclusiveMaximum" => number(|x, bound| x < bound),
            "minLength" => count(letters, |length, bound| length >= bound),
            "maxLength" => count(letters, |length, bound| length <= bound),
            "minItems" => count(elements, |length, bound| length >= bound),
            "maxItems" => count(elements, |length, bound| length <= bound),
            // Words for people, and what other keywords look at.
            _ => true,
        }
    }
}

const TYPES: [&str; 7] = ["null", "boolean", "object", "array", "string", "number", "integer"];

fn is_a(name: &Value, instance: &Value) -> bool {
    match name.as_str().expect("was read before") {
        "null" => instance.is_null(),
        "boolean" => instance.is_boolean(),
        "object" => instance.is_object(),
        "array" => instance.is_array(),
        "string" => instance.is_string(),
        "number" => instance.is_number(),
        // 1.0 is an integer too.
        _ => instance.is_i64() || instance.is_u64() || instance.as_f64().is_some_and(|x| x.fract() == 0.0),
    }
}

/// Whether a keyword without schemas inside is known and its value of the right kind.
fn plain(key: &str, value: &Value) -> bool {
    let texts = |value: &Value| value.as_array().is_some_and(|all| all.iter().all(Value::is_string));
    let is_type = |name: &Value| name.as_str().is_some_and(|name| TYPES.contains(&name));
    match key {
        "$schema" | "$id" | "$ref" | "title" | "description" => value.is_string(),
        "type" => {
            is_type(value) || value.as_array().is_some_and(|all| !all.is_empty() && all.iter().all(is_type))
        }
        "required" => texts(value),
        "enum" => value.as_array().is_some_and(|all| !all.is_empty()),
        "const" => true,
        "pattern" => value.as_str().is_some_and(|text| Regex::new(text).is_ok()),
        "minimum" | "maximum" | "exclusiveMinimum" | "exclusiveMaximum" => value.is_number(),
        "minLength" | "maxLength" | "minItems" | "maxItems" => value.is_u64(),
        _ => false,
    }
}

#[test]
fn each_keyword_refuses_what_it_should() {
    use serde_json::json;
    for (schema, good, bad) in [
        (json!({"type": "integer"}), json!(1.0), json!(1.5)),
        (json!({"type": ["string", "null"]}), json!(null), json!(1)),
        (json!({"const": {"a": [1]}}), json!({"a": [1]}), json!({"a": [2]})),
        (json!({"const": 0}), json!(0.0), json!(0.5)),
        (json!({"enum": [1, "x"]}), json!("x"), json!("y")),
        (json!({"required": ["a"]}), json!({"a": null}), json!({"b": 1})),
        (json!({"properties": {"a": {"minimum": 1}}}), json!({"a": 1, "b": 0}), json!({"a": 0})),
        (
            json!({"properties": {"a": true}, "additionalProperties": false}),
            json!({"a": 1}),
            json!({"a": 1, "b": 2}),
        ),
        (json!({"items": {"maximum": 2}}), json!([1, 2]), json!([1, 3])),
        (json!({"prefixItems": [{"const": 1}], "items": {"const": 2}}), json!([1, 2, 2]), json!([1, 1])),
        (json!({"minItems": 1, "maxItems": 2}), json!([1]), json!([])),
        (json!({"maxItems": 2}), json!([1, 2]), json!([1, 2, 3])),
        (json!({"pattern": "^a+$"}), json!("aa"), json!("ab")),
        (json!({"minLength": 2, "maxLength": 3}), json!("äöü"), json!("ä")),
        (json!({"maxLength": 1}), json!("ä"), json!("ab")),
        (json!({"exclusiveMinimum": 0}), json!(1e-300), json!(0)),
        (json!({"exclusiveMaximum": 1}), json!(0.5), json!(1)),
        (json!({"oneOf": [{"minimum": 1}, {"minimum": 2}]}), json!(1), json!(2)),
        (json!({"anyOf": [{"minimum": 1}, {"type": "string"}]}), json!("x"), json!(0)),
        (json!({"allOf": [{"minimum": 1}, {"maximum": 2}]}), json!(1), json!(3)),
        (json!({"not": {"const": 1}}), json!(2), json!(1)),
        (json!({"if": {"const": 1}, "then": false, "else": {"const": 2}}), json!(2), json!(3)),
        (json!({"if": {"const": 1}, "then": false}), json!(3), json!(1)),
        (json!({"$ref": "#/$defs/x", "$defs": {"x": {"const": 1}}}), json!(1), json!(2)),
        (json!({"items": {"properties": {"a": {"type": "string"}}}}), json!([{"a": ""}]), json!([{"a": 1}])),
    ] {
        let validator = Validator::new(schema.clone()).unwrap();
        assert!(validator.is_valid(&good), "{schema} {good}");
        assert!(!validator.is_valid(&bad), "{schema} {bad}");
    }
    for schema in [
        json!({"format": "date"}),
        json!({"items": {"typ": "string"}}),
        json!({"type": "float"}),
        json!({"$ref": "#/$defs/nowhere"}),
        json!({"pattern": "("}),
        json!({"required": "a"}),
        json!({"properties": {"a": 1}}),
        json!(3),
    ] {
        assert!(Validator::new(schema.clone()).is_err(), "{schema}");
    }
}
