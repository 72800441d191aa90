//! Figures as a whole: what a tiny one looks like to the byte, and that larger ones hold together.

use kickdrift::plot::palette::{
    CAUTION, COEXISTENCE, Colour, GREY, Gradient, HYPERBOLIC, INK, PARABOLIC, SAFE, SAMPLED, UNSTABLE, WHITE,
    family,
};
use kickdrift::plot::{
    Axis, Cells, ColourBar, Figure, Foot, Hatch, Layer, Note, Panel, Place, Shape, Stroke,
};

/// One panel with one of everything that is small.
fn tiny() -> Figure {
    let panel = Panel::new(Axis::linear("*h*_1", 0.0, 1.0), Axis::linear("*y*", 0.0, 2.0))
        .titled("Tiny")
        .with(Layer::lines(vec![vec![[0.0, -1.0], [1.0, 3.0]]], Stroke::DASHED).labelled("line"))
        .with(Layer::dots(vec![[0.5, 0.5], [7.0, 0.5]], Shape::Disc, 2.0, family(0)))
        .legend(Place::Above);
    Figure::new(40.0, 30.0).named("A tiny figure").with(panel)
}

#[test]
fn a_tiny_figure_is_the_same_to_the_byte() {
    let golden = include_str!("figures/tiny.svg");
    let svg = tiny().svg();
    if svg != golden {
        let found = std::env::temp_dir().join("kickdrift-tiny.svg");
        std::fs::write(&found, &svg).unwrap();
        panic!("the tiny figure changed: compare tests/documents/figures/tiny.svg with {}", found.display());
    }
}

/// Size, and the share of pixels that are not white, of a PNG file.
fn inspected(bytes: &[u8]) -> (u32, u32, f64) {
    let mut reader = ::png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    let inked = pixels.chunks(3).filter(|rgb| rgb.iter().any(|&c| c < 250)).count();
    (info.width, info.height, inked as f64 / (f64::from(info.width) * f64::from(info.height)))
}

#[test]
fn the_png_has_the_size_asked_for_and_ink_on_it() {
    for (dpi, width, height) in [(25.4, 40, 30), (254.0, 400, 300), (508.0, 800, 600)] {
        let (w, h, ink) = inspected(&tiny().png(dpi).unwrap());
        assert_eq!((w, h), (width, height));
        assert!((0.03..0.5).contains(&ink), "{ink} of the paper is inked");
    }
}

#[test]
fn a_resolution_that_cannot_be_is_refused() {
    for dpi in [0.0, -300.0, f64::NAN, f64::INFINITY, 1e9] {
        assert_eq!(tiny().png(dpi), None, "{dpi}");
    }
}

/// All layers, numbers from nowhere: nothing may panic, and the result is an SVG that can be drawn.
#[test]
fn strange_data_still_makes_a_figure() {
    let strange = [f64::NAN, f64::INFINITY, -1e308, 1e308, 0.0, -0.0, 1e-320];
    let points: Vec<[f64; 2]> = strange.iter().flat_map(|&x| strange.map(|y| [x, y])).collect();
    let mut cells = Cells::new([0.0, 0.0], [f64::MIN_POSITIVE, 1e300], Gradient::on_white().steps(3));
    cells.push(u32::MAX - 1, 0, 2);
    for (x, y) in [
        (Axis::linear("", 0.0, 0.0), Axis::log("", -1.0, f64::NAN)),
        (Axis::log("*_^{", 1e-300, 1e300), Axis::linear("", -1e308, 1e308)),
    ] {
        let panel = Panel::new(x, y)
            .titled("<&\"\u{0}")
            .with(Layer::lines(vec![points.clone(), vec![]], Stroke::DOTTED).labelled("lines"))
            .with(Layer::dots(points.clone(), Shape::Cross, 3.0, family(1)).labelled("dots"))
            .with(Layer::areas(vec![points.clone(), vec![]], family(2), 0.5).labelled("areas"))
            .with(Layer::cells(cells.clone()).labelled("cells"))
            .note(Note::new([f64::NAN, 1.0], "nowhere"))
            .bar(
                ColourBar::new(Axis::log("bar", 1e-6, 1.0), Gradient::on_white())
                    .over([0.0, 9.0].into_iter()),
            )
            .legend(Place::Above)
            .gridded();
        let figure = Figure::new(60.0, 50.0).with(panel.clone()).with(panel).columns(1);
        let svg = figure.svg();
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "a number got lost");
        figure.png(72.0).unwrap();
    }
}

