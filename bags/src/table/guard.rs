//! Converts panics of a library to errors.

use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    static GUARDED: Cell<bool> = const { Cell::new(false) };
}
static HOOK: Once = Once::new();

/// The result of `work`, or its panic message, which is not printed otherwise.
pub(super) fn without_panic<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    HOOK.call_once(|| {
        let usual = take_hook();
        set_hook(Box::new(move |panic| {
            if !GUARDED.get() {
                usual(panic);
            }
        }));
    });
    GUARDED.set(true);
    let result = catch_unwind(AssertUnwindSafe(work));
    GUARDED.set(false);
    result.map_err(|panic| message(panic.as_ref()))
}

fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
    text.and_then(|text| text.lines().next()).unwrap_or("the reader gave up").to_string()
}

#[cfg(test)]
#[allow(clippy::panic)]
mod tests {
    use super::without_panic;

    #[test]
    fn panics_are_errors_with_their_first_line() {
        assert_eq!(without_panic(|| 1 + 1), Ok(2));
        assert_eq!(without_panic(|| -> u8 { panic!("bit width {}\nmore", 99) }), Err("bit width 99".to_string()));
    }
}
