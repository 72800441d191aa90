//! `mcp`: what an assistant sends, a line a message, and what comes back.

use std::io::Write;
use std::process::Stdio;

use serde_json::{Value, json};

use super::support::Desk;

/// The answers to these lines, in their order.
fn answers(lines: &[String]) -> Vec<Value> {
    let mut child =
        Desk::new().command(&["mcp"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all((lines.join("\n") + "\n").as_bytes()).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn request(id: u64, method: &str, params: Value) -> String {
    json!({"jsonrpc": "2.0", "id": id, "method": method, "params": params}).to_string()
}

fn call(id: u64, name: &str, arguments: Value) -> String {
    request(id, "tools/call", json!({"name": name, "arguments": arguments}))
}

#[test]
fn an_assistant_begins_lists_the_tools_and_asks() {
    let lines = [
        request(1, "initialize", json!({"protocolVersion": "2025-03-26", "capabilities": {}})),
        json!({"jsonrpc": "2.0", "method": "notifications/initialized"}).to_string(),
        request(2, "tools/list", json!({})),
        call(3, "verdict", json!({"lambda1": "pi^2", "lambda2": "pi^2/25", "h1": "1/100", "h2": "0.98"})),
        call(4, "advise", json!({"period": ["OH=10fs", "slow=40fs"], "steps": ["0.5fs,4fs"]})),
    ];
    let all = answers(&lines);
    assert_eq!(all.iter().map(|answer| answer["id"].as_u64().unwrap()).collect::<Vec<_>>(), [1, 2, 3, 4]);
    assert_eq!(all[0]["result"]["protocolVersion"], "2025-03-26");
    let tools = all[1]["result"]["tools"].as_array().unwrap();
    assert!(tools.len() > 15, "{tools:?}");
    for tool in tools {
        assert!(!tool["description"].as_str().unwrap().is_empty(), "{tool}");
        assert_eq!(tool["inputSchema"]["type"], "object", "{tool}");
    }
    let verdict = tools.iter().find(|tool| tool["name"] == "verdict").unwrap();
    let required = verdict["inputSchema"]["required"].as_array().unwrap();
    assert!(
        ["lambda1", "lambda2", "h1", "h2"].iter().all(|name| required.contains(&json!(name))),
        "{verdict}"
    );
    let advise = tools.iter().find(|tool| tool["name"] == "advise").unwrap();
    assert_eq!(advise["inputSchema"]["properties"]["band"]["default"], "5%");
    assert_eq!(advise["inputSchema"]["required"], json!([]));
    // As the call below gives them: a text alone is refused.
    for list in ["period", "bond", "on", "steps", "engine"] {
        assert_eq!(advise["inputSchema"]["properties"][list]["type"], "array", "{list}");
    }
    assert_eq!(all[2]["result"]["structuredContent"]["stable"], false);
    let told = all[3]["result"]["content"][0]["text"].as_str().unwrap();
    assert!(told.contains("advice: outer step 3 fs"), "{told}");
}

#[test]
fn what_is_no_question_is_refused_and_the_next_one_is_answered() {
    let lines = [
        "no JSON".to_string(),
        json!({"jsonrpc": "2.0", "id": 1}).to_string(),
        request(2, "resources/list", json!({})),
        call(3, "run", json!({})),
        call(4, "verdict", json!({"lambda1": "10"})),
        call(5, "half", json!({"ratio": "5/3", "s": "11/4", "rho": "0.04"})),
    ];
    let all = answers(&lines);
    let codes: Vec<_> = all.iter().map(|answer| answer["error"]["code"].as_i64()).collect();
    assert_eq!(codes, [Some(-32700), Some(-32600), Some(-32601), Some(-32602), None, None]);
    assert_eq!(all[4]["result"]["isError"], true);
    let told = all[4]["result"]["content"][0]["text"].as_str().unwrap();
    assert!(told.contains("missing: "), "{told}");
    assert!(all[5]["result"]["structuredContent"]["entries"].is_array(), "{}", all[5]);
}
