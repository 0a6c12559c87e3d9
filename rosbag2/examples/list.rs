//! What is in a bag: `cargo run -p rosbag2 --example list -- BAG`.
//!
//! Prints each topic with its type and number of messages, and the numbers in its first message, read by the definition in
//! the bag.

use std::collections::BTreeMap;
use std::error::Error;
use std::path::PathBuf;

use rosbag2::prelude::*;
use rosbag2::printable;

/// Numbers of a message that are printed.
const SHOWN: usize = 8;

fn main() -> Result<(), Box<dyn Error>> {
    let bag = std::env::args_os().nth(1).map(PathBuf::from).ok_or("usage: list BAG")?;
    let mut messages = RawMessages::open(&bag)?;
    let mut topics: BTreeMap<String, (u64, RawMessage)> = BTreeMap::new();
    for message in &mut messages {
        let message = message?;
        topics.entry(message.topic.name.clone()).or_insert((0, message)).0 += 1;
    }
    for topic in messages.topics() {
        let Some((count, first)) = topics.get(&topic.name) else {
            println!("{}  {}  0 messages", printable(&topic.name), printable(&topic.type_name));
            continue;
        };
        println!("{}  {}  {count} messages", printable(&topic.name), printable(&topic.type_name));
        if let Err(error) = show(first) {
            println!("    not decoded: {}", printable(&error.to_string()));
        }
    }
    for damage in messages.damage() {
        println!("damage: {damage}");
    }
    Ok(())
}

/// Prints the first numbers of a message.
fn show(message: &RawMessage) -> Result<(), Box<dyn Error>> {
    let layout = Layout::of_topic(&message.topic, &Definitions::default())?;
    let leaves = numeric_leaves(&layout, &message.data)?;
    for path in leaves.iter().take(SHOWN) {
        if let Some(value) = Selector::number(&layout, path)?.read(&layout, &message.data)? {
            println!("    {} = {value}", printable(&path.to_string()));
        }
    }
    if leaves.len() > SHOWN {
        println!("    and {} more numbers", leaves.len() - SHOWN);
    }
    Ok(())
}
