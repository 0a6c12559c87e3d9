//! Resolves a field path in a layout and reads the numbers.

use super::cursor::Cursor;
use super::defined_member::Count;
use super::error::PathError;
use super::field_path::{FieldPath, Index};
use super::layout::{Kind, Layout, Member, Primitive};
use crate::cdr::CdrError;

/// As in [`cdr::decode`](crate::cdr::decode): the rest must be padding.
const PADDING_LIMIT: usize = 7;
const NANOSECONDS_PER_SECOND: i64 = 1_000_000_000;

#[derive(Debug, Clone, PartialEq, Eq)]
enum ResolvedIndex {
    Single,
    Number(usize),
    /// Position of the text in a list of the same struct, by the members that lead to it.
    Beside(Vec<usize>, String),
    /// The element in which these members lead to the text.
    Within(Vec<usize>, String),
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct ResolvedStep {
    member: usize,
    index: ResolvedIndex,
}

/// A field path resolved in a layout.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Selector {
    steps: Vec<ResolvedStep>,
    /// The kind of value at the end of the path.
    kind: Kind,
}

impl Selector {
    /// Resolves a path that must end at a number.
    ///
    /// # Errors
    /// [`PathError`].
    pub fn number(layout: &Layout, path: &FieldPath) -> Result<Selector, PathError> {
        let selector = Selector::resolve(layout, path)?;
        let found = match &selector.kind {
            Kind::Primitive(_) => return Ok(selector),
            Kind::Text => "text".to_string(),
            Kind::Struct(number) => layout.structure(*number).map(|s| s.name.clone()).unwrap_or_default(),
            Kind::Unreadable(name) => name.clone(),
        };
        Err(PathError::NotANumber { path: path.to_string(), found })
    }

    /// Resolves a path that must end at a `builtin_interfaces/Time`.
    ///
    /// # Errors
    /// [`PathError`].
    pub fn time(layout: &Layout, path: &FieldPath) -> Result<Selector, PathError> {
        let selector = Selector::resolve(layout, path)?;
        let wanted = [Kind::Primitive(Primitive::I32), Kind::Primitive(Primitive::U32)];
        let is_time = match &selector.kind {
            Kind::Struct(number) => layout.structure(*number).is_some_and(|structure| {
                structure.members.iter().map(|member| &member.kind).eq(&wanted)
                    && structure.members.iter().all(|member| member.count == Count::One)
            }),
            _ => false,
        };
        if is_time { Ok(selector) } else { Err(PathError::NotATime { path: path.to_string() }) }
    }

    /// Resolves an array of bytes in the message itself.
    ///
    /// # Errors
    /// [`PathError::NoField`], [`PathError::NotANumber`].
    pub fn octets(layout: &Layout, field: &str) -> Result<Selector, PathError> {
        let structure = layout.structure(0);
        let members = structure.map_or(&[][..], |structure| &structure.members);
        let Some(number) = members.iter().position(|member| member.name == field) else {
            return Err(PathError::NoField {
                type_name: structure.map_or(String::new(), |structure| structure.name.clone()),
                wanted: field.to_string(),
                existing: members.iter().map(|member| member.name.clone()).collect(),
            });
        };
        let member = &members[number];
        if member.kind != Kind::Primitive(Primitive::U8) || member.count == Count::One {
            return Err(PathError::NotANumber { path: field.to_string(), found: "no array of bytes".to_string() });
        }
        let steps = vec![ResolvedStep { member: number, index: ResolvedIndex::Single }];
        Ok(Selector { steps, kind: member.kind.clone() })
    }

