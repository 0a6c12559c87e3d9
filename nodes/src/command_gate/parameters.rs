//! Parameters of the gate, for every node that drives valves.

use excavator_ros::{Parameter, Value};

/// All parameters, with units, ranges and defaults.
pub(crate) fn parameters() -> Vec<Parameter> {
    let double = |name, value, description| Parameter::new(name, Value::Double(value), description);
    let flag = |name, value, description| Parameter::new(name, Value::Boolean(value), description);
    let texts = |name, values: &[&str], description| {
        let values = values.iter().map(|value| value.to_string()).collect();
        Parameter::new(name, Value::StringArray(values), description).read_only()
    };
    vec![
        double("command_timeout", 0.1, "time for which a command holds, on the steady clock of this side [s]")
            .within(0.001, 10.0),
        double(
            "command_max_age",
            0.5,
            "largest age of a command by its stamp [s]; above what a loaded network takes, below what a person notices",
        )
        .within(0.01, 3600.0),
        flag("accept_unstamped", false, "follow commands whose stamp is empty; their age is unknown"),
        texts(
            "command_sources",
            &["operator:0:arm/orifice_command"],
            "topics that commands come on, NAME:PRIORITY:TOPIC; a higher priority takes a valve over",
        ),
        texts(
            "command_writers",
            &[],
            "who may command: full node names, IP addresses or GUID prefixes; empty: everybody",
        ),
        Parameter::new(
            "area_limits",
            Value::DoubleArray(Vec::new()),
            "largest area that may be commanded, per cylinder [m2]; empty: what the valve opens",
        )
        .within(0.0, 1.0)
        .read_only(),
        double(
            "opening_time",
            0.05,
            "least time from closed to fully open [s]: limits the rate of every commanded opening; a fast spool takes as long",
        )
        .within(0.001, 10.0)
        .read_only(),
        double("closing_time", 0.05, "time in which a fully open valve closes when its command has run out [s]")
            .within(0.001, 5.0)
            .read_only(),
        flag(
            "neutral_at_start",
            false,
            "an area of 0 has to be commanded before a valve opens for the first time; set it where a real machine moves",
        )
        .read_only(),
        flag("stop", false, "stop the machine; going back to false releases every stop"),
        double(
            "stop_heartbeat",
            0.0,
            "stop the machine when /arm/stop is silent for this time [s]; 0: no heartbeat is needed",
        )
        .within(0.0, 60.0),
    ]
}
