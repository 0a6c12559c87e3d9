//! CAN frames in bags, read with a DBC file.

use crate::support::{self, Frame};
use std::path::{Path, PathBuf};

use excavator_bags::map::{TopicMap, guess, read_mapped};
use rosbag2::{BagWriter, TopicToWrite, WriteOptions, cdr};

const MS: i64 = 1_000_000;
const START: i64 = 1_790_000_000_000_000_000;

const DBC: &str = r#"VERSION ""

BU_: ECU

BO_ 256 ArmPressures: 8 ECU
 SG_ CapPressure : 0|16@1+ (0.1,0) [0|4000] "bar" ECU
 SG_ RodPressure : 16|16@1- (0.1,0) [0|0] "bar" ECU

BO_ 2566844926 ArmMotion: 4 ECU
 SG_ Position : 7|16@0- (0.05,0) [0|0] "mm" ECU
 SG_ Odd : 16|8@1+ (1,0) [0|0] "furlong" ECU
"#;

struct Bag {
    folder: tempfile::TempDir,
}

impl Bag {
    /// A second of a bus: pressures at 100 Hz, motion at 50 Hz, other frames between, a remote and an error frame, a short one.
    fn new(schema: &str) -> Bag {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("machine.dbc"), DBC).unwrap();
        let mut bag = BagWriter::create(&folder.path().join("bag"), &WriteOptions::default()).unwrap();
        let topic = TopicToWrite {
            name: "/can0".to_string(),
            type_name: "can_msgs/msg/Frame".to_string(),
            schema: schema.to_string(),
            qos: Vec::new(),
        };
        let topic = bag.add_topic(&topic).unwrap();
        let mut write = |at: i64, id: u32, is_extended: bool, flags: (bool, bool), data: &[u8]| {
            let mut bytes = [0xff; 8];
            bytes[..data.len()].copy_from_slice(data);
            let frame = Frame {
                header: support::header(at),
                id,
                is_rtr: flags.0,
                is_extended,
                is_error: flags.1,
                dlc: data.len() as u8,
                data: bytes,
            };
            bag.write(topic, at as u64, at as u64, &cdr::encode(&frame).unwrap()).unwrap();
        };
        for i in 0..100_i64 {
            let now = START + 10 * i * MS;
            let mut pressures = ((1000 + i) as u16).to_le_bytes().to_vec();
            pressures.extend((-(i as i16)).to_le_bytes());
            write(now, 256, false, (false, false), &pressures);
            // The same number in 29 bits is another frame.
            write(now + MS, 256, true, (false, false), &[9; 8]);
            write(now + 2 * MS, 0x77, false, (false, false), &[1; 3]);
            if i % 2 == 0 {
                // A driver that leaves its flags in the identifier.
                let id = 2_566_844_926 | 0x8000_0000;
                write(now + 3 * MS, id, true, (false, false), &((i * 10) as i16).to_be_bytes().repeat(2));
            }
        }
        write(START + 995 * MS, 256, false, (true, false), &[]);
        write(START + 996 * MS, 256, false, (false, true), &[0; 8]);
        write(START + 997 * MS, 256, false, (false, false), &[1]);
        bag.finish().unwrap();
        Bag { folder }
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("bag")
    }

    fn map(&self, signals: &str) -> Result<TopicMap, String> {
        let path = self.folder.path().join("map.toml");
        std::fs::write(&path, format!("dbc = \"machine.dbc\"\n{signals}")).unwrap();
        TopicMap::read(&path).map_err(|error| error.to_string())
    }

    fn error(&self, signals: &str) -> String {
        let map = match self.map(signals) {
            Ok(map) => map,
            Err(error) => return error,
        };
        read_mapped(&self.path(), &map).unwrap_err().to_string()
    }
}

fn signal(signal: &str, message: &str, field: &str, more: &str) -> String {
    format!(
        "[[signals]]\nsignal = \"{signal}\"\ntopic = \"/can0\"\nmessage = \"{message}\"\nfield = \"{field}\"\n{more}\n"
    )
}

const SCHEMA: &str =
    "std_msgs/Header header\nuint32 id\nbool is_rtr\nbool is_extended\nbool is_error\nuint8 dlc\nuint8[8] data";