    /// The bytes of the array in a message, for a selector from [`Selector::octets`].
    ///
    /// # Errors
    /// As [`Selector::read`].
    pub fn read_octets<'b>(&self, layout: &Layout, message: &'b [u8]) -> Result<&'b [u8], CdrError> {
        let mut cursor = Cursor::new(message)?;
        let (Some(step), Some(structure)) = (self.steps.first(), layout.structure(0)) else { return Ok(&[]) };
        cursor.skip_members(layout, 0, step.member)?;
        let Some(member) = structure.members.get(step.member) else { return Ok(&[]) };
        let count = cursor.count(member.count)?;
        cursor.octets(count)
    }

    fn resolve(layout: &Layout, path: &FieldPath) -> Result<Selector, PathError> {
        let mut steps = Vec::new();
        let mut kind = Kind::Struct(0);
        for step in path.steps() {
            let own = match &kind {
                Kind::Struct(number) => Some(*number),
                _ => None,
            };
            let structure = own.and_then(|number| layout.structure(number));
            let members = structure.map_or(&[][..], |structure| &structure.members);
            let Some(member) = members.iter().position(|member| member.name == step.field) else {
                return Err(PathError::NoField {
                    type_name: structure.map_or("a number".to_string(), |structure| structure.name.clone()),
                    wanted: step.field.clone(),
                    existing: members.iter().map(|member| member.name.clone()).collect(),
                });
            };
            let found = &members[member];
            let index = match (&step.index, found.count) {
                (None, Count::One) => ResolvedIndex::Single,
                (None, _) => return Err(PathError::NeedsIndex { field: step.field.clone() }),
                (Some(_), Count::One) => return Err(PathError::NotAnArray { field: step.field.clone() }),
                (Some(Index::Number(number)), _) => ResolvedIndex::Number(*number),
                (Some(Index::Named { key, value }), _) => named(layout, own.unwrap_or_default(), found, key, value)?,
            };
            kind = found.kind.clone();
            steps.push(ResolvedStep { member, index });
        }
        Ok(Selector { steps, kind })
    }

    /// The number in a message (with encapsulation); `None` if the array has no such element.
    ///
    /// # Errors
    /// [`CdrError`] when the bytes up to the number do not fit the layout.
    pub fn read(&self, layout: &Layout, message: &[u8]) -> Result<Option<f64>, CdrError> {
        let Kind::Primitive(primitive) = self.kind else {
            return Ok(None);
        };
        match self.locate(layout, message)? {
            Some(mut cursor) => cursor.number(primitive).map(Some),
            None => Ok(None),
        }
    }

    /// The time in a message, ns since the epoch; `None` if the array has no such element.
    ///
    /// # Errors
    /// As [`Selector::read`].
    pub fn read_time(&self, layout: &Layout, message: &[u8]) -> Result<Option<i64>, CdrError> {
        let Some(mut cursor) = self.locate(layout, message)? else {
            return Ok(None);
        };
        let (seconds, nanoseconds) = (cursor.i32()?, cursor.u32()?);
        Ok(Some(i64::from(seconds) * NANOSECONDS_PER_SECOND + i64::from(nanoseconds)))
    }

    fn locate<'b>(&self, layout: &Layout, message: &'b [u8]) -> Result<Option<Cursor<'b>>, CdrError> {
        let mut cursor = Cursor::new(message)?;
        let mut number = 0;
        for step in &self.steps {
            let Some(member) = layout.structure(number).and_then(|structure| structure.members.get(step.member)) else {
                return Ok(None);
            };
            let start = cursor;
            cursor.skip_members(layout, number, step.member)?;
            let count = cursor.count(member.count)?;
            let wanted = match &step.index {
                ResolvedIndex::Single => Some(0),
                ResolvedIndex::Number(index) => Some(*index),
                ResolvedIndex::Beside(list, text) => place_in_list(layout, number, list, start, text)?,
                ResolvedIndex::Within(key, text) => place_of_element(layout, &member.kind, key, count, cursor, text)?,
            };
            let Some(wanted) = wanted.filter(|&wanted| wanted < count) else {
                return Ok(None);
            };
            cursor.skip(layout, &member.kind, wanted)?;
            if let Kind::Struct(inner) = member.kind {
                number = inner;
            }
        }
        Ok(Some(cursor))
    }
}

