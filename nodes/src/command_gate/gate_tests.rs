use super::*;
use excavator_msgs::{Header, Time};

const TIMEOUT: Duration = Duration::from_millis(100);
const NOW: i64 = 1_800_000_000_000_000_000;
const MAXIMUM: f64 = 1e-4;

struct Bench {
    gate: Gate,
    start: Instant,
    now: Instant,
}

fn writer(number: u8) -> Writer {
    Writer { guid: [number; 16], node: Some(format!("/operator{number}")), addresses: Vec::new() }
}

fn command(pairs: &[(&str, f64)]) -> OrificeCommand {
    OrificeCommand {
        header: Header { stamp: Time::from_nanoseconds(NOW).unwrap_or_default(), frame_id: String::new() },
        names: pairs.iter().map(|pair| pair.0.to_string()).collect(),
        areas: pairs.iter().map(|pair| pair.1).collect(),
    }
}

impl Bench {
    /// Valves "boom" and "arm"; source 0 is "autonomy" (priority 0), source 1 "remote" (priority 10).
    fn new() -> Self {
        Bench::with(AllowList::default(), false)
    }

    fn with(allowed: AllowList, neutral_at_start: bool) -> Self {
        let valve = |name: &str| Valve { name: name.to_string(), maximum_area: MAXIMUM };
        let source = |name: &str, priority| Source { name: name.to_string(), priority, topic: format!("/{name}") };
        let stamps = StampLimits { max_age: 0.5, accept_unstamped: false };
        let start = Instant::now();
        let gate = Gate::new(
            vec![valve("boom"), valve("arm")],
            vec![source("autonomy", 0), source("remote", 10)],
            allowed,
            Settings { timeout: TIMEOUT, stamps },
            neutral_at_start,
            start,
        );
        Bench { gate, start, now: start }
    }

    fn at(&mut self, milliseconds: u64) -> &mut Self {
        self.now = self.start + Duration::from_millis(milliseconds);
        self
    }

    fn sends(&mut self, number: u8, source: usize, pairs: &[(&str, f64)]) -> Result<(), &'static str> {
        let (writer, command) = (writer(number), command(pairs));
        let order = Order { command: &command, source, writer: &writer };
        self.gate.take(order, self.now, &[NOW]).map_err(|refusal| refusal.kind())
    }

    /// Areas of boom and arm in 1e-5 m2.
    fn areas(&mut self) -> Vec<f64> {
        self.gate.advance(self.now);
        self.gate.wanted().map(|wanted| (wanted.area * 1e7).round() / 100.0).collect()
    }
}

#[test]
fn a_command_holds_until_its_lease_runs_out() {
    let mut bench = Bench::new();
    assert_eq!(bench.areas(), [0.0, 0.0]);
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Ok(()));
    assert_eq!(bench.at(100).areas(), [0.0, 5.0]);
    assert_eq!(bench.at(101).areas(), [0.0, 0.0]);
    assert!(bench.gate.wanted().all(|wanted| wanted.closing));
}

#[test]
fn a_silent_operator_is_not_kept_alive_by_another_one() {
    for others in [&[("boom", 0.0)][..], &[]] {
        let mut bench = Bench::new();
        assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Ok(()));
        for time in (20..=200).step_by(20) {
            assert_eq!(bench.at(time).sends(2, 0, others), Ok(()));
        }
        assert_eq!(bench.areas(), [0.0, 0.0], "{others:?}");
    }
}

#[test]
fn what_its_owner_does_not_name_keeps_its_command() {
    let mut bench = Bench::new();
    assert_eq!(bench.sends(1, 0, &[("boom", 1e-5)]), Ok(()));
    for time in (0..2450).step_by(50) {
        assert_eq!(bench.at(time).sends(1, 0, &[("arm", 2e-5)]), Ok(()));
    }
    assert_eq!(bench.areas(), [1.0, 2.0]);
}

