//! The blocks of the pages, between marks.

use crate::{cross_validation, energy_flow, identification_errors, servo_bench};

/// A part of a page that is made by a function.
pub struct Block {
    /// Name in its marks.
    pub name: &'static str,
    /// Page under `docs/`.
    pub page: &'static str,
    /// Whether it takes minutes, not seconds.
    pub is_long: bool,
    make: fn() -> Result<String, String>,
}

/// All blocks.
pub const BLOCKS: [Block; 6] = [
    Block {
        name: "condition-numbers",
        page: "papers.md",
        make: identification_errors::condition_numbers,
        is_long: false,
    },
    Block { name: "identification-errors", page: "papers.md", make: identification_errors::errors, is_long: false },
    Block { name: "cross-validation", page: "papers.md", make: cross_validation::cross_validation, is_long: false },
    Block { name: "energy-of-the-paper", page: "energy.md", make: energy_flow::energy_flow, is_long: false },
    Block { name: "table-one", page: "papers.md", make: servo_bench::table_one, is_long: false },
    Block { name: "refinement", page: "papers.md", make: servo_bench::refinement, is_long: true },
];

impl Block {
    /// Its text.
    ///
    /// # Errors
    /// A sentence if a simulation or fit fails.
    pub fn text(&self) -> Result<String, String> {
        (self.make)()
    }
}

/// The page with this text in the block.
///
/// # Errors
/// A sentence if the page lacks the marks.
pub fn written(block: &Block, text: &str, page: &str) -> Result<String, String> {
    let (before, after) = around(block, page)?;
    Ok(format!("{before}{}\n{after}", text.trim_end()))
}

/// What stands before the text of a block, its mark included, and what stands after it.
fn around<'p>(block: &Block, page: &'p str) -> Result<(&'p str, &'p str), String> {
    let (start, end) = (
        format!("<!-- {}: cargo run --release -p excavator-papers -->\n", block.name),
        format!("<!-- end of {} -->", block.name),
    );
    let first = page.find(&start).ok_or(format!("{} has no line {}", block.page, start.trim_end()))? + start.len();
    let last = page[first..].find(&end).ok_or(format!("{} has no line {end}", block.page))? + first;
    Ok((&page[..first], &page[last..]))
}