/// How `[key=value]` finds its element in this type.
fn named(layout: &Layout, own: usize, array: &Member, key: &str, value: &str) -> Result<ResolvedIndex, PathError> {
    if let Kind::Struct(number) = array.kind
        && let Some(way) = way_to_text(layout, number, key, false)
    {
        return Ok(ResolvedIndex::Within(way, value.to_string()));
    }
    match way_to_text(layout, own, key, true) {
        Some(way) => Ok(ResolvedIndex::Beside(way, value.to_string())),
        None => Err(PathError::NoKey { field: array.name.clone(), key: key.to_string() }),
    }
}

/// The members that lead from a struct to a text, by a key such as `header.frame_id`. With `listed`, exactly one of them is an array.
pub(super) fn way_to_text(layout: &Layout, mut number: usize, key: &str, listed: bool) -> Option<Vec<usize>> {
    let (mut way, mut lists) = (Vec::new(), 0);
    let mut names = key.split('.').peekable();
    while let Some(name) = names.next() {
        let members = &layout.structure(number)?.members;
        let index = members.iter().position(|member| member.name == name)?;
        lists += usize::from(members[index].count != Count::One);
        way.push(index);
        match (&members[index].kind, names.peek()) {
            (Kind::Text, None) => return (lists == usize::from(listed)).then_some(way),
            (Kind::Struct(inner), Some(_)) => number = *inner,
            _ => return None,
        }
    }
    None
}

/// Position of a text in the list to which `way` leads from the struct at `cursor`.
fn place_in_list(
    layout: &Layout,
    mut number: usize,
    way: &[usize],
    mut cursor: Cursor,
    text: &str,
) -> Result<Option<usize>, CdrError> {
    for (step, &index) in way.iter().enumerate() {
        let Some(member) = layout.structure(number).and_then(|structure| structure.members.get(index)) else {
            return Ok(None);
        };
        cursor.skip_members(layout, number, index)?;
        match (&member.kind, member.count) {
            (Kind::Struct(inner), Count::One) => number = *inner,
            (kind, count) => {
                let count = cursor.count(count)?;
                return place_of_element(layout, kind, &way[step + 1..], count, cursor, text);
            }
        }
    }
    Ok(None)
}

/// Position of the element in which `way` leads to the text, among `count` at `cursor`; without a way, elements are texts.
fn place_of_element(
    layout: &Layout,
    kind: &Kind,
    way: &[usize],
    count: usize,
    mut cursor: Cursor,
    text: &str,
) -> Result<Option<usize>, CdrError> {
    for place in 0..count {
        match text_within(layout, kind, way, cursor)? {
            Some(found) if found == text.as_bytes() => return Ok(Some(place)),
            Some(_) => cursor.skip(layout, kind, 1)?,
            None => return Ok(None),
        }
    }
    Ok(None)
}

/// The text to which `way` leads from the element at `cursor`; without a way, the element is the text.
pub(super) fn text_within<'l, 'm>(
    layout: &'l Layout,
    mut kind: &'l Kind,
    way: &[usize],
    mut cursor: Cursor<'m>,
) -> Result<Option<&'m [u8]>, CdrError> {
    for &index in way {
        let Kind::Struct(number) = *kind else { return Ok(None) };
        let Some(member) = layout.structure(number).and_then(|structure| structure.members.get(index)) else {
            return Ok(None);
        };
        cursor.skip_members(layout, number, index)?;
        kind = &member.kind;
    }
    cursor.text().map(Some)
}

impl Layout {
    /// Checks that a whole message (with encapsulation) fits: not too short, and only padding left over.
    ///
    /// # Errors
    /// [`CdrError`], with what does not fit.
    pub fn check(&self, message: &[u8]) -> Result<(), CdrError> {
        let mut cursor = Cursor::new(message)?;
        cursor.skip_struct(self, 0)?;
        match cursor.remaining() {
            left if left > PADDING_LIMIT => Err(CdrError::LeftOver { bytes: message.len() - 4, left }),
            _ => Ok(()),
        }
    }
}
