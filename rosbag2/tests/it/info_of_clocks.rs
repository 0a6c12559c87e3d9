//! What `info` says of clocks.

use rosbag2::{BagWriter, Qos, TopicInfo, TopicToWrite, WriteOptions, cdr, info};
use serde::Serialize;

const MS: i64 = 1_000_000;

/// `std_msgs/Header` before a number.
#[derive(Serialize)]
struct Stamped {
    sec: i32,
    nanosec: u32,
    frame_id: String,
    value: f64,
}

fn stamped(nanoseconds: i64) -> Stamped {
    let (sec, nanosec) = (nanoseconds / 1_000_000_000, nanoseconds % 1_000_000_000);
    Stamped { sec: sec as i32, nanosec: nanosec as u32, frame_id: String::new(), value: 1.0 }
}

/// A bag with a message per pair of stamp and log time, ns.
fn topic(times: &[(i64, i64)]) -> TopicInfo {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bag");
    let mut bag = BagWriter::create(&path, &WriteOptions::default()).unwrap();
    let topic = TopicToWrite {
        name: "/force".into(),
        type_name: "test_msgs/msg/Stamped".into(),
        schema: "std_msgs/Header header\nfloat64 value".into(),
        qos: vec![Qos::reliable(10)],
    };
    let id = bag.add_topic(&topic).unwrap();
    for &(stamp, log) in times {
        bag.write(id, log as u64, log as u64, &cdr::encode(&stamped(stamp)).unwrap()).unwrap();
    }
    bag.finish().unwrap();
    info(&path).unwrap().topics.remove(0)
}

#[test]
fn gaps_jitter_and_delay_are_measured() {
    // 2 ms apart, every other 0.1 ms late, one missing; logged 5 ms later.
    let stamps = (1..=200).filter(|i| *i != 100).map(|i| 2 * i * MS + (i % 2) * MS / 10);
    let timing = topic(&stamps.map(|stamp| (stamp, stamp + 5 * MS)).collect::<Vec<_>>()).timing.unwrap();
    assert!(timing.from_stamps);
    assert!((timing.median_interval - 2e-3).abs() < 0.11e-3, "{}", timing.median_interval);
    assert!((timing.jitter - 0.2e-3).abs() < 0.11e-3, "{}", timing.jitter);
    assert_eq!((timing.gaps, timing.log_times_backwards), (1, 0));
    assert!((timing.longest_interval - 4e-3).abs() < 1e-9);
    assert!((timing.longest_interval_at - 0.196).abs() < 1e-9, "{}", timing.longest_interval_at);
    let stamps = timing.stamps.unwrap();
    assert_eq!((stamps.zero, stamps.backwards, stamps.repeated), (0, 0, 0));
    assert!((stamps.median_delay - 5e-3).abs() < 1e-12);
}

#[test]
fn clocks_that_step_or_were_never_set_are_found() {
    let backwards = topic(&[(1, 10), (3, 30), (2, 20), (3, 40), (5, 50)].map(|(a, b)| (a * MS, b * MS)));
    let timing = backwards.timing.unwrap();
    let stamps = timing.stamps.unwrap();
    assert_eq!((timing.log_times_backwards, stamps.backwards, stamps.repeated), (1, 1, 1));
    assert_eq!(stamps.delay_range, (0.009, 0.045));
    let unset = topic(&[(0, 10 * MS), (0, 20 * MS), (0, 30 * MS)]).timing.unwrap();
    assert!(!unset.from_stamps);
    assert_eq!((unset.stamps.unwrap().zero, unset.median_interval), (3, 0.01));
    assert_eq!(topic(&[(MS, MS)]).timing, None);
}
