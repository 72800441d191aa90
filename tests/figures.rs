//! Figures as a whole: what a tiny one looks like to the byte, and that larger ones hold together.

use kickdrift::report::figure::palette::{Gradient, family};
use kickdrift::report::figure::{
    Axis, Cells, ColourBar, Figure, Layer, Note, Panel, Picture, Place, Shape, Stroke,
};

/// One panel with one of everything that is small.
fn tiny() -> Figure {
    let panel = Panel::new(Axis::linear("*h*_1", 0.0, 1.0), Axis::linear("*y*", 0.0, 2.0).unnumbered())
        .titled("Tiny")
        .with(Layer::lines(vec![vec![[0.0, -1.0], [1.0, 3.0]]], Stroke::DASHED).labelled("line"))
        .with(Layer::dots(vec![[0.5, 0.5], [7.0, 0.5]], Shape::Disc, 2.0, family(0)))
        .legend(Place::TopLeft);
    Figure::new(40.0, 30.0).named("A tiny figure").with(panel)
}

#[test]
fn a_tiny_figure_is_the_same_to_the_byte() {
    let golden = include_str!("figures/tiny.svg");
    let svg = tiny().svg();
    if svg != golden {
        let found = std::env::temp_dir().join("kickdrift-tiny.svg");
        std::fs::write(&found, &svg).unwrap();
        panic!("the tiny figure changed: compare tests/figures/tiny.svg with {}", found.display());
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
        let message = tiny().png(dpi).unwrap_err().to_string();
        assert!(message.starts_with("dpi = "), "{message}");
    }
}

/// All layers, all corners, numbers from nowhere: nothing may panic, and the result is an SVG that can be drawn.
#[test]
fn strange_data_still_makes_a_figure() {
    let strange = [f64::NAN, f64::INFINITY, -1e308, 1e308, 0.0, -0.0, 1e-320];
    let points: Vec<[f64; 2]> = strange.iter().flat_map(|&x| strange.map(|y| [x, y])).collect();
    let mut cells = Cells::new([0.0, 0.0], [f64::MIN_POSITIVE, 1e300], Gradient::full().steps(3));
    cells.push(u32::MAX - 1, 0, 2);
    let picture = Picture::new([f64::MIN, 1.0], [0.0, 1.0], 1, vec![family(3)]);
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
            .with(Layer::picture(picture.clone()).labelled("picture"))
            .note(Note::new([f64::NAN, 1.0], "nowhere"))
            .bar(ColourBar { axis: Axis::log("bar", 1e-6, 1.0), gradient: Gradient::full() })
            .legend(Place::BottomRight)
            .gridded();
        let figure = Figure::new(60.0, 50.0).with(panel.clone()).with(panel).columns(1);
        let svg = figure.svg();
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "a number got lost");
        figure.png(72.0).unwrap();
    }
}

#[test]
fn a_figure_without_panels_is_blank_paper() {
    let (_, _, ink) = inspected(&Figure::single_column(20.0).png(72.0).unwrap());
    assert_eq!(ink, 0.0);
}

#[test]
fn a_bar_gives_each_value_the_colour_beside_its_number() {
    let bar = ColourBar { axis: Axis::log("rate", 1e-4, 1.0), gradient: Gradient::on_white() };
    assert_eq!(bar.colour(1e-2), Gradient::on_white().at(0.5));
    assert_eq!([1e-9, 1e-4, 1.1e-2, 1.0, 9.0, 0.0].map(|rate| bar.class(rate, 8)), [0, 0, 4, 7, 7, 0]);
}

#[test]
fn the_pdf_has_the_size_asked_for_and_its_letters_can_be_searched() {
    let pdf = tiny().pdf();
    assert_eq!(pdf, tiny().pdf());
    let text = String::from_utf8_lossy(&pdf);
    assert!(text.starts_with("%PDF-") && text.trim_end().ends_with("%%EOF"));
    // 40 and 30 mm in points.
    assert!(text.contains("/MediaBox [0 0 113.385826 85.03937]"), "{text}");
    for letter in "Tinyleh01".chars() {
        let meaning = format!("<{:04X}>", u32::from(letter));
        assert!(text.contains(&meaning), "{letter} has no meaning");
    }
    assert_eq!(text.matches("/Subtype /CIDFontType0C").count(), 3, "roman, italic, semibold");
}

#[test]
fn strange_letters_and_pictures_make_a_sound_pdf() {
    let picture = Picture::new([0.0, 1.0], [0.0, 1.0], 2, vec![family(3); 4]);
    let panel = Panel::new(Axis::linear("\u{10ffff} *x* Ж", 0.0, 1.0), Axis::linear("", 0.0, 1.0))
        .with(Layer::picture(picture))
        .with(Layer::areas(vec![vec![[0.0, 0.0], [1.0, 0.0], [0.5, 1.0]]], family(2), 0.5))
        .note(Note::new([0.5, 0.5], "note"));
    let pdf = Figure::new(60.0, 50.0).named("(a\\b)").with(panel).pdf();
    let text = String::from_utf8_lossy(&pdf);
    for piece in ["/Subtype /Image", "/ca 0.5", "<DBFFDFFF>", "<0416>"] {
        assert!(text.contains(piece), "no {piece} in {text}");
    }
}
