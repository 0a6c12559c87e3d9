//! Reads and writes YAML with limits: nesting, number of nodes, and aliases that multiply them.

use serde::de::{Deserialize, DeserializeOwned, Deserializer, MapAccess, SeqAccess, Visitor};

use crate::ReadLimits;

/// Nodes of a document. 400 000: the metadata of a bag with a thousand files and a thousand topics has 30 000.
const NODES: usize = 400_000;
/// Nodes that aliases may repeat. ROS 2 never writes aliases; documents written by hand share a few blocks.
const REPEATED_NODES: usize = 10_000;

/// Parses a document.
///
/// # Errors
/// The fault, in one line without an excerpt of the text.
pub fn from_str<T: DeserializeOwned>(text: &str, limits: &ReadLimits) -> Result<T, String> {
    let options = serde_saphyr::options! {
        budget: serde_saphyr::budget! {
            max_depth: limits.nesting,
            flow_nesting_limit: limits.nesting,
            max_nodes: NODES,
            max_events: 3 * NODES,
            max_total_scalar_bytes: usize::try_from(limits.document).unwrap_or(usize::MAX),
            max_documents: 1,
            max_aliases: REPEATED_NODES,
        },
        alias_limits: serde_saphyr::alias_limits! {
            max_total_replayed_events: 3 * REPEATED_NODES,
            max_replay_stack_depth: limits.nesting,
        },
        strict_booleans: true,
        non_finite_float_policy: serde_saphyr::options::NonFiniteFloatPolicy::PassThrough,
        with_snippet: false,
    };
    serde_saphyr::from_str_with_options(text, options).map_err(|error| {
        let lines: Vec<String> = error.to_string().lines().map(|line| line.trim().to_string()).collect();
        lines.join(" ")
    })
}

/// Writes a document in the style of rosbag2: block style, short texts on one line.
///
/// # Errors
/// The value that cannot be written.
pub fn to_string<T: serde::Serialize>(value: &T) -> Result<String, String> {
    let options = serde_saphyr::ser_options! { prefer_block_scalars: false };
    serde_saphyr::to_string_with_options(value, options).map_err(|error| error.to_string())
}

/// Any YAML value, with the types that YAML 1.2 assigns to unquoted scalars.
#[derive(Debug, Clone, PartialEq)]
pub enum Yaml {
    /// Nothing, `null` or `~`.
    Null,
    /// `true` or `false`.
    Bool(bool),
    /// An integer.
    Integer(i64),
    /// A number, or an integer outside the range of `i64`.
    Double(f64),
    /// Text.
    String(String),
    /// A list.
    Sequence(Vec<Yaml>),
    /// Keys with their values, in the order of the text.
    Mapping(Vec<(Yaml, Yaml)>),
}

impl Yaml {
    /// The value of a key in a mapping.
    pub fn get(&self, wanted: &str) -> Option<&Yaml> {
        let Yaml::Mapping(entries) = self else { return None };
        entries.iter().find(|(key, _)| matches!(key, Yaml::String(text) if text == wanted)).map(|(_, value)| value)
    }
}

impl<'de> Deserialize<'de> for Yaml {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Yaml, D::Error> {
        deserializer.deserialize_any(AnyYaml)
    }
}

struct AnyYaml;

impl<'de> Visitor<'de> for AnyYaml {
    type Value = Yaml;

    fn expecting(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
        formatter.write_str("any YAML")
    }

    fn visit_unit<E>(self) -> Result<Yaml, E> {
        Ok(Yaml::Null)
    }

    fn visit_none<E>(self) -> Result<Yaml, E> {
        Ok(Yaml::Null)
    }

