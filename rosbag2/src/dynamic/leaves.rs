//! Lists the paths of all numbers in a message, from which a map can choose.

use super::cursor::Cursor;
use super::defined_member::Count;
use super::field_path::{FieldPath, Index, Step};
use super::layout::{Kind, Layout};
use super::selector::{text_within, way_to_text};
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
        let indices = match member.count {
            Count::One => Vec::new(),
            _ => addresses(layout, &member.kind, count, *cursor, &beside)?,
        };
        for element in 0..listed {
            way.push(Step { field: member.name.clone(), index: indices.get(element).cloned() });
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

/// The text lists among the members of the struct at `cursor` with their keys, and the labels of a multi-array.
fn lists_of_names(layout: &Layout, number: usize, mut cursor: Cursor) -> Result<Vec<(String, Vec<String>)>, CdrError> {
    let mut lists = Vec::new();
    for member in layout.structure(number).map_or(&[][..], |structure| &structure.members) {
        match (&member.kind, member.count) {
            (Kind::Struct(inner), Count::One) if member.name == "layout" => {
                let mut inside = cursor;
                let members = layout.structure(*inner).map_or(&[][..], |structure| &structure.members);
                if let Some(dim) = members.iter().position(|member| member.name == "dim" && member.count != Count::One)
                {
                    inside.skip_members(layout, *inner, dim)?;
                    let count = inside.count(members[dim].count)?;
                    let labels = texts_within(layout, &members[dim].kind, "label", count, inside)?;
                    lists.extend(labels.map(|labels| ("layout.dim.label".to_string(), labels)));
                }
                cursor.skip(layout, &member.kind, 1)?;
            }
            (Kind::Text, count) if count != Count::One => {
                let count = cursor.count(count)?;
                let mut names = Vec::new();
                for place in 0..count {
                    let text = cursor.text()?;
                    if place < ELEMENT_LIMIT {
                        names.push(String::from_utf8_lossy(text).into_owned());
                    }
                }
                lists.push((member.name.clone(), names));
            }
            (kind, count) => {
                let count = cursor.count(count)?;
                cursor.skip(layout, kind, count)?;
            }
        }
    }
    Ok(lists)
}

/// Texts inside the elements at `cursor`, at most 16, by their key; `None` if the elements have no such member.
fn texts_within(
    layout: &Layout,
    kind: &Kind,
    key: &str,
    count: usize,
    mut cursor: Cursor,
) -> Result<Option<Vec<String>>, CdrError> {
    let Kind::Struct(number) = *kind else { return Ok(None) };
    let Some(way) = way_to_text(layout, number, key, false) else { return Ok(None) };
    let mut texts = Vec::new();
    for _ in 0..count.min(ELEMENT_LIMIT) {
        let Some(text) = text_within(layout, kind, &way, cursor)? else { return Ok(None) };
        texts.push(String::from_utf8_lossy(text).into_owned());
        cursor.skip(layout, kind, 1)?;
    }
    Ok(Some(texts))
}

/// Keys of the name of an element.
const NAMES_WITHIN: [&str; 5] = ["name", "id", "label", "frame_id", "header.frame_id"];

/// For each element of the array at `cursor`, its best address: its own name, the sibling list of names, otherwise its index. Names
/// that several elements share are none.
fn addresses(
    layout: &Layout,
    kind: &Kind,
    count: usize,
    cursor: Cursor,
    beside: &[(String, Vec<String>)],
) -> Result<Vec<Index>, CdrError> {
    let listed = count.min(ELEMENT_LIMIT);
    let mut found: Option<(String, Vec<String>)> = None;
    for key in NAMES_WITHIN {
        if found.is_none() {
            found = texts_within(layout, kind, key, count, cursor)?.map(|names| (key.to_string(), names));
        }
    }
    let found = found.or_else(|| beside.iter().find(|(_, names)| names.len() == listed).cloned());
    let (key, names) = found.unwrap_or_default();
    let is_single = |name: &String| names.iter().filter(|other| *other == name).count() == 1;
    let address = |element: usize| {
        let name = names.get(element).filter(|name| is_single(name));
        name.and_then(|name| addressable(&key, name)).unwrap_or(Index::Number(element))
    };
    Ok((0..listed).map(address).collect())
}

/// `[key=value]`; `None` if the value cannot be written in that form.
fn addressable(key: &str, value: &str) -> Option<Index> {
    let plain = !value.is_empty() && value.trim() == value && !value.contains(']');
    plain.then(|| Index::Named { key: key.to_string(), value: value.to_string() })
}
