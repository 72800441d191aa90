//! The page itself, inside the program.

use super::reply::Reply;

/// A file of the page.
macro_rules! page {
    ($name:literal, $media:literal) => {
        ($name, $media, include_bytes!(concat!("page/", $name)))
    };
}

/// A face that the figures are set in.
macro_rules! font {
    ($name:literal) => {
        (concat!("fonts/", $name), "font/otf", include_bytes!(concat!("../report/figure/fonts/", $name)))
    };
}

const FILES: &[(&str, &str, &[u8])] = &[
    page!("index.html", "text/html; charset=utf-8"),
    page!("address.js", "text/javascript; charset=utf-8"),
    page!("ask.js", "text/javascript; charset=utf-8"),
    page!("axes.js", "text/javascript; charset=utf-8"),
    page!("boot.js", "text/javascript; charset=utf-8"),
    page!("card.js", "text/javascript; charset=utf-8"),
    page!("colours.js", "text/javascript; charset=utf-8"),
    page!("dom.js", "text/javascript; charset=utf-8"),
    page!("drawer.js", "text/javascript; charset=utf-8"),
    page!("exact.js", "text/javascript; charset=utf-8"),
    page!("icon.svg", "image/svg+xml"),
    page!("input.js", "text/javascript; charset=utf-8"),
    page!("layout.js", "text/javascript; charset=utf-8"),
    page!("main.js", "text/javascript; charset=utf-8"),
    page!("map.js", "text/javascript; charset=utf-8"),
    page!("page.css", "text/css; charset=utf-8"),
    page!("panels.js", "text/javascript; charset=utf-8"),
    page!("picking.js", "text/javascript; charset=utf-8"),
    page!("plot.js", "text/javascript; charset=utf-8"),
    page!("tiles.js", "text/javascript; charset=utf-8"),
    page!("vectors.js", "text/javascript; charset=utf-8"),
    page!("view.js", "text/javascript; charset=utf-8"),
    page!("writing.js", "text/javascript; charset=utf-8"),
    font!("LibertinusSerif-Regular.otf"),
    font!("LibertinusSerif-Italic.otf"),
    font!("LibertinusSerif-Semibold.otf"),
];

/// The file at `path` below the page's address; the page itself at the empty path.
pub fn asset(path: &str) -> Option<Reply> {
    let path = if path.is_empty() { "index.html" } else { path };
    FILES.iter().find(|(name, ..)| *name == path).map(|&(_, media, bytes)| Reply::new(media, bytes))
}
