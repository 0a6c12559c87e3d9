//! A node that speaks and listens: `cargo run -p excavator-ros --example chat`, in two terminals.
//!
//! It says ten sentences on the topic `chat`, one a second, prints what it hears there, and ends; Ctrl-C ends it before.
//! With `-- --ros-args -p greeting:=hi -r __ns:=/left` it says something else, somewhere else.

use std::sync::atomic::Ordering;

use excavator_msgs::common::Text;
use excavator_ros::prelude::*;
use rosbag2::printable;

/// Sentences that are said.
const SENTENCES: u32 = 10;
/// Sentences per second, Hz.
const RATE: f64 = 1.0;

fn main() -> Result<(), RosError> {
    let (arguments, _) = RosArguments::parse(&std::env::args().collect::<Vec<_>>())?;
    let greeting = Parameter::new("greeting", Value::String("hello".to_string()), "what every sentence begins with");
    // Before any other thread is started: signals are blocked in all of them.
    let supervisor = Supervisor::start("chat", &arguments, vec![greeting])?;
    supervisor
        .link
        .subscribe("chat", TopicQos::reliable(10), |heard: Text, _| println!("{}", printable(&heard.data)))?;
    let outlet = supervisor.link.publish("chat", TopicQos::reliable(10))?;
    let (parameters, logger, stop) = (supervisor.parameters.clone(), supervisor.logger.clone(), supervisor.stop_flag());
    std::thread::spawn(move || {
        let mut pace = Pace::new(RATE);
        for number in 1..=SENTENCES {
            pace.wait();
            // Another node may have set the parameter since.
            let data = format!("{} {number}", parameters.text("greeting"));
            if let Err(error) = outlet.publish(Text { data }) {
                logger.warn(error.to_string());
            }
        }
        stop.store(true, Ordering::Relaxed);
    });
    supervisor.run(|| {});
    supervisor.leave();
    Ok(())
}
