//! Every struct against its `.msg` file: names, order and types of all fields, nested ones included.
//!
//! A probing serde deserializer builds a value of the struct out of nothing and writes down what it is asked for. That
//! is exactly what a CDR deserializer is asked for, so equal lists mean equal bytes.

#![allow(clippy::panic)]

use excavator_msgs::common::{
    Clock, DiagnosticArray, DiagnosticStatus, Flag, Float64MultiArray, FluidPressure, FluidPressureArray, JointState,
    KeyValue, Log, Text,
};
use excavator_msgs::layout::{Field, flat_fields};
use excavator_msgs::{
    ArmState, CylinderEnergy, CylinderState, EnergyState, EnergyTerm, Header, Message, OrificeCommand, Time,
    definitions,
};
use serde::de::value::Error;
use serde::de::{self, DeserializeSeed, SeqAccess, Visitor};

struct Probe<'p> {
    path: String,
    array: &'static str,
    found: &'p mut Vec<Field>,
}

impl Probe<'_> {
    fn note(&mut self, type_name: &str) {
        let type_name = format!("{type_name}{}", self.array);
        self.found.push(Field { type_name, name: self.path.clone() });
    }
}

macro_rules! primitive {
    ($deserialize:ident, $visit:ident, $type_name:literal, $value:expr) => {
        fn $deserialize<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Error> {
            self.note($type_name);
            visitor.$visit($value)
        }
    };
}

impl<'de> de::Deserializer<'de> for Probe<'_> {
    type Error = Error;

    primitive!(deserialize_bool, visit_bool, "bool", false);
    primitive!(deserialize_f64, visit_f64, "float64", 0.0);
    primitive!(deserialize_i32, visit_i32, "int32", 0);
    primitive!(deserialize_u32, visit_u32, "uint32", 0);
    primitive!(deserialize_u8, visit_u8, "uint8", 0);
    primitive!(deserialize_string, visit_string, "string", String::new());

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_seq(Members { path: self.path, names: None, next: 0, found: self.found })
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let path = if self.path.is_empty() { String::new() } else { format!("{}{}.", self.path, self.array) };
        visitor.visit_seq(Members { path, names: Some(fields), next: 0, found: self.found })
    }

    fn deserialize_any<V: Visitor<'de>>(self, _visitor: V) -> Result<V::Value, Error> {
        Err(de::Error::custom(format!("{} has a type that no message of this package uses", self.path)))
    }

    serde::forward_to_deserialize_any! {
        i8 i16 i64 i128 u16 u64 u128 f32 char str bytes byte_buf option unit unit_struct newtype_struct tuple
        tuple_struct map enum identifier ignored_any
    }
}

/// The fields of a struct, or the one element that a probed sequence has.
struct Members<'p> {
    path: String,
    names: Option<&'static [&'static str]>,
    next: usize,
    found: &'p mut Vec<Field>,
}

impl<'de> SeqAccess<'de> for Members<'_> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        let probe = match self.names {
            Some(names) => match names.get(self.next) {
                Some(name) => Probe { path: format!("{}{name}", self.path), array: "", found: self.found },
                None => return Ok(None),
            },
            None if self.next == 0 => Probe { path: self.path.clone(), array: "[]", found: self.found },
            None => return Ok(None),
        };
        self.next += 1;
        seed.deserialize(probe).map(Some)
    }
}

fn assert_matches<M: Message>() {
    let mut found = Vec::new();
    let value = M::deserialize(Probe { path: String::new(), array: "", found: &mut found });
    assert!(value.is_ok(), "{}: {:?}", M::TYPE_NAME, value.err());
    let Some(schema) = definitions::schema(M::TYPE_NAME) else { panic!("{} has no definition", M::TYPE_NAME) };
    let mut expected = flat_fields(M::TYPE_NAME, &schema);
    for field in &mut expected {
        // The same eight bits.
        field.type_name = field.type_name.replace("byte", "uint8");
    }
    assert_eq!(found, expected, "{}", M::TYPE_NAME);
}

#[test]
fn structs_have_the_fields_of_their_definitions() {
    assert_matches::<Time>();
    assert_matches::<Header>();
    assert_matches::<CylinderState>();
    assert_matches::<ArmState>();
    assert_matches::<OrificeCommand>();
    assert_matches::<EnergyTerm>();
    assert_matches::<CylinderEnergy>();
    assert_matches::<EnergyState>();
}

#[test]
fn structs_of_other_packages_have_the_fields_of_their_definitions() {
    assert_matches::<Clock>();
    assert_matches::<DiagnosticArray>();
    assert_matches::<DiagnosticStatus>();
    assert_matches::<KeyValue>();
    assert_matches::<FluidPressure>();
    assert_matches::<FluidPressureArray>();
    assert_matches::<Float64MultiArray>();
    assert_matches::<JointState>();
    assert_matches::<Log>();
    assert_matches::<Flag>();
    assert_matches::<Text>();
}
