//! A program that runs, with its log as it comes.

use std::io::{BufRead, BufReader};
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;

use super::until;

/// A program of a test in a process group of its own, as a shell starts it; killed when dropped.
pub struct Program {
    child: Child,
    log: Arc<Mutex<String>>,
    reader: Option<JoinHandle<()>>,
}

impl Program {
    /// Starts the command; its standard error becomes the log.
    pub fn spawn(mut command: Command) -> Program {
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped()).process_group(0);
        let mut child = command.spawn().unwrap();
        let log = Arc::new(Mutex::new(String::new()));
        let lines = BufReader::new(child.stderr.take().unwrap());
        let shared = Arc::clone(&log);
        let reader = std::thread::spawn(move || {
            for line in lines.lines().map_while(Result::ok) {
                *shared.lock().unwrap() += &(line + "\n");
            }
        });
        Program { child, log, reader: Some(reader) }
    }

    /// Number of the process.
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Numbers of its child processes.
    pub fn children(&self) -> Vec<u32> {
        let path = format!("/proc/{0}/task/{0}/children", self.id());
        std::fs::read_to_string(path).unwrap().split_whitespace().map(|word| word.parse().unwrap()).collect()
    }

    /// What it has written to standard error so far.
    pub fn log(&self) -> String {
        self.log.lock().unwrap().clone()
    }

    /// Waits until its log has these words.
    pub fn says(&self, words: &str) {
        until(&format!("\"{words}\" in a log"), || self.log().contains(words));
    }

    pub fn signal(&self, signal: &str) {
        kill(signal, &self.id().to_string());
    }

    /// Signals the process and all that it started, as a terminal does.
    pub fn signal_group(&self, signal: &str) {
        kill(signal, &format!("-{}", self.id()));
    }

    /// Ctrl-C; returns exit status and log.
    pub fn interrupt(self) -> (i32, String) {
        self.signal("-INT");
        self.wait()
    }

    /// Waits for its end and that of all that write to its log; returns exit status and log.
    pub fn wait(mut self) -> (i32, String) {
        until("the program to end", || self.child.try_wait().unwrap().is_some());
        let reader = self.reader.take().unwrap();
        until("its children to end", || reader.is_finished());
        reader.join().unwrap();
        (self.child.wait().unwrap().code().unwrap_or(-1), self.log())
    }

    pub fn kill(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Sends a signal to a process, or to a group where the number begins with a minus.
pub fn kill(signal: &str, process: &str) {
    let words = [signal, "--", process];
    assert!(Command::new("kill").args(words).status().unwrap().success(), "{words:?}");
}
