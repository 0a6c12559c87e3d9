//! Lists the paths of all numbers in a message, from which a map can choose.

use super::cursor::Cursor;
use super::defined_member::Count;
use super::field_path::{FieldPath, Index, Step};
use super::layout::{Kind, Layout};
use crate::cdr::CdrError;

/// Elements listed per array: an image has a million numbers, none of them a signal.
const ELEMENT_LIMIT: usize = 16;
/// Paths listed per message.
const LEAF_LIMIT: usize = 400;

/// Paths to the numbers in a message (with encapsulation), at most 16 elements of each array. Elements are addressed by
/// name if the array has a sibling list of names, or if the element contains a name.
///
/// # Errors
/// [`CdrError`] when the message does not fit the layout.
pub fn numeric_leaves(layout: &Layout, message: &[u8]) -> Result<Vec<FieldPath>, CdrError> {
    let mut leaves = Vec::new();
    walk(layout, 0, &mut Cursor::new(message)?, &mut Vec::new(), &mut leaves)?;
    Ok(leaves.into_iter().filter_map(FieldPath::from_steps).collect())
}

fn walk(
    layout: &Layout,
    number: usize,
    cursor: &mut Cursor,
    way: &mut Vec<Step>,
    leaves: &mut Vec<Vec<Step>>,
) -> Result<(), CdrError> {
    let Some(structure) = layout.structure(number) else {
        return Ok(());
    };
    if structure.members.is_empty() {
        return cursor.skip_struct(layout, number);
    }
    let beside = lists_of_names(layout, number, *cursor)?;
    for member in &structure.members {
        let count = cursor.count(member.count)?;
        let listed = count.min(ELEMENT_LIMIT);
        for element in 0..listed {
            let index = match member.count {
                Count::One => None,
                _ => Some(index_of(layout, &member.kind, element, count, *cursor, &beside)?),
            };
            way.push(Step { field: member.name.clone(), index });
            match &member.kind {
                Kind::Struct(inner) => walk(layout, *inner, cursor, way, leaves)?,
                kind => {
                    if matches!(kind, Kind::Primitive(_)) && leaves.len() < LEAF_LIMIT {
                        leaves.push(way.clone());
                    }
                    cursor.skip(layout, kind, 1)?;
                }
            }
            way.pop();
        }
        cursor.skip(layout, &member.kind, count - listed)?;
    }
    Ok(())
}

/// The text lists among the members of the struct at `cursor`, with their names.
fn lists_of_names(layout: &Layout, number: usize, mut cursor: Cursor) -> Result<Vec<(String, Vec<String>)>, CdrError> {
    let mut lists = Vec::new();
    for member in layout.structure(number).map_or(&[][..], |structure| &structure.members) {
        let count = cursor.count(member.count)?;
        if member.kind != Kind::Text || member.count == Count::One {
            cursor.skip(layout, &member.kind, count)?;
            continue;
        }
        let mut names = Vec::new();
        for place in 0..count {
            let text = cursor.text()?;
            if place < ELEMENT_LIMIT {
                names.push(String::from_utf8_lossy(text).into_owned());
            }
        }
        lists.push((member.name.clone(), names));
    }
    Ok(lists)
}

/// The best address of an element: its own name, the sibling list of names, otherwise its index.
fn index_of(
    layout: &Layout,
    kind: &Kind,
    element: usize,
    count: usize,
    mut cursor: Cursor,
    beside: &[(String, Vec<String>)],
) -> Result<Index, CdrError> {
    if let Kind::Struct(number) = *kind {
        let members = layout.structure(number).map_or(&[][..], |structure| &structure.members);
        let is_name = |name: &str| ["name", "id", "label", "frame_id"].contains(&name);
        let own = members.iter().position(|m| m.kind == Kind::Text && m.count == Count::One && is_name(&m.name));
        if let Some(member) = own {
            cursor.skip_members(layout, number, member)?;
            let value = String::from_utf8_lossy(cursor.text()?).into_owned();
            return Ok(addressable(&members[member].name, &value).unwrap_or(Index::Number(element)));
        }
    }
    let list = beside.iter().find(|(_, names)| names.len() == count.min(ELEMENT_LIMIT));
    let named = list.and_then(|(key, names)| addressable(key, names.get(element)?));
    Ok(named.unwrap_or(Index::Number(element)))
}

/// `[key=value]`; `None` if the value cannot be written in that form.
fn addressable(key: &str, value: &str) -> Option<Index> {
    let plain = !value.is_empty() && value.trim() == value && !value.contains(']');
    plain.then(|| Index::Named { key: key.to_string(), value: value.to_string() })
}
