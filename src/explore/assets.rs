//! The page itself, inside the program.

use std::sync::LazyLock;

use super::reply::Reply;

/// A file of the page.
macro_rules! page {
    ($name:literal) => {
        ($name, include_bytes!(concat!("page/", $name)))
    };
}

/// Scripts, each after those that it imports.
macro_rules! scripts {
    ($($name:literal)*) => { &[$(($name, include_str!(concat!("page/", $name)))),*] };
}

const FILES: &[(&str, &[u8])] = &[page!("index.html"), page!("icon.svg"), page!("page.css")];

const SCRIPTS: &[(&str, &str)] = scripts!(
    "address.js" "ask.js" "exact.js" "colours.js" "dom.js" "writing.js" "picking.js" "state.js" "grid.js" "view.js" "tiles.js"
    "vectors.js" "axes.js" "map.js" "input.js" "card.js" "plot.js" "drawer.js" "panels.js" "layout.js" "pairs.js" "acts.js"
    "main.js" "boot.js" "widget.js"
);

/// Scripts of one host alone.
const HOSTS: [&str; 2] = ["boot.js", "widget.js"];

/// The file at `path` below the page's address; the page itself at the empty path. All scripts are one
/// module: `page.js` mounts the page that was served, `explore.js` exports what another host mounts.
pub fn asset(path: &str) -> Option<Reply> {
    let path = if path.is_empty() { "index.html" } else { path };
    let media = match path.rsplit_once('.')?.1 {
        "html" => "text/html; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "svg" => "image/svg+xml",
        "otf" => "font/otf",
        _ => "text/javascript; charset=utf-8",
    };
    match path {
        "explore.js" => return Some(Reply::new(media, MODULE.as_bytes())),
        "page.js" => return Some(Reply::new(media, PAGE.as_bytes())),
        _ => {}
    }
    let page = || FILES.iter().find(|(name, _)| *name == path).map(|&(_, bytes)| bytes);
    // Fonts are those of the figures.
    let bytes = path.strip_prefix("fonts/").map_or_else(page, plot::font_file);
    bytes.map(|bytes| Reply::new(media, bytes))
}

/// The page with what it starts on inside, so that it need not ask for it.
pub(super) fn index(begun: &[u8]) -> Reply {
    const PLACE: &str = "id=\"begun\">";
    let index = include_str!("page/index.html");
    let at = index.find(PLACE).expect("a place for it") + PLACE.len();
    // Data in a script end at the first tag that closes one.
    let begun = String::from_utf8_lossy(begun).replace('<', "\\u003c");
    let whole = [&index[..at], &begun, &index[at..]].concat();
    Reply { bytes: whole.into_bytes().into(), ..asset("").expect("the page") }
}

/// The module for a host that has no addresses for files.
static MODULE: LazyLock<String> = LazyLock::new(|| {
    module("widget.js", "export const { mount } = $main;\nexport default { render: $widget.render };\n")
});

static PAGE: LazyLock<String> = LazyLock::new(|| module("boot.js", ""));

/// All scripts as one module, which takes a browser a single request: each becomes a function that returns
/// what it exported, imports take that apart.
fn module(host: &str, end: &str) -> String {
    let filter = SCRIPTS.iter().filter(|(name, _)| *name == host || !HOSTS.contains(name));
    filter.map(|(name, text)| enclosed(name, text)).chain([end.into()]).collect()
}

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
                assert!(SCRIPTS[..place].iter().any(|(text, _)| *text == from), "{name} imports {from}");
            }
        }
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/explore/page");
        let files = std::fs::read_dir(folder).unwrap();
        let names = files.map(|file| file.unwrap().file_name().into_string().unwrap());
        let kept = |name: &String| {
            FILES.iter().map(|pair| pair.0).chain(SCRIPTS.iter().map(|pair| pair.0)).any(|text| text == name)
        };
        assert_eq!(names.filter(|name| !kept(name)).collect::<Vec<_>>(), Vec::<String>::new());
    }

    #[test]
    fn one_module_exports_what_two_hosts_need() {
        let lines = |module: &str, word| module.lines().filter(|line| line.starts_with(word)).count();
        assert_eq!((lines(&MODULE, "import "), lines(&MODULE, "export ")), (0, 2));
        assert_eq!((lines(&PAGE, "import "), lines(&PAGE, "export ")), (0, 0));
        assert!(MODULE.contains("const $widget") && !MODULE.contains("const $boot"));
        assert!(PAGE.contains("const $boot") && !PAGE.contains("const $widget"));
        assert_eq!(exported("async function fetched(path) {"), "fetched");
    }

    #[test]
    fn what_the_page_starts_on_cannot_leave_its_place() {
        let page = index(br#"{"title": "</script><b>\u00e9"}"#);
        let text = String::from_utf8(page.bytes.into_owned()).unwrap();
        assert!(text.contains(r#">{"title": "\u003c/script>\u003cb>\u00e9"}</script>"#), "{text}");
    }

    #[test]
    fn families_have_the_colours_of_the_figures() {
        let rows = plot::palette::FAMILIES.map(|[l, c, h]| format!("[{l:.2}, {c}, {h}]"));
        let script = SCRIPTS.iter().find(|(name, _)| *name == "colours.js").unwrap().1;
        let mut rest = script.split_once("const FAMILIES = ").unwrap().1;
        for row in rows {
            rest = rest.split_once(&row).unwrap_or_else(|| panic!("{row} in its place")).1;
        }
        assert!(rest.starts_with(",\n];"), "no more than these");
    }
}
