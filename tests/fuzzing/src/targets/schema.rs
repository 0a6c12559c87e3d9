//! Text as a message definition in both languages, and, after a zero byte, a message of the type that it defines.

use rosbag2::dynamic::{Definitions, Layout, Selector, numeric_leaves};

const IDL: &str = "module p { module msg { const long N = 3; typedef double d3[3]; enum E { A, B }; struct Root { \
                   @unit(value=\"m\") d3 x; sequence<p::msg::B, 3> b; string<4> s; wstring w; boolean on; }; \
                   struct B { octet o; unsigned long long t; float f[2][2]; }; }; };";
const MSG: &str = "std_msgs/Header header\nfloat64[3] x [1.0, 2.0, 3.0] # m\nB[<=3] b\nstring<=4 s \"a\"\nint8 A=3\nbool[] on\n\
                   ================================================================================\nMSG: p/B\nbyte o\nuint64 t";

pub fn run(bytes: &[u8]) -> bool {
    let mut halves = bytes.splitn(2, |&byte| byte == 0);
    let text = String::from_utf8_lossy(halves.next().unwrap_or_default());
    let message = [&[0, 1, 0, 0], halves.next().unwrap_or_default()].concat();
    let mut understood = false;
    for encoding in ["ros2msg", "ros2idl"] {
        let Ok(definitions) = Definitions::from_schema("p/msg/Root", encoding, &text) else { continue };
        let Ok(layout) = Layout::build("p/Root", &[&definitions]) else { continue };
        understood = true;
        let _ = layout.check(&message);
        for path in numeric_leaves(&layout, &message).unwrap_or_default() {
            if let Ok(selector) = Selector::number(&layout, &path) {
                let _ = selector.read(&layout, &message);
            }
        }
    }
    understood
}

pub fn seeds() -> Vec<Vec<u8>> {
    // Two elements, a text, and zeros for what follows.
    let mut body = vec![0; 16];
    body.extend([1, 0, 0, 0, b'a', 0, 0, 0]);
    body.extend(1.5_f64.to_le_bytes().repeat(3));
    body.extend([2, 0, 0, 0]);
    body.extend([0; 80]);
    [IDL, MSG].map(|text| [text.as_bytes(), &[0], &body].concat()).to_vec()
}