#[test]
fn signals_of_frames_are_signals() {
    // With its definition in the bag, and without.
    for schema in [SCHEMA, ""] {
        let bag = Bag::new(schema);
        let signals = signal("arm.cap_pressure", "ArmPressures", "CapPressure", "")
            + &signal("arm.rod_pressure", "ArmPressures", "RodPressure", "sign = -1")
            + &signal("arm.displacement", "ArmMotion", "Position", "offset = \"-10 mm\"");
        let (recording, report) = read_mapped(&bag.path(), &bag.map(&signals).unwrap()).unwrap();
        // The clock is the frame that comes most often, not everything on the bus.
        assert_eq!(recording.len(), 101);
        let arm = recording.cylinder("arm").unwrap();
        for i in 0..100 {
            assert!((arm.cap_pressure[i] - (1000 + i) as f64 * 1e4).abs() < 1e-6, "{i}: {}", arm.cap_pressure[i]);
            assert!((arm.rod_pressure[i] - i as f64 * 1e4).abs() < 1e-6);
        }
        // At 50 Hz and 3 ms later: 0.5 mm in 10 ms, less 0.15 mm.
        assert!((arm.displacement[50] - (25.0 - 0.15 - 10.0) * 1e-3).abs() < 1e-9, "{}", arm.displacement[50]);
        assert!(report.notes.iter().any(|note| note.contains("/can0: 1 frames are shorter")), "{:?}", report.notes);
        // And in formulas.
        let names = "[names]\np = { topic = \"/can0\", message = \"ArmPressures\", field = \"CapPressure\" }\n";
        let formula = format!("{names}[[signals]]\nsignal = \"pump_pressure\"\nformula = \"2 * p\"\nunit = \"bar\"\n");
        let (recording, _) = read_mapped(&bag.path(), &bag.map(&formula).unwrap()).unwrap();
        assert!((recording.pump_pressure[10] - 2.0 * 101.0 * 1e5).abs() < 1e-4, "{}", recording.pump_pressure[10]);
    }
}

#[test]
fn what_does_not_fit_is_told_in_one_line() {
    let bag = Bag::new(SCHEMA);
    for (signals, parts) in [
        (
            signal("arm.cap_pressure", "Pressures", "CapPressure", ""),
            &["no message Pressures", "ArmPressures, ArmMotion"][..],
        ),
        (signal("arm.cap_pressure", "ArmPressures", "Cap", ""), &["no signal Cap", "CapPressure, RodPressure"]),
        (signal("arm.displacement", "ArmPressures", "CapPressure", ""), &["is a length, but bar is a pressure"]),
        (signal("arm.displacement", "ArmMotion", "Odd", ""), &["\"furlong\" is no unit"]),
        (signal("arm.cap_pressure", "ArmPressures", "CapPressure", "column = 1"), &["either `topic` and `field`"]),
        ("[[signals]]\nsignal = \"arm.displacement\"\ncolumn = 1\nmessage = \"M\"\n".to_string(), &["`message` needs"]),
    ] {
        let error = bag.error(&signals);
        assert!(parts.iter().all(|part| error.contains(part)) && !error.contains('\n'), "{error}");
    }
    let without: Result<TopicMap, _> = signal("arm.cap_pressure", "ArmPressures", "CapPressure", "").parse();
    assert!(without.unwrap_err().to_string().contains("put `dbc = \"FILE.dbc\"`"));
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("samples/arm-swing");
    let map = signal("arm.cap_pressure", "ArmPressures", "CapPressure", "").replace("/can0", "/arm/state");
    let error = read_mapped(&sample, &bag.map(&map).unwrap()).unwrap_err().to_string();
    assert!(error.contains("topic /arm/state carries excavator_msgs/msg/ArmState, not CAN frames"), "{error}");
    std::fs::remove_file(bag.folder.path().join("machine.dbc")).unwrap();
    let error = bag.error(&signal("arm.cap_pressure", "ArmPressures", "CapPressure", ""));
    assert!(error.contains("machine.dbc"), "{error}");
}

#[test]
fn a_guess_says_what_frames_need() {
    let guessed = guess(&Bag::new(SCHEMA).path(), "arm").unwrap();
    assert!(guessed.signals.is_empty() && guessed.left[0].contains("/can0 (CAN frames"), "{guessed:?}");
}
