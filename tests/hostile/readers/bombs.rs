//! Small files that unpack to gigabytes, and large ones that have no end of a line.

use std::io::Write;

use super::mcap_text::{end, message, start, topic, zeros, zstd_chunk};
use crate::hostile::child::{run, worst};
use crate::hostile::fault::Fault;

#[test]
fn a_chunk_of_four_gigabytes_in_an_mcap_file_of_131_kilobytes() {
    let folder = tempfile::tempdir().unwrap();
    let bomb = zeros(64);
    let write = |name: &str, chunk: &[u8]| {
        let state = topic("/arm/state", "excavator_msgs/msg/ArmState", "ros2msg", "float64 x");
        std::fs::write(folder.path().join(name), [start(), state, chunk.to_vec(), end()].concat()).unwrap();
        std::fs::metadata(folder.path().join(name)).unwrap().len()
    };
    let size = write("honest.mcap", &zstd_chunk(4 << 30, &bomb));
    assert!(size < 600_000, "{size}");
    // One that announces less than it has.
    write("lying.mcap", &zstd_chunk(1000, &bomb));
    // Sixty of them, each of the size that is allowed.
    write("many.mcap", &zstd_chunk(64 << 20, &zeros(1)).repeat(60));
    let mut runs = Vec::new();
    for (name, parts) in [
        ("honest.mcap", &["a message, record or chunk has 4294967296 bytes, the limit is 67108864"][..]),
        ("lying.mcap", &["/arm/state"][..]),
        ("many.mcap", &["a file of", "unpacks to", "the limit for that size is"][..]),
    ] {
        let compare = run(folder.path(), &["compare", "--model", "zx30u-arm", "--bag", name], 30.0);
        compare.refused(parts);
        let info = run(folder.path(), &["info", name], 30.0);
        info.is_frugal();
        runs.extend([compare, info]);
    }
    Fault {
        group: "Files",
        tried: "an MCAP file of 0.1 MB with a chunk of 4 GiB",
        outcome: "the chunk is left out in one line; no more than 64 MiB are unpacked at a time",
    }
    .survived(&worst(&runs));
}

#[test]
fn a_chunk_of_a_million_broken_records() {
    let folder = tempfile::tempdir().unwrap();
    // 64 MiB of empty messages, nine bytes each: seven million complaints.
    let records = [5, 0, 0, 0, 0, 0, 0, 0, 0].repeat((64 << 20) / 9);
    let packed = zstd::bulk::compress(&records, 1).unwrap();
    let chunk = zstd_chunk(records.len() as u64, &packed);
    std::fs::write(folder.path().join("bag.mcap"), [start(), chunk, end()].concat()).unwrap();
    let compare = run(folder.path(), &["compare", "--model", "zx30u-arm", "--bag", "bag.mcap"], 60.0);
    assert_eq!(compare.status, Some(1));
    compare.is_frugal();
    Fault {
        group: "Files",
        tried: "a chunk of seven million broken records",
        outcome: "a thousand are listed, the others counted",
    }
    .survived(&worst(&[compare]));
}

#[test]
fn a_bag_packed_with_zstd_a_hundred_thousandfold() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bag.mcap.zstd");
    std::fs::write(&path, [zstd::bulk::compress(&start(), 1).unwrap(), zeros(100)].concat()).unwrap();
    let info = run(folder.path(), &["compare", "--model", "zx30u-arm", "--bag", "bag.mcap.zstd"], 60.0);
    info.refused(&["unpacks to", "the limit for that size is"]);
    Fault {
        group: "Files",
        tried: "a bag packed with zstd that unpacks to 6 GiB",
        outcome: "unpacking ends at 1 GiB and a thousand times the file, in one line",
    }
    .survived(&worst(&[info]));
}

/// A MATLAB file of version 7 with one variable that announces `announced` bytes and unpacks to two gigabytes of zeros.
fn matlab(announced: u32) -> Vec<u8> {
    let mut file = vec![b' '; 124];
    file.extend([0x00, 0x01, b'I', b'M']);
    let compress = |bytes: &[u8]| {
        let mut compress = flate2::Compress::new(flate2::Compression::best(), false);
        let mut packed = Vec::with_capacity(bytes.len() + 100);
        compress.compress_vec(bytes, &mut packed, flate2::FlushCompress::Full).unwrap();
        packed
    };
    // What is flushed in full stands for itself, so it can be repeated.
    let tag = [14_u32.to_le_bytes(), announced.to_le_bytes()].concat();
    let block = compress(&vec![0; 1 << 20]);
    let packed = [&[0x78, 0x01][..], &compress(&tag), &block.repeat(2048)].concat();
    file.extend([15_u32.to_le_bytes(), (packed.len() as u32).to_le_bytes()].concat());
    file.extend(packed);
    file
}

