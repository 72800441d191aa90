//! A drawing as SVG, with as few letters as possible: path data is relative, computed in integers, so that
//! nothing drifts.

use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::canvas::{Canvas, Element, HALO, Letters, MM, Paint, Patch, Path, Pen, Step, Words, hundredths};
use super::clip::Rect;
use super::embed::Fonts;
use super::font::{Curve, Face};
use super::palette::WHITE;

/// The whole document, on white paper.
pub(crate) fn document(canvas: &Canvas) -> String {
    let (w, h) = (number(canvas.width), number(canvas.height));
    let (w_mm, h_mm) = (number(canvas.width / MM), number(canvas.height / MM));
    let is_outlined = canvas.letters != Letters::Text;
    let letters = if is_outlined { "" } else { SERIF };
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" \
         width=\"{w_mm}mm\" height=\"{h_mm}mm\" viewBox=\"0 0 {w} {h}\"{letters}>\n<title>{}</title>\n",
        escaped(&canvas.title)
    );
    if let Some([program, command]) = &canvas.maker {
        out.push_str(&format!("<metadata>{program}: {}</metadata>\n", escaped(command)));
    }
    out.push_str("<defs>\n");
    if is_outlined {
        for (face, glyph) in canvas.glyphs() {
            let (name, data) = (glyph_name(face, glyph), outline(face, glyph));
            out.push_str(&format!("<path id=\"{name}\" d=\"{data}\"/>\n"));
        }
    } else {
        Fonts::new(canvas).files().for_each(|(face, bytes)| out.push_str(&font(face, &bytes)));
    }
    out.push_str(&format!("</defs>\n<rect width=\"{w}\" height=\"{h}\" fill=\"{WHITE}\"/>\n"));
    let mut clips = 0;
    for element in &canvas.elements {
        out.push_str(&match element {
            Element::Path(path, paint) => format!("<path {} d=\"{}\"/>", attributes(paint), data(path)),
            Element::Patch(rect) => filled(rect),
            Element::Words(words) if is_outlined => shapes(words),
            Element::Words(words) => text(words),
            Element::Open(frame) => {
                clips += 1;
                clipped(clips, frame)
            }
            Element::Close => "</g>".into(),
        });
        out.push('\n');
    }
    out.push_str("</svg>\n");
    out
}

/// A number with at most two decimals and no letter to spare.
fn number(value: f64) -> String {
    let mut text = String::new();
    put(&mut text, hundredths(value));
    text
}

fn put(text: &mut String, value: i64) {
    let (whole, part) = (value.unsigned_abs() / 100, value.unsigned_abs() % 100);
    if value < 0 {
        text.push('-');
    }
    if whole > 0 || part == 0 {
        write!(text, "{whole}").expect("writing to a String does not fail");
    }
    if part > 0 {
        let digits = format!(".{part:02}");
        text.push_str(digits.trim_end_matches('0'));
    }
}

/// Path data; a pair of numbers repeats the command before it, and behind a move it is a line.
fn data(path: &Path) -> String {
    let (mut data, mut at, mut implied) = (String::new(), (0, 0), ' ');
    for &step in &path.steps {
        match step {
            Step::Move(x, y) | Step::Line(x, y) => {
                let command = if matches!(step, Step::Move(..)) { 'm' } else { 'l' };
                let (dx, dy) = (x - at.0, y - at.1);
                if implied != command {
                    data.push(command);
                } else if dx >= 0 {
                    data.push(' ');
                }
                put(&mut data, dx);
                if dy >= 0 {
                    data.push(' ');
                }
                put(&mut data, dy);
                (at, implied) = ((x, y), 'l');
            }
            Step::Across(x) => {
                data.push('h');
                put(&mut data, x - at.0);
                (at.0, implied) = (x, 'h');
            }
            Step::Along(y) => {
                data.push('v');
                put(&mut data, y - at.1);
                (at.1, implied) = (y, 'v');
            }
            Step::Dot => {
                data.push_str("h0");
                implied = 'h';
            }
            Step::Close(x, y) => {
                data.push('z');
                (at, implied) = ((x, y), 'z');
            }
        }
    }
    data
}

