//! Maps as text: whatever can be written down reads back the same.

use excavator_bags::map::{
    ClockSource, ColumnName, Quantity, Resampling, SignalKind, SignalName, SignalSource, Stamp, TopicMap, Unit,
};
use proptest::prelude::*;

fn quantity() -> impl Strategy<Value = Quantity> {
    prop_oneof![(-1e6..1e6_f64).prop_map(Quantity::Number), (-1e3..1e3_f64).prop_map(Quantity::Number)]
}

fn signal() -> impl Strategy<Value = SignalSource> {
    let name = (0..SignalKind::ALL.len(), "[a-z]{1,6}").prop_map(|(index, cylinder)| {
        let kind = SignalKind::ALL[index];
        SignalName { cylinder: kind.is_of_cylinder().then_some(cylinder), kind }
    });
    let place = prop_oneof![
        ("/[a-z/]{1,9}[a-z]", "[a-z]{1,5}(\\[[0-9]{1,2}\\])?").prop_map(|(topic, field)| (Some((topic, field)), None)),
        (1..9_usize).prop_map(|number| (None, Some(ColumnName::Number(number)))),
        "[ -~äöü]{1,12}".prop_map(|name| (None, Some(ColumnName::Name(name)))),
    ];
    let options = (
        prop::option::of(quantity()),
        prop::option::of(quantity()),
        prop::option::of(prop_oneof![Just(1_i8), Just(-1)]),
        prop::option::of(1e-3..1e3_f64),
        prop::option::of(prop_oneof![Just(Resampling::Linear), Just(Resampling::Hold)]),
        prop_oneof![Just(Stamp::Auto), Just(Stamp::Log), Just(Stamp::Header), Just(Stamp::Field("a.b".into()))],
    );
    (name, place, options, any::<bool>()).prop_map(|(name, (field, column), options, with_unit)| {
        let mut source = SignalSource::new(name);
        source.unit = with_unit.then(|| source.signal.kind.dimension().si_unit().to_string());
        (source.topic, source.field) =
            field.map_or((None, None), |(topic, field)| (Some(topic), Some(field.parse().unwrap())));
        source.column = column;
        (source.scale, source.offset, source.sign, source.maximum_gap, source.resample, source.stamp) = options;
        source
    })
}

proptest! {
    #[test]
    fn every_map_survives_the_round_trip(
        signals in prop::collection::vec(signal(), 1..6),
        description in "[ -~\n]{0,30}",
        topic in prop::option::of("/[a-z]{1,9}"),
    ) {
        let mut names = std::collections::HashSet::new();
        let signals: Vec<SignalSource> = signals.into_iter().filter(|s| names.insert(s.signal.clone())).collect();
        let map = TopicMap { description, clock: ClockSource { topic, ..ClockSource::default() }, signals, ..TopicMap::default() };
        prop_assert_eq!(map.to_text().unwrap().parse::<TopicMap>().unwrap(), map);
    }

    #[test]
    fn units_are_linear_and_found_by_their_names(value in -1e6..1e6_f64) {
        for name in Unit::names().split(", ") {
            let unit = Unit::named(name).unwrap();
            prop_assert_eq!(unit.name, name);
            let (zero, one) = (unit.to_si(0.0), unit.to_si(1.0));
            let expected = zero + value * (one - zero);
            prop_assert!((unit.to_si(value) - expected).abs() <= 1e-9 * (expected.abs() + zero.abs() + 1.0), "{}", name);
            prop_assert!((unit.factor() - (one - zero)).abs() <= 1e-12 * (one.abs() + zero.abs()), "{}", name);
        }
    }
}

#[test]
fn factors_are_those_of_the_textbooks() {
    for (name, value, expected) in [
        ("bar", 1.0, 1e5),
        ("psi", 1.0, 6894.757293168361),
        ("mm", 350.0, 0.35),
        ("deg", 180.0, std::f64::consts::PI),
        ("l/min", 60.0, 1e-3),
        ("L/min", 60.0, 1e-3),
        ("gpm", 1.0, 6.30901964e-5),
        ("mm²", 1e6, 1.0),
        ("K", 273.15, 0.0),
        ("degF", 212.0, 100.0),
        ("kN", 1.5, 1500.0),
        ("rpm", 60.0, 2.0 * std::f64::consts::PI),
        ("1/min", 60.0, 2.0 * std::f64::consts::PI),
        ("pct", 50.0, 0.5),
        ("mPas", 1.0, f64::NAN),
        ("mPa", 1.0, f64::NAN),
    ] {
        let found = Unit::named(name).map_or(f64::NAN, |unit| unit.to_si(value));
        let same = (found - expected).abs() <= 1e-9 * expected.abs().max(1e-9) || (found.is_nan() && expected.is_nan());
        assert!(same, "{name}: {found} instead of {expected}");
    }
}

#[test]
fn the_page_about_maps_knows_every_unit_and_its_examples_are_maps() {
    let page = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/topic-maps.md");
    let page = std::fs::read_to_string(page).unwrap();
    let units = page.split("Units: ").nth(1).unwrap().trim_end().trim_end_matches('.').replace(['\n', ';'], " ");
    let listed: Vec<&str> = units.split([',', ' ']).filter(|unit| !unit.is_empty()).collect();
    for name in Unit::names().split(", ").filter(|name| *name != "-") {
        assert!(listed.contains(&name), "{name} is not on the page");
    }
    let examples: Vec<&str> = page.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert_eq!(examples.len(), 6);
    for example in examples {
        let signals =
            if example.contains("[[signals]]") { "" } else { "[[signals]]\nsignal = \"pump_flow\"\nvalue = 1\n" };
        let map: Result<TopicMap, _> = format!("{example}{signals}").parse();
        assert!(map.is_ok(), "{example}{map:?}");
    }
}
