//! `kickdrift mcp`: the questions as tools of the Model Context Protocol, for assistants. A line of standard
//! input is a message of JSON-RPC, a line of standard output its answer.

use std::io::{BufRead, stdin};

use clap::Command as Program;
use serde_json::{Map, Value, json};

use super::args::Common;
use documents::format::Format;
use documents::question;
use documents::report::file::write_output;
use number::{Error, Result};

/// Flags of `mcp`.
#[derive(Debug, clap::Args)]
pub struct Args {}

/// The versions of the protocol whose tools are those of this file, the newest one last.
const VERSIONS: [&str; 3] = ["2024-11-05", "2025-03-26", "2025-06-18"];

const INSTRUCTIONS: &str = "Linear stability of multiple-time-step integrators. Each answer says what is proven, measured, published or unknown. Numbers are texts and exact: \"0.98\", \"1/3\", \"pi^2/25\". Begin with advise for a molecule, verdict for one pair of steps, word for an integrator.";

/// A scene's products are files.
const NO_TOOLS: [&str; 1] = ["run"];

/// A document of more bytes is of no use to who reads it whole: its summary has to do.
const MOST_BYTES: usize = 1 << 18;

/// Codes of JSON-RPC.
const NO_JSON: i64 = -32700;
const NO_REQUEST: i64 = -32600;
const NO_METHOD: i64 = -32601;
const NO_TOOL: i64 = -32602;

impl Args {
    pub fn run(&self, program: &Program, common: &Common) -> Result<()> {
        let tools = tools(program);
        for line in stdin().lock().lines() {
            let line = line.map_err(|cause| Error::io("standard input", cause))?;
            if line.trim().is_empty() {
                continue;
            }
            if let Some(answer) = reply(&line, &tools, common) {
                write_output(None, format!("{answer}\n").as_bytes())?;
            }
        }
        Ok(())
    }
}

/// A tool for each question: its name, what it answers, the schema of its fields.
fn tools(program: &Program) -> Vec<Value> {
    let titles = question::schemas();
    let title = |name: &str| {
        let (_, schema) = titles.iter().find(|(titled, _)| *titled == name)?;
        schema["title"].as_str().map(String::from)
    };
    let about = |name: &str| Some(program.find_subcommand(name)?.get_about()?.to_string());
    let all = question::fields().into_iter().filter(|(name, _)| !NO_TOOLS.contains(name));
    all.map(|(name, schema)| {
        let says = about(name).or_else(|| title(name)).unwrap_or_default();
        json!({"name": name, "description": says, "inputSchema": schema})
    })
    .collect()
}

/// The answer to a message; none to a notification, which has no `id`.
fn reply(line: &str, tools: &[Value], common: &Common) -> Option<Value> {
    let refused = |id: &Value, (code, why): (i64, String)| json!({"jsonrpc": "2.0", "id": id, "error": {"code": code, "message": why}});
    let message: Value = match serde_json::from_str(line) {
        Ok(message) => message,
        Err(cause) => return Some(refused(&Value::Null, (NO_JSON, format!("no JSON: {cause}")))),
    };
    let Some(method) = message["method"].as_str() else {
        return Some(refused(&message["id"], (NO_REQUEST, "a message has a method".into())));
    };
    let id = message.get("id")?;
    Some(match result(method, &message["params"], tools, common) {
        Ok(result) => json!({"jsonrpc": "2.0", "id": id, "result": result}),
        Err(why) => refused(id, why),
    })
}

fn result(
    method: &str,
    params: &Value,
    tools: &[Value],
    common: &Common,
) -> std::result::Result<Value, (i64, String)> {
    match method {
        "initialize" => {
            let asked = params["protocolVersion"].as_str();
            let version = asked.filter(|asked| VERSIONS.contains(asked)).unwrap_or(VERSIONS[2]);
            Ok(json!({
                "protocolVersion": version,
                "capabilities": {"tools": {}},
                "serverInfo": {"name": "kickdrift", "version": env!("CARGO_PKG_VERSION")},
                "instructions": INSTRUCTIONS,
            }))
        }
        "ping" => Ok(json!({})),
        "tools/list" => Ok(json!({"tools": tools})),
        "tools/call" => {
            let name = params["name"].as_str().unwrap_or_default();
            if !tools.iter().any(|tool| tool["name"] == name) {
                return Err((NO_TOOL, format!("no tool {name}: tools/list has their names")));
            }
            Ok(called(name, params["arguments"].as_object().unwrap_or(&Map::new()), common))
        }
        other => Err((NO_METHOD, format!("no method {other}"))),
    }
}

/// The answer to a question: for people, and the document where it is not too long; or what is wrong with it.
fn called(name: &str, arguments: &Map<String, Value>, common: &Common) -> Value {
    let told = |text: String| json!([{"type": "text", "text": text}]);
    let answered = question::ask(name, arguments, &common.work())
        .and_then(|document| Ok((document.render(Format::Text)?, document.value())));
    match answered {
        Ok((text, document)) if document.to_string().len() <= MOST_BYTES => {
            json!({"content": told(text), "structuredContent": document})
        }
        Ok((text, _)) => json!({"content": told(text)}),
        Err(error) => {
            let raise = |needed| format!("start the server with --budget {needed}");
            json!({"content": told(error.explain(raise)), "isError": true})
        }
    }
}
