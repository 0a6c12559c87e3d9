//! What the owner of a table says of one of its columns.

use serde::Deserialize;

use super::super::quantity::Quantity;
use super::super::signal::SignalKind;

/// What the owner of a table says of one of its columns, as in `[columns.Position]` of a data sheet.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SheetColumn {
    /// What it measures: the name of a signal without its cylinder, or `input` for the input of the drive.
    pub signal: SheetSignal,
    /// Scale of the transducer: `"20 mm/V"`.
    #[serde(default)]
    pub scale: Option<Quantity>,
    /// Where a displacement counts from; without, from mid-stroke.
    #[serde(default)]
    pub zero: Option<ZeroAt>,
    /// -1 turns the direction around.
    #[serde(default)]
    pub sign: Option<i8>,
}

/// A kind of signal by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct SheetSignal(pub(super) SignalKind);

impl TryFrom<String> for SheetSignal {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        // Whether an input was measured or commanded follows from its noise.
        let kind = if name == "input" { "orifice_command" } else { &*name };
        SignalKind::ALL.into_iter().find(|known| known.name() == kind).map(SheetSignal).ok_or_else(|| {
            let known: Vec<&str> = SignalKind::ALL.iter().map(|kind| kind.name()).collect();
            format!("\"{name}\" is not a signal; signals are input, {}", known.join(", "))
        })
    }
}

/// Where a displacement is zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ZeroAt {
    /// Where the rod is fully in.
    Retracted,
    /// Where the rod is fully out; the numbers grow as the rod moves in.
    Extended,
    /// At mid-stroke.
    Middle,
}
