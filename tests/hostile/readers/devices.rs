//! Devices, FIFOs and folders in the place of files.

use std::process::Command;

use crate::hostile::child::{run, worst};
use crate::hostile::fault::Fault;

#[test]
fn devices_fifos_and_folders_are_no_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for fifo in ["fifo", "fifo.csv", "fifo.toml", "fifo.mcap"] {
        assert!(Command::new("mkfifo").arg(path(fifo)).status().unwrap().success());
    }
    for name in ["folder.toml", "folder.csv"] {
        std::fs::create_dir(path(name)).unwrap();
    }
    for (name, target) in [("zero.csv", "/dev/zero"), ("zero.toml", "/dev/zero"), ("zero.mcap", "/dev/zero")] {
        std::os::unix::fs::symlink(target, path(name)).unwrap();
    }
    std::fs::write(path("t.csv"), "time,x\n0,1\n1,2\n").unwrap();
    std::fs::create_dir(path("bag")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", path("bag/metadata.yaml")).unwrap();
    std::fs::write(path("bag/bag_0.mcap"), "").unwrap();
    let mut runs = Vec::new();
    let mut refused = |words: &[&str], part: &str| {
        let refused = run(folder.path(), words, 5.0);
        refused.refused(&[part]);
        runs.push(refused);
    };
    let no_file = "is not a regular file but";
    for data in ["/dev/zero", "zero.mcap", "zero.csv", "fifo", "fifo.csv", "fifo.mcap"] {
        refused(&["info", data], no_file);
        refused(&["compare", "--model", "zx30u-arm", "--bag", data], no_file);
        refused(&["reindex", data], no_file);
    }
    refused(&["info", "bag"], no_file);
    refused(&["info", "folder.csv"], "is not a bag");
    for model in ["zero.toml", "fifo.toml", "/dev/zero", "fifo", "folder.toml"] {
        refused(&["compare", "--model", model, "--bag", "bag"], no_file);
        refused(&["import", "t.csv", "--map", model, "-o", "out"], no_file);
    }
    // A text of 5 MB is no model.
    std::fs::write(path("large.toml"), vec![b'#'; 5 << 20]).unwrap();
    refused(&["compare", "--model", "large.toml", "--bag", "bag"], "5242880 bytes or more, the limit");
    Fault {
        group: "Files",
        tried: "/dev/zero, a FIFO or a folder as bag, table, map or model",
        outcome: "refused at once as not a regular file",
    }
    .survived(&worst(&runs));
}
