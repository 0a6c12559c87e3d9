//! The library as Python loads it. What it does is tested in Python, in this folder.

#![allow(clippy::panic)]

use std::path::PathBuf;

/// Python looks for one function by the name of the module.
#[test]
fn the_library_has_the_function_that_python_calls() {
    let name = format!("{}excavator_python{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let test = std::env::current_exe().unwrap_or_default();
    // Tests lie in `deps`, and what is delivered lies in that folder or in the one above.
    let places: Vec<PathBuf> = test.ancestors().skip(1).take(2).map(|folder| folder.join(&name)).collect();
    let library = places.iter().find_map(|place| std::fs::read(place).ok());
    let library = library.unwrap_or_else(|| panic!("none of {places:?} can be read"));
    assert!(library.windows(14).any(|bytes| bytes == b"PyInit__native"));
}