    fn visit_some<D: Deserializer<'de>>(self, deserializer: D) -> Result<Yaml, D::Error> {
        Yaml::deserialize(deserializer)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Yaml, E> {
        Ok(Yaml::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Yaml, E> {
        Ok(Yaml::Integer(value))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Yaml, E> {
        Ok(i64::try_from(value).map_or(Yaml::Double(value as f64), Yaml::Integer))
    }

    fn visit_i128<E>(self, value: i128) -> Result<Yaml, E> {
        Ok(i64::try_from(value).map_or(Yaml::Double(value as f64), Yaml::Integer))
    }

    fn visit_u128<E>(self, value: u128) -> Result<Yaml, E> {
        Ok(i64::try_from(value).map_or(Yaml::Double(value as f64), Yaml::Integer))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Yaml, E> {
        Ok(Yaml::Double(value))
    }

    fn visit_str<E>(self, text: &str) -> Result<Yaml, E> {
        Ok(Yaml::String(text.to_string()))
    }

    fn visit_string<E>(self, text: String) -> Result<Yaml, E> {
        Ok(Yaml::String(text))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Yaml, A::Error> {
        let mut sequence = Vec::new();
        while let Some(item) = items.next_element()? {
            sequence.push(item);
        }
        Ok(Yaml::Sequence(sequence))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Yaml, A::Error> {
        let mut mapping = Vec::new();
        while let Some(entry) = entries.next_entry()? {
            mapping.push(entry);
        }
        Ok(Yaml::Mapping(mapping))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Yaml, String> {
        from_str(text, &ReadLimits::DEFAULT)
    }

    #[test]
    fn scalars_have_the_types_of_yaml_1_2() {
        let string = |text: &str| Yaml::String(text.to_string());
        for (text, expected) in [
            ("", Yaml::Null),
            ("~", Yaml::Null),
            ("3", Yaml::Integer(3)),
            ("-9223372036854775808", Yaml::Integer(i64::MIN)),
            ("18446744073709551615", Yaml::Double(u64::MAX as f64)),
            ("3.0", Yaml::Double(3.0)),
            ("1e3", Yaml::Double(1e3)),
            (".inf", Yaml::Double(f64::INFINITY)),
            ("true", Yaml::Bool(true)),
            ("yes", string("yes")),
            ("off", string("off")),
            ("'3'", string("3")),
            ("/arm/state", string("/arm/state")),
        ] {
            assert_eq!(read(text), Ok(expected), "{text}");
        }
        assert!(matches!(read(".nan"), Ok(Yaml::Double(number)) if number.is_nan()));
        assert_eq!(read("a: 1").unwrap().get("a"), Some(&Yaml::Integer(1)));
    }

    #[test]
    fn bombs_are_refused_at_once() {
        let laughs = |levels: usize| {
            let mut text = "a0: &a0 [lol, lol, lol, lol, lol, lol, lol, lol, lol, lol]\n".to_string();
            for level in 1..levels {
                let aliases = vec![format!("*a{}", level - 1); 10].join(", ");
                text.push_str(&format!("a{level}: &a{level} [{aliases}]\n"));
            }
            text
        };
        // Whoever unfolds one of them fills the memory.
        assert!(read(&laughs(2)).is_ok(), "{:?}", read(&laughs(2)));
        for bomb in [laughs(9), "[".repeat(100_000), "{a: ".repeat(100_000), "- ".repeat(100_000), "a: &a [*a]".into()]
        {
            let error = read(&bomb).unwrap_err();
            assert!(error.len() < 300 && !error.contains('\n'), "{error}");
        }
    }

    #[test]
    fn what_is_written_is_read_back() {
        #[derive(serde::Serialize)]
        struct Document<'d> {
            empty: &'d str,
            lines: &'d str,
            number: u64,
            names: Vec<&'d str>,
            nothing: Option<u8>,
            long: String,
        }
        let names = vec!["yes", "1", "a: b", "/t", "\u{1b}[2J"];
        let long = "word ".repeat(50);
        let text = to_string(&Document {
            empty: "",
            lines: "- a\n- b\n",
            number: u64::MAX,
            names: names.clone(),
            nothing: None,
            long: long.clone(),
        })
        .unwrap();
        let back = read(&text).unwrap();
        assert_eq!(back.get("empty"), Some(&Yaml::String(String::new())), "{text}");
        assert_eq!(back.get("lines"), Some(&Yaml::String("- a\n- b\n".to_string())), "{text}");
        assert_eq!(back.get("long"), Some(&Yaml::String(long)), "{text}");
        assert_eq!(back.get("nothing"), Some(&Yaml::Null), "{text}");
        let names = names.iter().map(|name| Yaml::String(name.to_string())).collect();
        assert_eq!(back.get("names"), Some(&Yaml::Sequence(names)), "{text}");
    }
}
