//! `excavator reindex`

use rosbag2::{BagCompression, Reindexed, ReindexedFile, printable, reindex};

use crate::cli::ReindexArguments;
use crate::error::VerbError;
use crate::next_step::{NextStep, print_next};
use crate::terminal::print;

pub fn run(arguments: &ReindexArguments) -> Result<(), VerbError> {
    let done = reindex(&arguments.bag, arguments.keep)?;
    print(&summary(&done));
    for file in &done.files {
        print(&sentence(file));
        for damage in &file.damage {
            print(&format!("  {}", printable(&damage.to_string())));
        }
        if let Some(original) = &file.original {
            print(&format!("  the original is now {}", printable(&original.display().to_string())));
        }
    }
    print_next(&NextStep::new("see what is in it", "info").word(arguments.bag.display().to_string()));
    Ok(())
}

fn sentence(file: &ReindexedFile) -> String {
    let path = file.path.display().to_string();
    let (path, messages) = (printable(&path), file.messages);
    if file.packed && !file.rewritten {
        return format!("{path}: compressed as the other files are, with all {messages} messages");
    }
    match (file.rewritten, file.damage.is_empty()) {
        (false, true) => format!("{path}: whole, {messages} messages; left as it is"),
        (false, false) => format!("{path}: {messages} messages readable; left as it is:"),
        (true, true) => format!("{path}: had no index; rewritten with all {messages} messages"),
        (true, false) => format!("{path}: rewritten with {messages} messages; of the original:"),
    }
}

fn summary(done: &Reindexed) -> String {
    let lost: u64 = done.files.iter().flat_map(|file| &file.damage).map(|damage| damage.lost_bytes).sum();
    let (messages, topics, files) = (done.messages(), done.topics, done.files.len());
    let metadata = done.metadata.as_ref().map_or(String::new(), |path| {
        let path = path.display().to_string();
        let compression = match done.compression {
            BagCompression::None => "",
            BagCompression::Message => ", with compression of each message by zstd",
            BagCompression::File => ", with compression of whole files by zstd",
        };
        format!(" {} is written{compression}.", printable(&path))
    });
    let files = if files == 1 { "one file".to_string() } else { format!("{files} files") };
    format!("{messages} messages in {topics} topics and {files} can be read, and {lost} bytes are lost.{metadata}")
}