#[test]
fn a_figure_without_panels_is_blank_paper() {
    let (_, _, ink) = inspected(&Figure::new(85.0, 20.0).png(72.0).unwrap());
    assert_eq!(ink, 0.0);
}

#[test]
fn a_bar_gives_each_value_the_colour_beside_its_number() {
    let bar = ColourBar::new(Axis::log("rate", 1e-4, 1.0), Gradient::on_white());
    assert_eq!(bar.colour(1e-2), Gradient::on_white().at(0.5));
    assert_eq!([1e-9, 1e-4, 1.1e-2, 1.0, 9.0, 0.0].map(|rate| bar.class(rate, 8)), [0, 0, 4, 7, 7, 0]);
}

#[test]
fn the_pdf_has_the_size_asked_for_and_its_letters_can_be_searched() {
    let pdf = tiny().pdf();
    assert_eq!(pdf, tiny().pdf());
    let text = String::from_utf8_lossy(&pdf);
    assert!(text.starts_with("%PDF-1.5") && text.trim_end().ends_with("%%EOF"));
    // 40 and 30 mm in points.
    assert!(text.contains("/MediaBox [0 0 113.385826 85.03937]"), "{text}");
    for letter in "Tinyleh01".chars() {
        let meaning = format!("<{:04X}>", u32::from(letter));
        assert!(text.contains(&meaning), "{letter} has no meaning");
    }
    assert_eq!(text.matches("/Subtype /CIDFontType0C").count(), 3, "roman, italic, semibold");
}

#[test]
fn strange_letters_make_a_sound_pdf() {
    let panel = Panel::new(Axis::linear("\u{10ffff} *x* Ж", 0.0, 1.0), Axis::linear("", 0.0, 1.0))
        .with(Layer::areas(vec![vec![[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]]], family(2), 0.5))
        .note(Note::new([0.5, 0.5], "note"));
    let pdf = Figure::new(60.0, 50.0).named("(a\\b)").with(panel).pdf();
    let text = String::from_utf8_lossy(&pdf);
    for piece in ["/ca 0.5", "<DBFFDFFF>", "<0416>"] {
        assert!(text.contains(piece), "no {piece} in {text}");
    }
}

/// Dark cells, each beside neighbours of other colours: four columns, three rows.
fn patchwork() -> Figure {
    let mut cells = Cells::new([0.5, 0.5], [1.0, 1.0], Gradient::on_white().steps(24).split_off(12));
    (0..12).for_each(|n| cells.push(n % 4, n / 4, (7 * n % 12) as u16));
    let axes = (Axis::linear("", 0.0, 4.0), Axis::linear("", 0.0, 3.0));
    Figure::new(31.0, 29.0).with(Panel::new(axes.0, axes.1).with(Layer::cells(cells)))
}

/// Where cells meet, what is drawn lies between their colours, at resolutions that cut pixels anywhere: no
/// paper shows.
#[test]
fn cells_have_no_seams() {
    let limit = Gradient::on_white().steps(24)[12..].iter().map(|own| own.1).max().unwrap();
    for dpi in [61.0, 96.0, 131.7, 150.3] {
        let bytes = patchwork().png(dpi).unwrap();
        let mut reader = ::png::Decoder::new(std::io::Cursor::new(&bytes[..])).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let (wide, high) =
            reader.next_frame(&mut pixels).map(|info| (info.width as usize, info.height as usize)).unwrap();
        // Away from the frame, which is grey where a pixel is cut, all is cells.
        let inner = |n: &usize| {
            (wide / 6..wide - wide / 5).contains(&(n % wide))
                && (high / 6..high - high / 5).contains(&(n / wide))
        };
        let lightest = (0..wide * high).filter(inner).map(|n| pixels[3 * n + 1]).max().unwrap();
        assert!(lightest <= limit, "{dpi} dpi: green {lightest} where no cell has more than {limit}");
    }
}

