//! Run time against error, of the trace and of the verdict: `cargo bench --bench precision [-- DIRECTORY]`.
//!
//! Prints tables and writes precision.json and precision.svg (trace and verdict by every method) and
//! neighbours.svg (a naive verdict beside the certified one, double by double) into DIRECTORY,
//! target/precision unless given; with --redraw the figures alone, from the precision.json that is there.
//! Times are minima over repetitions; only those of one run compare.

#[path = "../common.rs"]
mod common;
#[path = "../dense.rs"]
mod dense;
mod figure;
mod methods;
mod neighbours;
mod others;
mod traces;
mod verdicts;

use std::path::PathBuf;

use kickdrift::plot::Figure;
use serde_json::json;

fn main() {
    let directory: PathBuf = std::env::args()
        .skip(1)
        .find(|argument| !argument.starts_with("--"))
        .map_or_else(|| PathBuf::from("target/precision"), PathBuf::from);
    std::fs::create_dir_all(&directory).expect("a directory to write to");
    let write = |name: &str, text: String| {
        let path = directory.join(name);
        std::fs::write(&path, text).expect("the directory can be written to");
        println!("{}", path.display());
    };
    let picture = neighbours::picture();
    let drawn = |figure: Figure| {
        figure
            .made_by(concat!("kickdrift ", env!("CARGO_PKG_VERSION")), "cargo bench --bench precision")
            .svg()
    };
    write("neighbours.svg", drawn(picture.figure.clone()));
    if std::env::args().any(|argument| argument == "--redraw") {
        let kept = std::fs::read_to_string(directory.join("precision.json")).expect("what was measured");
        let document = serde_json::from_str(&kept).expect("JSON");
        return write("precision.svg", drawn(figure::precision(&document)));
    }
    let traces = traces::measure();
    traces::print(&traces);
    let verdicts = verdicts::measure();
    verdicts::print(&verdicts);
    let (edges, systems) = (others::edges(), others::systems());
    others::print("edges of tongues: relative width of the enclosure", &edges);
    others::print(
        "multipliers of stable systems: distance from the unit circle, radius of proven discs",
        &systems,
    );
    let document = json!({
        "schema": "kickdrift/precision/1",
        "traces": traces.iter().map(traces::Row::json).collect::<Vec<_>>(),
        "verdicts": verdicts.json(),
        "edges": others::json(&edges),
        "systems": others::json(&systems),
        "neighbours": { "pairs": picture.pairs, "wrong": picture.wrong },
    });
    write("precision.svg", drawn(figure::precision(&document)));
    write("precision.json", serde_json::to_string_pretty(&document).expect("JSON") + "\n");
}
