//! Definitions of messages that nest without end.

use super::mcap_text::{end, message, start, topic};
use crate::hostile::child::{Run, run, worst};
use crate::hostile::fault::Fault;

const MAP: &str = "[[signals]]\nsignal = \"pump_pressure\"\ntopic = \"/t\"\nfield = \"x\"\n";

/// What reading a field of a topic with this definition comes to.
fn read(encoding: &str, schema: &str) -> Run {
    let folder = tempfile::tempdir().unwrap();
    let bag = [start(), topic("/t", "p/msg/T", encoding, schema), message(1, &[0, 1, 0, 0, 0, 0, 0, 0]), end()];
    std::fs::write(folder.path().join("bag.mcap"), bag.concat()).unwrap();
    std::fs::write(folder.path().join("map.toml"), MAP).unwrap();
    let info = run(folder.path(), &["info", "bag.mcap"], 20.0);
    assert!(info.status.is_some(), "{info:?}");
    info.is_frugal();
    run(folder.path(), &["import", "bag.mcap", "--map", "map.toml", "-o", "out"], 20.0)
}

#[test]
fn an_idl_definition_with_30_000_nested_sequences() {
    let sequences = format!(
        "module p {{ module msg {{ struct T {{ {}double{} x; }}; }}; }};",
        "sequence<".repeat(30_000),
        ">".repeat(30_000)
    );
    let first = read("ros2idl", &sequences);
    first.refused(&["sequences of sequences are not read"]);
    let modules = read("ros2idl", &"module a { ".repeat(80_000));
    assert_eq!(modules.status, Some(1), "{modules:?}");
    let brackets = read("ros2idl", &format!("@a{}", "(".repeat(500_000)));
    assert_eq!(brackets.status, Some(1), "{brackets:?}");
    let large = read("ros2idl", &"a ".repeat(600_000));
    large.refused(&["1048576"]);
    Fault {
        group: "Files",
        tried: "an IDL definition with 30 000 nested sequences",
        outcome: "refused in one line; no parser calls itself without a bound",
    }
    .survived(&worst(&[first, modules, brackets, large]));
}

#[test]
fn types_that_contain_each_other_without_end() {
    let section = |name: &str, text: &str| format!("{}\nMSG: p/{name}\n{text}\n", "=".repeat(80));
    // Itself; a chain of 5000; and a chain that is short from each of its links, where the deepest comes first.
    let own = format!("T x\n{}", section("T", "T x"));
    let chain: String = (0..5_000).map(|n| section(&format!("C{n}"), &format!("C{} c", n + 1))).collect();
    let mut links = section("L0", "float64 x");
    for n in 1..5000 {
        links.push_str(&section(&format!("L{n}"), &format!("L{} l", n - 1)));
    }
    let step: String = (0..5000).step_by(30).map(|n| format!("L{n} l{n}\n")).collect();
    let mut runs = Vec::new();
    for schema in [own, format!("C0 x\n{chain}"), format!("{step}{links}")] {
        let refused = read("ros2msg", &schema);
        refused.refused(&["nests deeper than 32 types"]);
        runs.push(refused);
    }
    // Two of the next type in each of 32 types, and no field in the last: four thousand million ways through.
    let wide: String = (0..32).map(|n| section(&format!("W{n}"), &format!("W{0} a\nW{0} b", n + 1))).collect();
    let folder = tempfile::tempdir().unwrap();
    let schema = format!("W0 x\n{wide}{}", section("W32", ""));
    let state = topic("/arm/state", "excavator_msgs/msg/ArmState", "ros2msg", &schema);
    let bag = [start(), state, message(1, &[0, 1, 0, 0, 0]), end()].concat();
    std::fs::write(folder.path().join("bag.mcap"), bag).unwrap();
    let compare = run(folder.path(), &["compare", "--model", "zx30u-arm", "--bag", "bag.mcap"], 20.0);
    compare.refused(&["differs from ours"]);
    runs.push(compare);
    Fault {
        group: "Files",
        tried: "message types within types: 5000 deep, within themselves, or 2^32 ways",
        outcome: "refused beyond 32 types, counted along every way",
    }
    .survived(&worst(&runs));
}