#[test]
fn the_words_of_an_svg_are_shapes_unless_text_is_asked_for() {
    let figure = tiny().headed("*h*_1 & more").footed(&Foot::default().part("made of *λ*_2".into()));
    let svg = figure.clone().in_text().svg();
    // The heading stands in the place of the title of a single panel.
    assert!(!svg.contains(">Tiny</tspan>"));
    for words in [">line</tspan>", ">h</tspan>", "> &amp; more</tspan>", ">made of </tspan>", ">λ</tspan>"] {
        assert!(svg.contains(words), "no {words} in {svg}");
    }
    assert!(svg.contains("<title>h1 &amp; more</title>") && svg.contains("data:font/otf;base64,"));
    assert!(!svg.contains("<use ") && !svg.contains("<path id="));
    let svg = figure.svg();
    assert!(svg.contains("aria-label=\"line\"") && svg.contains("<use "));
    assert!(!svg.contains("<text") && !svg.contains("font"));
}

/// The streams of a PDF, inflated where they are packed.
fn streams(pdf: &[u8]) -> Vec<Vec<u8>> {
    let find = |from: usize, what: &[u8]| {
        pdf[from..].windows(what.len()).position(|own| own == what).map(|n| from + n)
    };
    let (mut found, mut at) = (Vec::new(), 0);
    while let Some(begin) = find(at, b"\nstream\n").map(|n| n + 8) {
        let end = find(begin, b"\nendstream").unwrap();
        let mut bytes = Vec::new();
        let packed =
            std::io::Read::read_to_end(&mut flate2::read::ZlibDecoder::new(&pdf[begin..end]), &mut bytes);
        found.push(if packed.is_ok() { bytes } else { pdf[begin..end].to_vec() });
        at = end;
    }
    found
}

/// The words of a PDF as a reader finds them: what the fonts' tables say of the glyphs shown, font by font in
/// the order of their names, a line for each piece.
fn extracted(pdf: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(pdf);
    let named = regex_lite::Regex::new(r"/(f[rist]) (\d+) 0 R").unwrap();
    let maps: Vec<Vec<u8>> = streams(pdf).into_iter().filter(|own| own.starts_with(b"%!PS-Adobe")).collect();
    // The tables stand in the order of their fonts.
    let mut fonts: Vec<(u32, String)> =
        named.captures_iter(&text).map(|own| (own[2].parse().unwrap(), own[1].to_string())).collect();
    fonts.sort();
    let pair = regex_lite::Regex::new(r"<([0-9A-F]{4})> <([0-9A-F]{4})>\n").unwrap();
    let meaning = |font: &str, glyph: u16| -> char {
        let place = fonts.iter().position(|(_, name)| name == font).unwrap();
        let map = String::from_utf8_lossy(&maps[place]).to_string();
        let map = map.split("beginbfchar").nth(1).unwrap().to_string();
        let number = |text: &str| u32::from_str_radix(text, 16).unwrap();
        let own = pair.captures_iter(&map).find(|own| number(&own[1]) == u32::from(glyph)).unwrap();
        char::from_u32(number(&own[2])).unwrap()
    };
    let page = streams(pdf).into_iter().find(|own| own.windows(3).any(|three| three == b"BT\n")).unwrap();
    let page: String = page.into_iter().map(char::from).collect();
    let shown = regex_lite::Regex::new(r"(?s)/(f[rist]) [0-9.]+ Tf\n\[(.*?)\] TJ\n").unwrap();
    // Strings in parentheses; letters that would end them, or are none, behind a backslash.
    let string = regex_lite::Regex::new(r"(?s)\(((?:\\.|[^\\)])*)\)").unwrap();
    let letter = regex_lite::Regex::new(r"(?s)\\([0-7]{3})|\\(.)|(.)").unwrap();
    let byte = |own: regex_lite::Captures| match (own.get(1), own.get(2), own.get(3)) {
        (Some(octal), ..) => u16::from_str_radix(octal.as_str(), 8).unwrap(),
        (_, Some(named), _) => match named.as_str() {
            "n" => 10,
            "r" => 13,
            "t" => 9,
            "b" => 8,
            "f" => 12,
            other => other.chars().next().unwrap() as u16,
        },
        (.., plain) => plain.unwrap().as_str().chars().next().unwrap() as u16,
    };
    let line = |own: regex_lite::Captures| {
        let text: String = string.captures_iter(&own[2]).map(|part| part[1].to_string()).collect();
        let bytes: Vec<u16> = letter.captures_iter(&text).map(byte).collect();
        bytes.chunks(2).map(|pair| meaning(&own[1], pair[0] << 8 | pair[1])).collect()
    };
    shown.captures_iter(&page).map(line).collect()
}