#[test]
fn a_matlab_file_of_two_megabytes_that_unpacks_to_two_gigabytes() {
    let folder = tempfile::tempdir().unwrap();
    let honest = matlab(2_147_483_640);
    assert!((1 << 20..4 << 20).contains(&honest.len()), "{}", honest.len());
    std::fs::write(folder.path().join("honest.mat"), &honest).unwrap();
    std::fs::write(folder.path().join("lying.mat"), matlab(1 << 20)).unwrap();
    let first = run(folder.path(), &["info", "honest.mat"], 10.0);
    first.refused(&["needs 2147483640 bytes of memory", "the limit for that size is"]);
    let second = run(folder.path(), &["info", "lying.mat"], 10.0);
    second.refused(&["it has no real numeric variable"]);
    Fault {
        group: "Files",
        tried: "a MATLAB file of 2 MB that unpacks to 2 GB",
        outcome: "refused by the size that it announces; of more than that nothing is unpacked",
    }
    .survived(&worst(&[first, second]));
}

#[test]
fn a_csv_file_of_200_megabytes_with_an_open_quote() {
    let folder = tempfile::tempdir().unwrap();
    let mut file = std::io::BufWriter::new(std::fs::File::create(folder.path().join("t.csv")).unwrap());
    file.write_all(b"time,x\n0.0,1.0\n0.1,\"2.0\n").unwrap();
    let line = b"0.123456789,1.234567890123456789\n";
    for _ in 0..(200 << 20) / line.len() {
        file.write_all(line).unwrap();
    }
    file.into_inner().unwrap().sync_all().unwrap();
    let open = run(folder.path(), &["info", "t.csv"], 10.0);
    open.refused(&["a line has more than 1048576 bytes", "a quote in it may never be closed"]);
    // One line of 200 MB, and one without end of it.
    std::fs::write(folder.path().join("u.csv"), vec![b'1'; 200 << 20]).unwrap();
    let single = run(folder.path(), &["info", "u.csv"], 10.0);
    single.refused(&["a line has more than 1048576 bytes"]);
    Fault {
        group: "Files",
        tried: "a CSV file of 200 MB with an open quote",
        outcome: "refused after 1 MiB without an end of the row; tables are read row by row",
    }
    .survived(&worst(&[open, single]));
}

#[test]
fn metadata_that_laughs_a_billion_times() {
    let folder = tempfile::tempdir().unwrap();
    let bag = folder.path().join("bag");
    std::fs::create_dir(&bag).unwrap();
    std::fs::write(bag.join("bag_0.mcap"), [start(), end()].concat()).unwrap();
    let mut laughs = "a0: &a0 [lol, lol, lol, lol, lol, lol, lol, lol, lol, lol]\n".to_string();
    for level in 1..12 {
        let aliases = vec![format!("*a{}", level - 1); 10].join(", ");
        laughs.push_str(&format!("a{level}: &a{level} [{aliases}]\n"));
    }
    let mut runs = Vec::new();
    for (number, text) in
        [laughs, "[".repeat(3_000_000), "a: ".repeat(1_000_000), "x".repeat(5 << 20)].iter().enumerate()
    {
        std::fs::write(bag.join("metadata.yaml"), text).unwrap();
        let info = run(folder.path(), &["info", "bag"], 10.0);
        info.refused(&["metadata.yaml"]);
        if number == 3 {
            assert!(info.complaint.contains("5242880 bytes"), "{info:?}");
        }
        runs.push(info);
    }
    Fault {
        group: "Files",
        tried: "metadata.yaml with aliases of aliases, or nested three million deep",
        outcome: "refused in one line; nesting, nodes and repeated nodes are bounded",
    }
    .survived(&worst(&runs));
}

#[test]
fn names_with_escapes_reach_no_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let name = "/state\x1b]0;owned\x07\u{202e}";
    let bag = [
        start(),
        topic(name, "std_msgs/msg/\x1b[2JString", "ros2msg", "string data"),
        message(1, &[0, 1, 0, 0]),
        end(),
    ];
    std::fs::write(folder.path().join("bag.mcap"), bag.concat()).unwrap();
    let compare = run(folder.path(), &["compare", "--model", "zx30u-arm", "--bag", "bag.mcap"], 10.0);
    compare.refused(&[r"/state\u{1b}]0;owned\u{7}\u{202e}"]);
    let acts = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
    assert!(!compare.complaint.chars().any(acts), "{compare:?}");
    Fault {
        group: "Files",
        tried: "terminal escapes in the name of a topic",
        outcome: "errors show them as visible escapes",
    }
    .survived(&[]);
}
