//! Figures of awkward data are drawn without complaint; what they say is in the document.

use proptest::prelude::*;

use super::*;

fn awkward() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1e3..1e3,
        1 => (-300.0..300.0).prop_map(|e: f64| 10_f64.powf(e)),
        1 => (-300.0..300.0).prop_map(|e: f64| -10_f64.powf(e)),
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(f64::MAX),
        1 => Just(f64::MIN_POSITIVE),
        1 => Just(5e-324),
        2 => Just(0.0),
        2 => Just(6_378_137.0),
    ]
}

fn axis() -> impl Strategy<Value = Axis> {
    let scale = prop_oneof![Just(Scale::Linear), Just(Scale::Log), Just(Scale::Time)];
    let range = prop_oneof![3 => Just(None), 1 => (awkward(), awkward()).prop_map(|(a, b)| Some([a, b]))];
    ("[ -~°√²µσ]{0,60}", scale, range).prop_map(|(label, scale, range)| Axis {
        label,
        scale,
        range,
        names: Vec::new(),
    })
}

fn series() -> impl Strategy<Value = Series> {
    let style = prop_oneof![
        Just(None),
        Just(Some(Style::Dashed)),
        Just(Some(Style::Dotted)),
        Just(Some(Style::DashDot)),
        Just(Some(Style::Points))
    ];
    let points = proptest::collection::vec([awkward(), awkward()], 0..20).prop_map(Data::Points);
    let band = proptest::collection::vec([awkward(), awkward(), awkward()], 0..20).prop_map(Data::Band);
    let parts = ("[a-z.]{0,30}", prop_oneof![points, band], style, any::<bool>());
    parts.prop_map(|(label, data, style, solid)| Series { label, data, style, colour: None, solid })
}

