//! The targets.

mod bag;
mod can;
mod formula;
mod map;
mod message;
mod schema;
mod table;
mod yaml;

/// Something that reads other people's bytes.
pub struct Target {
    /// As it is asked for.
    pub name: &'static str,
    /// Reads the bytes; whether they made sense.
    ///
    /// Panics when what is read breaks a promise: that is what is looked for.
    pub run: fn(&[u8]) -> bool,
    /// Good bytes: they must make sense.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Changed seeds in a run of seconds; a long run has a hundred times as many.
    pub cases: usize,
    /// Memory that may be taken, bytes: so much for each byte of the input, and so much on top.
    pub memory: (usize, usize),
}

const MB: usize = 1 << 20;

/// All targets.
pub const TARGETS: [Target; 14] = [
    Target { name: "message", run: message::run, seeds: message::seeds, cases: 2_000, memory: (100, MB) },
    Target { name: "schema", run: schema::run, seeds: schema::seeds, cases: 3_000, memory: (200, MB) },
    Target { name: "map", run: map::run, seeds: map::seeds, cases: 300, memory: (200, 8 * MB) },
    Target { name: "text-table", run: table::text, seeds: table::text_seeds, cases: 800, memory: (400, MB) },
    // What `ReadLimits` allow, and the copies that a guess has of it.
    Target { name: "matlab", run: table::matlab, seeds: table::matlab_seeds, cases: 1_000, memory: (400, 128 * MB) },
    Target { name: "parquet", run: table::parquet, seeds: table::parquet_seeds, cases: 800, memory: (400, 160 * MB) },
    Target { name: "sheet", run: table::sheet, seeds: table::sheet_seeds, cases: 500, memory: (400, 160 * MB) },
    Target { name: "mcap", run: bag::run, seeds: bag::mcap_seeds, cases: 60, memory: (200, 64 * MB) },
    Target { name: "sqlite", run: bag::run, seeds: bag::sqlite_seeds, cases: 15, memory: (200, 64 * MB) },
    Target { name: "packed", run: bag::run, seeds: bag::packed_seeds, cases: 30, memory: (200, 64 * MB) },
    Target { name: "can-database", run: can::database, seeds: can::database_seeds, cases: 600, memory: (400, MB) },
    Target { name: "can-log", run: can::log, seeds: can::log_seeds, cases: 1_000, memory: (100, MB) },
    Target { name: "formula", run: formula::run, seeds: formula::seeds, cases: 2_000, memory: (1_000, 4 * MB) },
    Target { name: "yaml", run: yaml::run, seeds: yaml::seeds, cases: 2_000, memory: (1_000, 4 * MB) },
];