#[test]
fn the_words_of_a_pdf_can_be_extracted_unless_shapes_are_asked_for() {
    let found = extracted(&tiny().headed("All *tongues*").pdf());
    for words in ["All ", "tongues", "line", "h", "1", "0"] {
        assert!(found.iter().any(|own| own == words), "no {words} in {found:?}");
    }
    let text = String::from_utf8_lossy(&tiny().outlined().pdf()).to_string();
    assert!(!text.contains("/Type0") && !text.contains("ToUnicode"));
}

#[test]
fn a_figure_takes_the_width_and_the_unit_asked_for() {
    let axes = (Axis::linear("*h*_1", 0.0, 1.0).of_time(), Axis::log("growth", 0.1, 1.0).per_time());
    let figure = Figure::new(160.0, 80.0).with(Panel::new(axes.0, axes.1)).wide(85.0);
    let svg = figure.svg();
    let shows = |svg: &str, words: &str| svg.contains(&format!("aria-label=\"{words}\""));
    assert!(figure.has_time() && !tiny().has_time());
    // Half as high would be too low for a row: 45 mm at least.
    assert!(
        svg.contains("width=\"85mm\" height=\"45mm\"")
            && shows(&svg, "h1 (time)")
            && shows(&svg, "growth (1/time)")
    );
    let svg = figure.in_units_of("fs").headed("A").svg();
    assert!(shows(&svg, "h1 (fs)") && shows(&svg, "growth (1/fs)"), "{svg}");
    assert!(!svg.contains("height=\"45mm\""), "a heading takes no room from the panels");
    assert!(tiny().wide(80.0).svg().contains("width=\"80mm\" height=\"60mm\""));
}

/// Linear sRGB to OKLab (Ottosson 2020): distances are as large as they look.
fn oklab([r, g, b]: [f64; 3]) -> [f64; 3] {
    let cone = |x: f64, y: f64, z: f64| (x * r + y * g + z * b).cbrt();
    let l = cone(0.4122214708, 0.5363325363, 0.0514459929);
    let m = cone(0.2119034982, 0.6806995451, 0.1073969566);
    let s = cone(0.0883024619, 0.2817188376, 0.6299787005);
    [
        0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
        1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
        0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s,
    ]
}

fn linear(Colour(r, g, b): Colour) -> [f64; 3] {
    [r, g, b]
        .map(f64::from)
        .map(|c| c / 255.0)
        .map(|c| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) })
}

fn seen_through(matrix: [[f64; 3]; 3], colour: Colour) -> [f64; 3] {
    let rgb = linear(colour);
    oklab(matrix.map(|row| row.iter().zip(rgb).map(|(m, c)| m * c).sum::<f64>().clamp(0.0, 1.0)))
}

