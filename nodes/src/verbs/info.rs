//! `excavator info`

use std::path::Path;

use super::print;
use crate::cli::InfoArguments;
use crate::error::VerbError;
use crate::output::write_json;

pub fn run(arguments: &InfoArguments) -> Result<(), VerbError> {
    let info = excavator_bags::info(&arguments.bag)?;
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        print(&format!(
            "{}: {} messages in {:.2} s, {:.1} MB",
            info.path.display(),
            info.message_count,
            info.duration,
            info.size as f64 / 1e6
        ));
        for topic in &info.topics {
            let rate = topic.mean_rate().map_or("-".to_string(), |rate| format!("{rate:.1}"));
            print(&format!(
                "  {:28} {:36} {:8} messages {rate:>8} Hz",
                topic.name, topic.type_name, topic.message_count
            ));
        }
        for problem in &info.problems {
            print(&format!("  problem: {problem}"));
        }
    }
    if let Some(path) = &arguments.json.json {
        write_json(path, &serde_json::to_value(&info)?)?;
    }
    Ok(())
}