fn attributes(paint: &Paint) -> String {
    match paint {
        Paint::Cells(colour) => format!("fill=\"{colour}\""),
        Paint::Fill { colour, opacity } => format!("fill=\"{colour}\"{}", veil(*opacity)),
        Paint::Stroke(Pen { colour, width, round_joins, round_caps, dashes }) => {
            let joins = if *round_joins { " stroke-linejoin=\"round\"" } else { "" };
            let caps = if *round_caps { " stroke-linecap=\"round\"" } else { "" };
            let lengths: Vec<String> = dashes.iter().map(|&length| number(length)).collect();
            let dashes = match lengths.join(" ") {
                none if none.is_empty() => none,
                lengths => format!(" stroke-dasharray=\"{lengths}\""),
            };
            let width = number(*width);
            format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"{joins}{caps}{dashes}")
        }
    }
}

fn veil(opacity: Option<f64>) -> String {
    opacity.map_or_else(String::new, |opacity| format!(" fill-opacity=\"{}\"", number(opacity)))
}

fn place(x: f64, y: f64, width: f64, height: f64) -> String {
    let [x, y, width, height] = [x, y, width, height].map(number);
    format!("x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"")
}

fn filled(&Patch { x, y, width, height, colour }: &Patch) -> String {
    format!("<rect {} fill=\"{colour}\"/>", place(x, y, width, height))
}

fn clipped(clips: usize, [left, top, right, bottom]: &Rect) -> String {
    let frame = place(*left, *top, right - left, bottom - top);
    format!("<clipPath id=\"box{clips}\"><rect {frame}/></clipPath>\n<g clip-path=\"url(#box{clips})\">")
}

/// The letters' family, and that spaces count: each letter has its place.
const SERIF: &str = " font-family=\"Libertinus Serif, Linux Libertine O, serif\" xml:space=\"preserve\"";

/// A face as a rule of CSS.
fn font(face: Face, bytes: &[u8]) -> String {
    let (style, weight) = look(face);
    format!(
        "<style>@font-face{{font-family:\"Libertinus Serif\";font-style:{style};font-weight:{weight};\
         src:url(data:font/otf;base64,{})}}</style>\n",
        STANDARD.encode(bytes)
    )
}

fn look(face: Face) -> (&'static str, u16) {
    match face {
        Face::Roman => ("normal", 400),
        Face::Italic => ("italic", 400),
        Face::Semibold => ("normal", 600),
        Face::SemiboldItalic => ("italic", 600),
    }
}

/// Words as words: each letter where the layout has it, whatever font a reader has.
fn text(words: &Words) -> String {
    let (set, [x, y]) = (words.set, words.at);
    let em = set.size / 1000.0;
    let mut pieces = String::new();
    for (letters, run) in words.runs() {
        let places: Vec<String> = run.iter().map(|placed| number(x + em * words.offset(placed)[0])).collect();
        let base = number(y + em * words.offset(&run[0])[1]);
        pieces += &format!("<tspan x=\"{}\" y=\"{base}\"", places.join(" "));
        pieces += match look(run[0].face) {
            ("normal", 400) => "",
            ("normal", _) => " font-weight=\"600\"",
            (_, 400) => " font-style=\"italic\"",
            _ => " font-style=\"italic\" font-weight=\"600\"",
        };
        if run[0].scale != 1.0 {
            pieces += &format!(" font-size=\"{}\"", number(set.size * run[0].scale));
        }
        pieces += &format!(">{}</tspan>", escaped(&letters));
    }
    let mut out = format!("<text font-size=\"{}\" fill=\"{}\"", number(set.size), set.colour);
    if set.halo {
        let width = number(em * HALO);
        out += &format!(
            " stroke=\"{WHITE}\" stroke-width=\"{width}\" stroke-linejoin=\"round\" paint-order=\"stroke\""
        );
    }
    if set.turn != 0.0 {
        out += &format!(" transform=\"rotate({} {} {})\"", number(-set.turn), number(x), number(y));
    }
    format!("{out}>{pieces}</text>")
}

/// Words as shapes.
fn shapes(words: &Words) -> String {
    let mut uses = String::new();
    for placed in &words.glyphs {
        let [x, y] = words.offset(placed).map(number);
        let scaled = if placed.scale == 1.0 { String::new() } else { format!(" scale({})", placed.scale) };
        let name = glyph_name(placed.face, placed.glyph);
        uses.push_str(&format!("<use xlink:href=\"#{name}\" transform=\"translate({x} {y}){scaled}\"/>"));
    }
    let set = words.set;
    let [x, y] = words.at.map(number);
    let turn = if set.turn == 0.0 { String::new() } else { format!(" rotate({})", number(-set.turn)) };
    // Glyphs are drawn in units of 1/1000 em.
    let frame = format!("transform=\"translate({x} {y}){turn} scale({})\"", set.size / 1000.0);
    let rim =
        format!("fill=\"{WHITE}\" stroke=\"{WHITE}\" stroke-width=\"{HALO}\" stroke-linejoin=\"round\"");
    let halo =
        if set.halo { format!("<g aria-hidden=\"true\" {rim} {frame}>{uses}</g>\n") } else { String::new() };
    let (name, colour) = (escaped(&words.words), set.colour);
    format!("{halo}<g role=\"img\" aria-label=\"{name}\" fill=\"{colour}\" {frame}>{uses}</g>")
}

fn glyph_name(face: Face, glyph: u16) -> String {
    format!("{}{glyph}", face.prefix())
}

/// A glyph as path data in units of 1/1000 em.
fn outline(face: Face, glyph: u16) -> String {
    let mut data = String::new();
    let mut step = |command: char, points: &[[i32; 2]]| {
        data.push(command);
        for (i, number) in points.as_flattened().iter().enumerate() {
            let gap = if i > 0 && *number >= 0 { " " } else { "" };
            write!(data, "{gap}{number}").expect("writing to a String does not fail");
        }
    };
    for curve in face.outline(glyph) {
        match curve {
            Curve::Move(to) => step('M', &[to]),
            Curve::Line(to) => step('L', &[to]),
            Curve::Quad(control, to) => step('Q', &[control, to]),
            Curve::Cubic(first, second, to) => step('C', &[first, second, to]),
            Curve::Close => step('Z', &[]),
        }
    }
    data
}

/// Text that may stand in an attribute or between tags; control letters are no XML and become spaces.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            control if control.is_control() => out.push(' '),
            plain => out.push(plain),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let shown = [0.0, -0.001, 0.5, -0.5, 1.0, 12.345, 100.0, -7.1].map(number);
        assert_eq!(shown, ["0", "0", ".5", "-.5", "1", "12.35", "100", "-7.1"]);
        assert_eq!(number(f64::NAN), "0");
    }

    #[test]
    fn paths_are_relative_and_do_not_drift() {
        let mut path = Path::default();
        path.move_to([1.0, 2.0]);
        path.line_to([1.0, 2.001]);
        for i in 1..=3 {
            path.line_to([1.0 + f64::from(i) / 3.0, 2.0]);
        }
        path.move_to([2.0, 1.0]);
        path.vertical([0.0, 0.0], 5.0);
        path.dot([1.0, 1.0]);
        assert_eq!(data(&path), "m1 2 .33 0 .34 0 .33 0m0-1m-2-1v5m1-4h0");
    }

    #[test]
    fn words_are_escaped() {
        assert_eq!(escaped("a<b & \"c\"\u{1}"), "a&lt;b &amp; &quot;c&quot; ");
    }
}
