//! Bytes, what they are, and errors as JSON.

use std::borrow::Cow;

use serde_json::{Value, json};

use number::Error;
use number::error::Kind;

/// An answer: an HTTP status, a media type, bytes, and the name of a file where it is one to keep.
#[derive(Clone, Debug)]
pub struct Reply {
    pub status: u16,
    pub media: &'static str,
    pub bytes: Cow<'static, [u8]>,
    pub file: Option<&'static str>,
}

const JSON: &str = "application/json";

impl Reply {
    /// Bytes of a type.
    pub(super) fn new(media: &'static str, bytes: impl Into<Cow<'static, [u8]>>) -> Reply {
        Reply { status: 200, media, bytes: bytes.into(), file: None }
    }

    /// JSON on one line.
    pub(super) fn json(value: &Value) -> Reply {
        Reply::new(JSON, value.to_string().into_bytes())
    }

    /// A file to keep.
    pub(super) fn file(name: &'static str, media: &'static str, bytes: Vec<u8>) -> Reply {
        Reply { file: Some(name), ..Reply::new(media, bytes) }
    }

    /// Work that costs more than is allowed: 422 with `{"too_costly": {"cost", "limit", "unit", "message"}}`;
    /// what is allowed is said in kicks, about a nanosecond each.
    pub(super) fn too_costly(cost: Option<f64>, limit: u64, message: &str) -> Reply {
        let body = json!({"cost": cost, "limit": limit, "unit": "kicks", "message": message});
        Reply { status: 422, ..Reply::json(&json!({ "too_costly": body })) }
    }

    /// An error: 400 with `{"error": {"field", "value", "remedy", "message"}}`, 422 where it is one of cost,
    /// 500 where the machine refused.
    pub(super) fn refusal(error: &Error, limit: u64) -> Reply {
        let status = match error.kind() {
            Kind::Budget => {
                return Reply::too_costly(
                    error.needed().map(|kicks| kicks as f64),
                    limit,
                    &error.to_string(),
                );
            }
            Kind::Io => 500,
            _ => 400,
        };
        let body = json!({
            "field": error.field(), "value": error.value(), "remedy": error.remedy(), "message": error.to_string(),
        });
        Reply { status, ..Reply::json(&json!({ "error": body })) }
    }
}
