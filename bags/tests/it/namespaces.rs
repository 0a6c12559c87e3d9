//! Bags with machines in namespaces.

use crate::support;
use std::path::Path;

use excavator_bags::map::{Origin, read_recording_or_mapped, read_signals};
use excavator_bags::{BagError, Topics};
use rosbag2::{BagWriter, WriteOptions};

/// A bag in which each machine's arm has been somewhere else: the stamp of its only state.
fn bag(folder: &Path, namespaces: &[&str]) -> std::path::PathBuf {
    let path = folder.join("bag");
    let mut writer = BagWriter::create(&path, &WriteOptions::default()).unwrap();
    for (number, namespace) in namespaces.iter().enumerate() {
        let topic = Topics::in_namespace(namespace).state;
        for sample in 0..3 {
            support::add(&mut writer, &topic, &support::state(1_000_000_000 * (number as i64 + 1) + sample, &["arm"]));
        }
    }
    writer.finish().unwrap();
    path
}

fn start(path: &Path, namespace: Option<&str>) -> Result<i64, BagError> {
    let origin = Origin { namespace, ..Origin::default() };
    read_recording_or_mapped(path, origin).map(|(recording, _)| recording.start_nanoseconds)
}

#[test]
fn the_only_machine_needs_no_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = bag(folder.path(), &["/left"]);
    assert_eq!(start(&path, None).unwrap(), 1_000_000_000);
    assert_eq!(read_signals(&path, Origin::default()).unwrap().1.notes, Vec::<String>::new());
    assert!(matches!(start(&path, Some("right")), Err(BagError::NoTopic { .. })));
}

#[test]
fn one_of_two_machines_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = bag(folder.path(), &["/left", "/pit/right"]);
    assert_eq!(start(&path, Some("/left")).unwrap(), 1_000_000_000);
    assert_eq!(start(&path, Some("pit/right")).unwrap(), 2_000_000_000);
    let refused = start(&path, None).unwrap_err();
    assert!(matches!(&refused, BagError::SeveralMachines { namespaces, .. } if namespaces == &["/left", "/pit/right"]));
    assert!(refused.to_string().contains("--namespace"), "{refused}");
}

#[test]
fn a_machine_outside_every_namespace_comes_first() {
    let folder = tempfile::tempdir().unwrap();
    let path = bag(folder.path(), &["/left", "/"]);
    assert_eq!(start(&path, None).unwrap(), 2_000_000_000);
    assert_eq!(start(&path, Some("left")).unwrap(), 1_000_000_000);
}
