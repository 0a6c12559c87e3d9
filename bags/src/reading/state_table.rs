//! Collects state messages in columns, then sorts them by stamp.

use excavator_model::recording::{CylinderSignals, Recording};
use excavator_msgs::{ArmState, CylinderState};

use super::late_stamps::{count_late, steps_back};
use super::report::{Gap, ReadReport};
use super::same_shape::Numbers;

/// An interval longer than this many median intervals is a gap.
const GAP_FACTOR: f64 = 1.5;
const NANOSECONDS_PER_SECOND: f64 = 1e9;
/// Number of columns per cylinder, and of columns for the whole machine, including the clock.
const CYLINDER_COLUMNS: usize = 8;
const SHARED_COLUMNS: usize = 5;

/// Numbers per cylinder in a message, and for the whole machine.
const CYLINDER_NUMBERS: usize = 7;
const SHARED_NUMBERS: usize = 4;
/// Rows buffered before they are moved to columns. 128 rows of three cylinders are 26 kB, which fit into the L1 cache.
const WAITING_ROWS: usize = 128;

/// The state messages read so far, in the order of the bag.
#[derive(Debug, Default)]
pub struct StateTable {
    stamps: Vec<i64>,
    cylinders: Vec<CylinderSignals>,
    pump_pressure: Vec<f64>,
    tank_pressure: Vec<f64>,
    pump_flow: Vec<f64>,
    oil_temperature: Vec<f64>,
    infinite_values: u64,
    repeated_cylinders: u64,
    /// Numbers of the last messages, row by row; the cylinders are those of the table, in the same order.
    waiting: Vec<f64>,
    /// Whether the last message has the cylinders of the table, in the same order.
    is_regular: bool,
}

impl StateTable {
    /// Adds a message that differs from the last one only in its numbers. `false` if the last one had other cylinders
    /// than the table, or there was none: the caller must then use [`StateTable::push`].
    pub(super) fn push_numbers(&mut self, numbers: Numbers) -> bool {
        if !self.is_regular {
            return false;
        }
        self.stamps.push(numbers.stamp());
        self.waiting.extend(numbers.values());
        if self.waiting.len() >= WAITING_ROWS * self.row_width() {
            self.settle();
        }
        true
    }

    /// Numbers in a message that has the cylinders of the table.
    fn row_width(&self) -> usize {
        CYLINDER_NUMBERS * self.cylinders.len() + SHARED_NUMBERS
    }

    /// Moves the buffered rows to columns.
    fn settle(&mut self) {
        let width = self.row_width();
        let (waiting, infinite) = (&self.waiting, &mut self.infinite_values);
        let shared = [&mut self.pump_pressure, &mut self.tank_pressure, &mut self.pump_flow, &mut self.oil_temperature];
        let of_cylinders =
            self.cylinders.iter_mut().flat_map(|cylinder| cylinder.columns_mut().into_iter().take(CYLINDER_NUMBERS));
        for (index, column) in of_cylinders.chain(shared).enumerate() {
            let values = waiting.chunks_exact(width).filter_map(|row| row.get(index));
            column.extend(values.map(|&value| finite(value, infinite)));
        }
        self.waiting.clear();
    }

    /// Adds one message.
    pub fn push(&mut self, state: &ArmState) {
        self.settle();
        let row = self.stamps.len();
        self.stamps.push(state.header.stamp.nanoseconds());
        let infinite = &mut self.infinite_values;
        push_finite(&mut self.pump_pressure, state.pump_pressure, infinite);
        push_finite(&mut self.tank_pressure, state.tank_pressure, infinite);
        push_finite(&mut self.pump_flow, state.pump_flow, infinite);
        push_finite(&mut self.oil_temperature, state.oil_temperature, infinite);
        for (position, cylinder) in state.cylinders.iter().enumerate() {
            self.push_cylinder(row, position, cylinder);
        }
        let names = state.cylinders.iter().map(|cylinder| &cylinder.name);
        self.is_regular = names.eq(self.cylinders.iter().map(|cylinder| &cylinder.name));
    }

