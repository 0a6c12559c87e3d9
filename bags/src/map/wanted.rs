//! The values to read from the data for a map: its signals, and the inputs of its formulas.

use std::borrow::Cow;
use std::path::Path;

use excavator_model::formula::ColumnFormula;

use super::clock_source::ColumnName;
use super::conversion::Conversion;
use super::document::TopicMap;
use super::error::MapError;
use super::named::NamedColumn;
use super::signal::SignalKind;
use super::signal_source::{Resampling, SignalSource};

/// Values to read: those of a signal, or of a name in formulas.
#[derive(Debug, Clone)]
pub(super) struct Wanted<'m> {
    /// The signal or the name.
    pub label: String,
    /// The signal; `None` for a name.
    pub signal: Option<&'m SignalSource>,
    /// Their source and their stamps.
    pub from: Cow<'m, NamedColumn>,
}

impl<'m> Wanted<'m> {
    fn signal(source: &'m SignalSource) -> Wanted<'m> {
        let SignalSource { topic, field, message, column, file, unit, stamp, .. } = source.clone();
        let usual = (source.signal.kind == SignalKind::OrificeCommand).then_some(Resampling::Hold);
        let from = NamedColumn {
            column,
            file,
            topic,
            field,
            message,
            unit,
            stamp,
            time_shift: source.time_shift,
            resample: source.resample.or(usual),
            maximum_gap: source.maximum_gap,
        };
        Wanted { label: source.signal.to_string(), signal: Some(source), from: Cow::Owned(from) }
    }

    fn name(name: &str, named: &'m NamedColumn) -> Wanted<'m> {
        Wanted { label: name.to_string(), signal: None, from: Cow::Borrowed(named) }
    }

    fn heading(heading: &str) -> Wanted<'m> {
        let column = NamedColumn::column(ColumnName::Name(heading.to_string()));
        Wanted { label: heading.to_string(), signal: None, from: Cow::Owned(column) }
    }

    /// The conversion from a number in a cell or message; `unit` is that of the heading or of the DBC file.
    pub fn conversion(&self, unit: Option<&str>) -> Result<Conversion, MapError> {
        match self.signal {
            Some(source) => Conversion::of(source, unit),
            None => Conversion::of_name(&self.label, self.from.unit.as_deref()),
        }
    }

    /// Offset added to stamps, ns.
    pub fn shift(&self) -> i64 {
        (self.from.time_shift.unwrap_or(0.0) * 1e9).round() as i64
    }

    /// Interpolation between measurements.
    pub fn resampling(&self) -> Resampling {
        self.from.resample.unwrap_or(Resampling::Linear)
    }

    /// The file of the column, if the map gives it.
    pub fn file(&self) -> Option<&Path> {
        self.from.file.as_deref()
    }
}

/// A signal computed by a formula.
#[derive(Debug, Clone)]
pub(super) struct Computed<'m> {
    pub source: &'m SignalSource,
    pub formula: ColumnFormula,
    /// Labels of the formula inputs, in order.
    pub inputs: Vec<String>,
    /// From the value of the formula to that of the signal.
    pub conversion: Conversion,
}

/// Maximum number of names listed in an error.
const LISTED: usize = 12;

/// What to read, and what to compute from it. `headings` are the columns that formulas may refer to by heading.
///
/// # Errors
/// [`MapError::Formula`], and errors of [`Conversion::of`].
pub(super) fn wanted<'m>(
    map: &'m TopicMap,
    headings: &[String],
) -> Result<(Vec<Wanted<'m>>, Vec<Computed<'m>>), MapError> {
    let read = |source: &&SignalSource| source.value.is_none() && source.formula.is_none();
    let mut wanted: Vec<Wanted<'m>> = map.signals.iter().filter(read).map(Wanted::signal).collect();
    wanted.extend(map.names.iter().map(|(name, named)| Wanted::name(name, named)));
    // Names of the map come first, then signals, then headings: what the map defines takes precedence.
    let mut names: Vec<String> = map.names.keys().cloned().collect();
    let known = map.signals.iter().filter(|source| source.formula.is_none());
    let signals = known.map(|source| source.signal.to_string());
    for name in signals.chain(headings.iter().cloned()).filter(|name| ColumnFormula::can_name(name)) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let mut computed: Vec<Computed<'m>> = Vec::new();
    for source in &map.signals {
        let Some(text) = &source.formula else { continue };
        let formula = ColumnFormula::read(text, &names).map_err(|error| MapError::Formula {
            signal: source.signal.to_string(),
            source: Box::new(error),
            known: names.iter().take(LISTED).cloned().collect(),
        })?;
        let inputs: Vec<String> = formula.inputs().into_iter().filter_map(|input| names.get(input).cloned()).collect();
        for input in &inputs {
            let is_constant = map.signals.iter().any(|s| s.value.is_some() && s.signal.to_string() == *input);
            if !is_constant && !wanted.iter().any(|wanted| wanted.label == *input) {
                wanted.push(Wanted::heading(input));
            }
        }
        computed.push(Computed { source, formula, inputs, conversion: Conversion::of(source, None)? });
    }
    Ok((wanted, computed))
}
