//! The pages are what the command gives.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

use std::path::Path;

use excavator_papers::{BLOCKS, Block, written};

fn assert_current(block: &Block) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(block.page);
    let page = std::fs::read_to_string(path).unwrap();
    let made = written(block, &block.text().unwrap(), &page).unwrap();
    let other = made.lines().zip(page.lines()).find(|(made, page)| made != page);
    assert_eq!(page, made, "{} of {}: {other:?}; cargo run --release -p excavator-papers", block.name, block.page);
}

#[test]
fn short_blocks_are_what_the_command_gives() {
    BLOCKS.iter().filter(|block| !block.is_long).for_each(assert_current);
}

#[test]
#[ignore = "minutes; tests/run --long"]
fn long_blocks_are_what_the_command_gives() {
    BLOCKS.iter().filter(|block| block.is_long).for_each(assert_current);
}