    fn push_cylinder(&mut self, row: usize, position: usize, state: &CylinderState) {
        // The cylinders almost always have the same order in every message.
        let at_position = self.cylinders.get(position).is_some_and(|cylinder| cylinder.name == state.name);
        let known = if at_position {
            Some(position)
        } else {
            self.cylinders.iter().position(|cylinder| cylinder.name == state.name)
        };
        let index = known.unwrap_or_else(|| {
            self.cylinders.push(CylinderSignals { name: state.name.clone(), ..CylinderSignals::default() });
            self.cylinders.len() - 1
        });
        let cylinder = &mut self.cylinders[index];
        if cylinder.displacement.len() > row {
            self.repeated_cylinders += 1;
            return;
        }
        // In message order, as the columns; the command has its own messages.
        let values = [
            state.joint_angle,
            state.displacement,
            state.velocity,
            state.cap_pressure,
            state.rod_pressure,
            state.orifice_area,
            state.rod_force,
        ];
        for (column, value) in cylinder.columns_mut().into_iter().zip(values) {
            // Rows of messages without this cylinder.
            column.resize(row, f64::NAN);
            push_finite(column, value, &mut self.infinite_values);
        }
    }

    /// Bytes that the columns take after adding a message with this many cylinders; includes cylinders that occur in
    /// few messages.
    pub fn memory_with(&self, cylinders: usize) -> u64 {
        let columns = SHARED_COLUMNS + CYLINDER_COLUMNS * cylinders.max(self.cylinders.len());
        (columns * (self.len() + 1) * size_of::<f64>()) as u64
    }

    /// Number of messages.
    pub fn len(&self) -> usize {
        self.stamps.len()
    }

    /// Whether there is no message yet.
    pub fn is_empty(&self) -> bool {
        self.stamps.is_empty()
    }

    /// The recording named `source`, with its clock in ns since the epoch; adds the counts of corrections to `report`.
    pub fn into_recording(mut self, source: &str, report: &mut ReadReport) -> (Recording, Vec<i64>) {
        self.settle();
        report.infinite_values += self.infinite_values;
        report.repeated_cylinders = self.repeated_cylinders;
        let samples = self.stamps.len();
        for cylinder in &mut self.cylinders {
            for column in cylinder.columns_mut() {
                column.resize(samples, f64::NAN);
            }
        }
        if !self.stamps.is_sorted_by(|earlier, later| earlier < later) {
            self.sort(report);
        }
        let start = self.stamps.first().copied().unwrap_or_default();
        // Division, not multiplication by 1e-9: it yields the double nearest to the decimal number.
        let time: Vec<f64> = self.stamps.iter().map(|&stamp| (stamp - start) as f64 / NANOSECONDS_PER_SECOND).collect();
        let recording = Recording {
            source: source.to_string(),
            start_nanoseconds: start,
            time,
            cylinders: self.cylinders,
            pump_pressure: self.pump_pressure,
            tank_pressure: self.tank_pressure,
            pump_flow: self.pump_flow,
            oil_temperature: self.oil_temperature,
        };
        report.gaps = gaps(&recording);
        (recording, self.stamps)
    }

    /// Sorts the rows by stamp, and keeps only the first of each stamp.
    fn sort(&mut self, report: &mut ReadReport) {
        report.reordered = count_late(&self.stamps);
        report.notes.extend(steps_back(&self.stamps));
        let order = rows_by_stamp(&self.stamps);
        report.duplicates = (self.stamps.len() - order.len()) as u64;
        self.stamps = order.iter().map(|&row| self.stamps[row]).collect();
        let shared = [&mut self.pump_pressure, &mut self.tank_pressure, &mut self.pump_flow, &mut self.oil_temperature];
        for column in shared.into_iter().chain(self.cylinders.iter_mut().flat_map(CylinderSignals::columns_mut)) {
            *column = order.iter().map(|&row| column[row]).collect();
        }
    }
}

fn push_finite(column: &mut Vec<f64>, value: f64, infinite_values: &mut u64) {
    column.push(finite(value, infinite_values));
}

/// The value; `NaN` for an infinite one, which is counted.
fn finite(value: f64, infinite_values: &mut u64) -> f64 {
    *infinite_values += u64::from(value.is_infinite());
    if value.is_infinite() { f64::NAN } else { value }
}

/// Row indices in order of stamp; of rows with equal stamps only the first.
fn rows_by_stamp(stamps: &[i64]) -> Vec<usize> {
    let mut rows: Vec<usize> = (0..stamps.len()).collect();
    rows.sort_by_key(|&row| stamps[row]);
    rows.dedup_by_key(|row| stamps[*row]);
    rows
}

/// Gaps in the clock of the recording.
pub(crate) fn gaps(recording: &Recording) -> Vec<Gap> {
    let limit = GAP_FACTOR * recording.sample_interval();
    let steps = recording.time.windows(2).map(|pair| Gap { after: pair[0], length: pair[1] - pair[0] });
    steps.filter(|step| step.length > limit).collect()
}
