//! The page itself, inside the program.

use std::sync::LazyLock;

use super::reply::Reply;

/// A file of the page.
macro_rules! page {
    ($name:literal) => {
        ($name, include_bytes!(concat!("page/", $name)))
    };
}

/// A face that the figures are set in.
macro_rules! font {
    ($name:literal) => {
        (concat!("fonts/", $name), include_bytes!(concat!("../report/figure/fonts/", $name)))
    };
}

/// Scripts, each after those that it imports.
macro_rules! scripts {
    ($($name:literal)*) => { &[$(($name, include_str!(concat!("page/", $name)))),*] };
}

const FILES: &[(&str, &[u8])] = &[
    page!("index.html"),
    page!("boot.js"),
    page!("icon.svg"),
    page!("page.css"),
    font!("LibertinusSerif-Regular.otf"),
    font!("LibertinusSerif-Italic.otf"),
    font!("LibertinusSerif-Semibold.otf"),
];

const SCRIPTS: &[(&str, &str)] = scripts!(
    "address.js" "ask.js" "exact.js" "colours.js" "dom.js" "writing.js" "picking.js" "state.js" "grid.js" "view.js" "tiles.js"
    "vectors.js" "axes.js" "map.js" "input.js" "card.js" "plot.js" "drawer.js" "panels.js" "layout.js" "pairs.js" "acts.js"
    "main.js" "widget.js"
);

/// The file at `path` below the page's address, `explore.js` all scripts as one module; the page itself at the empty path.
pub fn asset(path: &str) -> Option<Reply> {
    let path = if path.is_empty() { "index.html" } else { path };
    let media = match path.rsplit_once('.')?.1 {
        "html" => "text/html; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "svg" => "image/svg+xml",
        "otf" => "font/otf",
        _ => "text/javascript; charset=utf-8",
    };
    if path == "explore.js" {
        return Some(Reply::new(media, MODULE.as_bytes()));
    }
    FILES.iter().find(|(name, _)| *name == path).map(|&(_, bytes)| Reply::new(media, bytes))
}

/// All scripts as one module, which a host that has no addresses for files can load, and a browser with a single request:
/// each becomes a function that returns what it exported, imports take that apart.
static MODULE: LazyLock<String> = LazyLock::new(|| {
    let scripts: String = SCRIPTS.iter().map(|(name, text)| enclosed(name, text)).collect();
    format!("{scripts}export const {{ mount }} = $main;\nexport default {{ render: $widget.render }};\n")
});

fn enclosed(name: &str, text: &str) -> String {
    let (mut body, mut exports) = (String::new(), Vec::new());
    for line in text.lines() {
        if let Some((names, from)) =
            line.strip_prefix("import ").and_then(|line| line.split_once(" from \"./"))
        {
            body += &format!("const {names} = ${};\n", from.trim_end_matches(".js\";"));
        } else if let Some(declared) = line.strip_prefix("export ") {
            exports.push(exported(declared));
            body += &format!("{declared}\n");
        } else {
            body += &format!("{line}\n");
        }
    }
    format!(
        "const ${} = (() => {{\n{body}return {{ {} }};\n}})();\n",
        name.trim_end_matches(".js"),
        exports.join(", ")
    )
}

/// The name that a declaration gives.
fn exported(declaration: &str) -> &str {
    let words = ["async ", "function ", "class ", "const "];
    let name = words.iter().fold(declaration, |rest, word| rest.strip_prefix(word).unwrap_or(rest));
    name.split(|c: char| !c.is_alphanumeric()).next().unwrap_or(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_script_stands_after_those_that_it_imports() {
        for (place, (name, text)) in SCRIPTS.iter().enumerate() {
            for line in text.lines().filter(|line| line.contains(" from \"./")) {
                let from = line.split("\"./").nth(1).unwrap().trim_end_matches("\";");
                assert!(SCRIPTS[..place].iter().any(|(own, _)| *own == from), "{name} imports {from}");
            }
        }
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/explore/page");
        let files = std::fs::read_dir(folder).unwrap();
        let names = files.map(|file| file.unwrap().file_name().into_string().unwrap());
        let kept = |name: &String| {
            FILES.iter().map(|own| own.0).chain(SCRIPTS.iter().map(|own| own.0)).any(|own| own == name)
        };
        assert_eq!(names.filter(|name| !kept(name)).collect::<Vec<_>>(), Vec::<String>::new());
    }

    #[test]
    fn one_module_exports_what_two_hosts_need() {
        let lines = |word| MODULE.lines().filter(|line| line.starts_with(word)).count();
        assert_eq!((lines("import "), lines("export ")), (0, 2));
        assert_eq!(exported("async function fetched(path) {"), "fetched");
    }
}