#[test]
fn one_valve_has_one_owner() {
    let mut bench = Bench::new();
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Ok(()));
    assert_eq!(bench.at(50).sends(2, 0, &[("arm", -5e-5)]), Err("owned by another writer"));
    assert_eq!(bench.sends(2, 0, &[("boom", 1e-5), ("arm", 0.0)]), Err("owned by another writer"));
    assert_eq!(bench.areas(), [0.0, 5.0], "half of a command is none");
    assert_eq!(bench.sends(2, 0, &[("boom", 1e-5)]), Ok(()), "another valve is free");
    assert_eq!(bench.areas(), [1.0, 5.0]);
}

#[test]
fn a_higher_priority_takes_over_and_a_lower_one_does_not() {
    let mut bench = Bench::new();
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Ok(()));
    assert_eq!(bench.sends(2, 1, &[("arm", -3e-5)]), Ok(()));
    assert_eq!(bench.areas(), [0.0, -3.0]);
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Err("owned by another writer"));
}

#[test]
fn a_valve_that_was_closed_stays_closed_until_it_is_asked_to() {
    let mut bench = Bench::new();
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Ok(()));
    bench.at(150);
    for number in [1, 2] {
        assert_eq!(bench.sends(number, 1, &[("arm", 5e-5)]), Err("neutral first"));
    }
    assert_eq!(bench.areas(), [0.0, 0.0]);
    assert_eq!(bench.sends(2, 0, &[("arm", 0.5e-7)]), Ok(()), "a lever in neutral is not quite at zero");
    assert_eq!(bench.sends(2, 0, &[("arm", 5e-5)]), Ok(()));
    assert_eq!(bench.areas(), [0.0, 5.0]);
}

#[test]
fn the_first_command_may_have_to_be_neutral_too() {
    let mut bench = Bench::with(AllowList::default(), true);
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Err("neutral first"));
    assert_eq!(bench.sends(1, 0, &[("arm", 0.0)]), Ok(()));
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Ok(()));
}

#[test]
fn a_stop_closes_everything_and_neutral_during_it_does_not_count() {
    let mut bench = Bench::new();
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Ok(()));
    bench.gate.stop.take(true, &writer(7), |_| false, bench.now);
    assert_eq!(bench.areas(), [0.0, 0.0]);
    assert_eq!(bench.sends(1, 1, &[("arm", 0.0)]), Err("stopped"));
    bench.gate.stop.take(false, &writer(7), |_| false, bench.now);
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Err("neutral first"));
    let closed = bench.gate.status(bench.now)[1].closed.clone();
    assert_eq!(closed, Some(("the machine was stopped by /operator7".to_string(), Duration::ZERO)));
    assert_eq!(bench.sends(1, 0, &[("arm", 0.0)]), Ok(()));
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Ok(()));
}

#[test]
fn strangers_and_stale_commands_change_nothing() {
    let allowed = AllowList::parse(&["/operator1".to_string()]).unwrap_or_default();
    let mut bench = Bench::with(allowed, false);
    assert_eq!(bench.sends(2, 1, &[("arm", 5e-5)]), Err("writer not allowed"));
    let mut stale = command(&[("arm", 5e-5)]);
    stale.header.stamp = Time { sec: 1, nanosec: 0 };
    let order = Order { command: &stale, source: 0, writer: &writer(1) };
    assert_eq!(bench.gate.take(order, bench.now, &[NOW]).map_err(|refusal| refusal.kind()), Err("too old"));
    assert_eq!(bench.areas(), [0.0, 0.0]);
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Ok(()));
}

#[test]
fn a_refused_command_does_not_renew_the_lease() {
    let mut bench = Bench::new();
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Ok(()));
    for time in (20..=200).step_by(20) {
        assert_eq!(bench.at(time).sends(1, 0, &[("arm", f64::NAN)]), Err("malformed"));
    }
    assert_eq!(bench.areas(), [0.0, 0.0]);
}

#[test]
fn a_node_that_is_not_active_leaves_closed_valves_and_follows_nobody() {
    let mut bench = Bench::new();
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Ok(()));
    bench.gate.shut(true, bench.now);
    assert_eq!(bench.areas(), [0.0, 0.0]);
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Err("not active"));
    bench.gate.shut(false, bench.now);
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Err("neutral first"));
    assert_eq!(bench.sends(1, 0, &[("arm", 0.0)]), Ok(()));
    assert_eq!(bench.sends(1, 0, &[("arm", 5e-5)]), Ok(()));
}