fn figure() -> impl Strategy<Value = Figure> {
    let panel =
        (axis(), proptest::collection::vec(series(), 0..4)).prop_map(|(y, series)| Panel { y, series });
    let size = prop_oneof![Just(None), (0..900_u32, 0..900_u32).prop_map(Some)];
    ("[ -~]{0,200}", axis(), proptest::collection::vec(panel, 0..4), any::<bool>(), size).prop_map(
        |(title, x, panels, equal_aspect, size)| Figure {
            subtitle: title.clone(),
            title,
            x,
            panels,
            equal_aspect,
            size,
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn any_figure_is_a_document(figure in figure()) {
        let svg = figure.to_svg().unwrap();
        prop_assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        prop_assert!(!svg.contains("NaN"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn any_figure_is_an_image(figure in figure()) {
        let path = temporary("any.png");
        figure.write_png(&path).unwrap();
        let (w, h) = figure.points();
        prop_assert_eq!(png_size(&path), (pixels(w), pixels(h)));
    }
}

fn temporary(name: &str) -> PathBuf {
    let dir = std::env::temp_dir().join(format!("schuler-figure-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    dir.join(name)
}

fn pixels(points: u32) -> u32 {
    (f64::from(points) * PIXELS_PER_POINT).round() as u32
}

/// Width and height from the header (PNG specification, IHDR).
fn png_size(path: &Path) -> (u32, u32) {
    let bytes = std::fs::read(path).unwrap();
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    let word = |k: usize| u32::from_be_bytes(bytes[k..k + 4].try_into().unwrap());
    (word(16), word(20))
}

fn sine(label: &str) -> Series {
    Series::line(label, (0..=1440).map(|k| [60.0 * f64::from(k), (f64::from(k) / 13.43).sin()]))
}

#[test]
fn the_document_says_what_the_figure_says() {
    let panel = Panel::new(Axis::linear("north error (m)"));
    let svg = Figure::new("Drift of a < b", Axis::time("time"))
        .subtitle("100 µg, σ²")
        .panel(panel.with(sine("exact")).with(sine("linear").style(Style::Dashed)))
        .to_svg()
        .unwrap();
    for text in
        ["Drift of a &lt; b", "100 µg, σ²", "north error (m)", "time (h)", "exact", "linear", "24", "−1.0"]
    {
        assert!(svg.contains(&format!("\n{text}\n</text>")), "{text} is missing");
    }
    assert!(svg.contains("width=\"800\" height=\"500\""));
    assert!(svg.contains("stroke-dasharray=\"60,30\" stroke-width=\"14\""));
}

#[test]
fn forty_series_are_all_in_the_legend_and_differ() {
    let names: Vec<String> = (0..40).map(|k| format!("gyro.misalignment.constant.{k:02}")).collect();
    let panel = names.iter().fold(Panel::new(Axis::linear("error (m)")), |p, name| p.with(sine(name)));
    let figure = Figure::new("Forty", Axis::time("time")).panel(panel);
    let svg = figure.to_svg().unwrap();
    for name in &names {
        assert!(svg.contains(name.as_str()), "{name} is missing");
    }
    let looks: Vec<_> = (0..40).map(|k| legend::look(&figure, &figure.panels[0].series[k], k)).collect();
    for (k, look) in looks.iter().enumerate() {
        assert!(!looks[..k].contains(look), "series {k} looks like another");
    }
}

#[test]
fn every_character_of_labels_has_a_glyph() {
    use ab_glyph::{Font, FontRef};
    for face in [
        &include_bytes!("fonts/DejaVuSans-subset.ttf")[..],
        include_bytes!("fonts/DejaVuSans-Bold-subset.ttf"),
    ] {
        let font = FontRef::try_from_slice(face).unwrap();
        for c in "αβγδεθλμνπρστφψωΔΣΩ°√²³·−×±≤≥≈′″⁰¹²³⁴⁵⁶⁷⁸⁹⁻µ…–—’→∞".chars()
        {
            assert_ne!(font.glyph_id(c).0, 0, "no glyph for {c}");
        }
    }
}

#[test]
fn a_folder_that_does_not_exist_is_named() {
    let figure = Figure::new("x", Axis::linear("x")).panel(Panel::new(Axis::linear("y")));
    for result in [
        figure.write_png("/no/such/folder/a.png".as_ref()),
        figure.write_svg("/no/such/folder/a.svg".as_ref()),
    ] {
        let message = result.unwrap_err().to_string();
        assert!(message.starts_with("cannot write figure /no/such/folder/a."), "{message}");
    }
}

#[test]
fn units_follow_the_size_of_the_numbers() {
    let shown = |q: Quantity, v: f64| q.shown(v).symbol;
    assert_eq!(shown(Quantity::Length, 13_429.0), "km");
    assert_eq!(shown(Quantity::Length, 638.0), "m");
    assert_eq!(shown(Quantity::Length, f64::NAN), "m");
    assert_eq!(shown(Quantity::Angle, 4.848e-5), "arcsec");
    assert_eq!(shown(Quantity::Angle, 0.0), "nrad");
    assert_eq!(shown(Quantity::AngularRate, 7.3e-5), "deg/h");
    assert_eq!(shown(Quantity::Acceleration, 9.8e-4), "µg");
    let arcmin = Quantity::Angle.shown(0.003);
    assert_eq!(arcmin.symbol, "arcmin");
    // A full circle has 21 600 arcmin.
    assert!((arcmin.per_si * std::f64::consts::TAU - 21_600.0).abs() < 1e-9);
}

/// Bars start from x = 0; the first row, which is at y = 0, has no axis of its own. Grey `b0b0b0` is that of zero lines, `404040`
/// that of axes.
#[test]
fn bars_stand_on_x_zero() {
    let rows = |x: Axis| {
        let panel = Panel::new(Axis::rows(vec!["a".into(), "b".into()]))
            .with(Series::band("", [[-1.0, -0.4, 0.4], [1.0, -0.4, 0.4]]).solid());
        Figure::new("t", x).panel(panel).to_svg().unwrap().to_lowercase()
    };
    // Lines straight down that are longer than a tick.
    let down = |svg: &str| {
        let axes = svg.lines().filter(|line| line.contains("#404040"));
        let points = axes.filter_map(|line| line.split("points=\"").nth(1)?.split('"').next());
        let lines = points.filter_map(|points| {
            let numbers: Vec<f64> = points.split([',', ' ']).filter_map(|x| x.parse().ok()).collect();
            <[f64; 4]>::try_from(numbers).ok()
        });
        lines.filter(|[x0, y0, x1, y1]| x0 == x1 && (y1 - y0).abs() > 1000.0).count()
    };
    let across = rows(Axis::linear("x").from_to(-1.5, 1.5));
    assert!(!across.contains("b0b0b0"), "a zero line through the first bar");
    assert_eq!(down(&across), 1);
    assert_eq!(down(&rows(Axis::linear("x").from_to(0.5, 1.5))), 0);
    let solid = Figure::new("t", Axis::linear("x")).panel(
        Panel::new(Axis::linear("y")).with(Series::band("a", [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0]]).solid()),
    );
    assert!(solid.to_svg().unwrap().contains("<polygon opacity=\"1\""));
}
