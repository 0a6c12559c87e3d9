//! Pauses and resumes with the space bar.

use std::io::{IsTerminal, Read};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use nix::sys::termios::{LocalFlags, SetArg, Termios, tcgetattr, tcsetattr};

/// Reads single keys from the terminal until it is dropped. Inactive if standard input is not a terminal.
pub(super) struct Keys {
    before: Option<Termios>,
}

impl Keys {
    /// Toggles `pause` with each press of the space bar. If standard input is a pipe, each space in it counts.
    pub fn listen(pause: Arc<AtomicBool>) -> Self {
        let before = std::io::stdin().is_terminal().then(single_keys).flatten();
        // The thread ends with the process: its blocking read cannot be interrupted.
        std::thread::spawn(move || {
            for byte in std::io::stdin().lock().bytes() {
                match byte {
                    Ok(b' ') => {
                        pause.fetch_xor(true, Ordering::Relaxed);
                    }
                    Ok(_) => {}
                    Err(_) => return,
                }
            }
        });
        Keys { before }
    }
}

fn single_keys() -> Option<Termios> {
    let before = tcgetattr(std::io::stdin()).ok()?;
    let mut keys = before.clone();
    keys.local_flags.remove(LocalFlags::ICANON | LocalFlags::ECHO);
    tcsetattr(std::io::stdin(), SetArg::TCSANOW, &keys).ok()?;
    Some(before)
}

impl Drop for Keys {
    fn drop(&mut self) {
        if let Some(before) = &self.before {
            // If this fails too, the terminal stays as it is.
            let _ = tcsetattr(std::io::stdin(), SetArg::TCSANOW, before);
        }
    }
}