/// As eyes without green cones see it, and without red ones: Machado, Oliveira and Fernandes, IEEE
/// Transactions on Visualization and Computer Graphics 15 (2009) 1291, severity 1.0.
const DEUTERANOPIA: [[f64; 3]; 3] =
    [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]];
const PROTANOPIA: [[f64; 3]; 3] =
    [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]];
/// As a printer without colour does: relative luminance (ITU-R BT.709).
const PRINT: [[f64; 3]; 3] = [[0.2126, 0.7152, 0.0722]; 3];

fn least_distance(colours: &[Colour], matrix: [[f64; 3]; 3]) -> f64 {
    let pairs = colours.iter().enumerate().flat_map(|(n, a)| colours[..n].iter().map(move |b| (*a, *b)));
    let distance = |(a, b)| {
        let [a, b] = [a, b].map(|own| seen_through(matrix, own));
        (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
    };
    pairs.map(distance).fold(f64::INFINITY, f64::min)
}

/// 0.02 in OKLab is just noticeable side by side. Colours that carry a meaning are three times as far apart
/// for the colour-blind, and twice in grey, where marks and dashes differ besides.
#[test]
fn colours_with_a_meaning_stay_apart_for_the_colour_blind_and_in_grey() {
    let families: Vec<Colour> = (0..8).map(family).collect();
    let kinds = [HYPERBOLIC, PARABOLIC, COEXISTENCE, WHITE];
    let lines = [INK, GREY, WHITE];
    let advice = [SAFE, CAUTION, SAMPLED, UNSTABLE, WHITE];
    for colours in [&families[..], &kinds, &lines, &advice] {
        for matrix in [DEUTERANOPIA, PROTANOPIA] {
            let least = least_distance(colours, matrix);
            assert!(least > 0.06, "{least}: {colours:?}");
        }
        let least = least_distance(colours, PRINT);
        assert!(least > 0.04, "in grey {least}: {colours:?}");
    }
}

/// What has a hatch has one of its own: families in a map are told without any colour.
#[test]
fn families_differ_in_their_hatch_and_every_format_draws_it() {
    let hatches: std::collections::HashSet<_> = (0..8).map(Hatch::of_family).collect();
    assert_eq!(hatches.len(), 8);
    let drawn = |hatch| {
        let mut cells = Cells::new([0.5, 0.5], [1.0, 1.0], vec![family(2)]);
        (0..12).for_each(|n| cells.push(n % 4, n / 4, 0));
        let axes = (Axis::linear("", 0.0, 4.0), Axis::linear("", 0.0, 3.0));
        let layer = Layer::cells(cells).hatched(hatch).labelled("family");
        Figure::new(40.0, 30.0).with(Panel::new(axes.0, axes.1).with(layer).legend(Place::Above))
    };
    let (plain, hatched) = (drawn(None), drawn(Some(Hatch::Falling)));
    let white = |figure: &Figure| figure.svg().matches("stroke=\"#ffffff\"").count();
    assert_eq!((white(&plain), white(&hatched)), (0, 2), "the cells and their sample in the legend");
    assert_ne!(plain.pdf(), hatched.pdf());
    assert_ne!(plain.png(72.0).unwrap(), hatched.png(72.0).unwrap());
}

/// The lightness of a gradient falls for every eye; a tenth of it is more than just noticeable.
#[test]
fn gradients_keep_their_order_for_the_colour_blind_and_in_grey() {
    for matrix in [DEUTERANOPIA, PROTANOPIA, PRINT] {
        let steps = Gradient::on_white().steps(11).into_iter();
        let light: Vec<f64> = steps.map(|own| seen_through(matrix, own)[0]).collect();
        let least = light.windows(2).map(|pair| pair[0] - pair[1]).fold(f64::INFINITY, f64::min);
        assert!(least > 0.02, "{least}: {light:?}");
    }
}
