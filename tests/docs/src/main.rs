//! Builds the book into `target/book`.

use std::process::ExitCode;

use excavator_book::{build, docs};

fn main() -> ExitCode {
    let site = docs().join("../target/book");
    match build(&docs(), &site) {
        Ok(pages) => {
            println!("{} pages; open {}", pages.len(), site.join("index.html").display());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: the book cannot be built: {error:#}");
            ExitCode::FAILURE
        }
    }
}
