//! The dashboard's server without a graph: the page, its stream, and a page that does not read.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;

use crate::LONGEST_WAIT;
use excavator_msgs::common::{DiagnosticArray, DiagnosticStatus};
use excavator_msgs::{ArmState, CylinderState, Header};
use excavator_nodes::dashboard::{Board, Hosts, serve};

/// A server on a free port; it ends with the test process.
fn server() -> (Arc<Board>, SocketAddr) {
    let board = Arc::new(Board::default());
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let own = Arc::clone(&board);
    std::thread::spawn(move || {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(serve(listener, own, Hosts::default(), std::future::pending())).unwrap();
    });
    (board, address)
}

fn get(address: SocketAddr, path: &str) -> TcpStream {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(LONGEST_WAIT)).unwrap();
    write!(stream, "GET {path} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n").unwrap();
    stream
}

/// Reads until `text` has come.
fn read_until(stream: &mut TcpStream, text: &str) -> String {
    let (mut read, mut bytes) = (Vec::new(), [0; 4096]);
    loop {
        let all = String::from_utf8_lossy(&read).into_owned();
        if all.contains(text) {
            return all;
        }
        let count = stream.read(&mut bytes).expect("more comes");
        assert!(count > 0, "ended before {text}: {all}");
        read.extend_from_slice(&bytes[..count]);
    }
}

fn state(displacement: f64) -> ArmState {
    let mut arm = CylinderState::unmeasured("arm");
    arm.displacement = displacement;
    ArmState {
        header: Header::default(),
        cylinders: vec![arm],
        pump_pressure: 1e6,
        tank_pressure: f64::NAN,
        pump_flow: f64::NAN,
        oil_temperature: f64::NAN,
    }
}

#[test]
fn the_page_carries_everything_and_asks_nobody_else() {
    let (_, address) = server();
    let page = read_until(&mut get(address, "/"), "</html>");
    assert!(page.starts_with("HTTP/1.1 200") && page.contains("text/html"));
    for part in ["uPlot", "EventSource", "id=\"picture\"", "id=\"alarms\"", "Permission is hereby granted"] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("/*SCRIPT*/") && !page.contains("<link") && !page.contains("src="));
}

#[test]
fn the_stream_carries_states_and_alarms() {
    let (board, address) = server();
    let mut stream = get(address, "/stream");
    read_until(&mut stream, "text/event-stream");
    let status = |level| DiagnosticStatus {
        level,
        name: "energy_monitor: passivity".into(),
        message: "not closed".into(),
        hardware_id: String::new(),
        values: vec![],
    };
    board.take_state(state(0.125));
    board.take_health(DiagnosticArray { header: Header::default(), status: vec![status(1)] });
    board.frame();
    let frame = read_until(&mut stream, "\n\n");
    assert!(frame.contains("\"displacement\":0.125") && frame.contains("not closed"), "{frame}");
    // What is not measured is null, and what is well again is no alarm.
    assert!(frame.contains("\"cap_pressure\":null"), "{frame}");
    board.take_health(DiagnosticArray { header: Header::default(), status: vec![status(0)] });
    board.frame();
    let frame = read_until(&mut stream, "\"number\":2");
    assert!(!frame.contains("not closed"), "{frame}");
}

#[test]
fn a_page_that_does_not_read_misses_frames_and_the_others_get_theirs() {
    let (board, address) = server();
    let mut asleep = get(address, "/stream");
    read_until(&mut asleep, "text/event-stream");
    let mut awake = get(address, "/stream");
    read_until(&mut awake, "text/event-stream");
    // Far more than sockets buffer.
    const FRAMES: usize = 60_000;
    for number in 0..FRAMES {
        board.take_state(state(number as f64));
        let frame = board.frame();
        if number % 1000 == 0 {
            read_until(&mut awake, frame.split("\"number\":").nth(1).unwrap().split(',').next().unwrap());
        }
    }
    // The history is the last 750 frames, not all of them.
    let mut history = String::new();
    get(address, "/history").read_to_string(&mut history).unwrap();
    assert_eq!(history.matches("\"number\":").count(), 750);
    // The sleeper wakes up: what it gets are frames from before and the newest, not all in between.
    board.frame();
    let got = read_until(&mut asleep, &format!("\"number\":{}", FRAMES + 1)).matches("\"number\":").count();
    println!("the sleeper got {got} of {FRAMES} frames");
    assert!(got < FRAMES / 2, "{got}");
}
