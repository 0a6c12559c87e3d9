//! The procedures of \[B\] Section IV on recordings. They read the properties of a valve and its cylinder from measurements,
//! without a simulation.
//!
//! | procedure | from | \[B\] |
//! |---|---|---|
//! | [`valve_leakage`] | pressures while the valve is closed | Eq. 12-15 |
//! | [`dead_zones`] | flow over root of the pressure drop while the opening runs up and down | IV-B |
//! | [`directional_gains`] | steady stretches at many openings | Eq. 7-11 |
//! | [`friction`] | steady stretches at many speeds | Eq. 16 |
//! | [`drive_curve`] | steady stretches at many inputs: null, dead zone and gain of a valve, losses of a pump | – |
//! | stops | places where the motion ends although the piston is driven on | – |
//!
//! Each procedure uses the results of the previous one: known leakage is subtracted from flows, and gains count from the edge of
//! the dead zone. If a recording does not suit a procedure, [`Refusal`] states which signal or which manoeuvre is missing, with
//! numbers.

mod chamber_row;
mod closed_valve;
mod dead_zone;
mod directional_gain;
mod drive_curve;
mod edge;
mod estimate;
mod friction;
mod load;
mod polynomial;
mod refusal;
mod static_valve;
mod stops;
mod stretches;
mod sweeps;
mod track;

pub use closed_valve::{ChamberLeakage, ClosedValve, Hold, valve_leakage};
pub use dead_zone::{DeadZone, EdgeCurve, dead_zones};
pub use directional_gain::{DirectionalGain, GainPoint, directional_gains};
pub use drive_curve::{DriveCurve, PumpLosses, ValveCurve, drive_curve};
pub use edge::{Direction, Edge, Side};
pub use estimate::Estimate;
pub use friction::{ForcePoint, FrictionCurve, FrictionTerm, friction};
pub use polynomial::Polynomial;
pub use refusal::Refusal;
pub use static_valve::{FlowReading, StaticEdge, StaticTestError, StaticValve, static_valve};
pub use track::Track;

use excavator_model::Model;
use excavator_model::machine::{CommandUnit, Drive};
use excavator_model::recording::Recording;

use stops::stops;

/// Results of the procedures for one cylinder.
#[derive(Debug, Clone)]
pub struct Characterisation {
    /// Name of the cylinder.
    pub cylinder: String,
    /// Largest orifice area umax of its valve section, m²; openings are plotted as shares of it. 1 without chambers.
    pub maximum_orifice_area: f64,
    /// Unit of its input.
    pub unit: CommandUnit,
    /// Leakage of the closed valve.
    pub leakage: Result<ClosedValve, Refusal>,
    /// Dead zone and hysteresis of each metering edge, in the order of [`Edge::ALL`].
    pub dead_zones: Vec<(Edge, Result<DeadZone, Refusal>)>,
    /// Gain of each metering edge, in the order of [`Edge::ALL`].
    pub gains: Vec<(Edge, Result<DirectionalGain, Refusal>)>,
    /// Friction against speed.
    pub friction: Result<FrictionCurve, Refusal>,
    /// Flow of the drive against its input.
    pub drive: Result<DriveCurve, Refusal>,
    /// Where the piston meets its stops, m: retracted and extended.
    pub stops: [Option<Estimate>; 2],
}

impl Characterisation {
    /// Number of results if the recordings suit every procedure: two for each edge, one for each of two chambers, and friction.
    pub const MOST_RESULTS: usize = 2 * Edge::ALL.len() + 3;

    /// Number of results: gains and dead zones of edges, leakages of chambers, friction.
    pub fn results(&self) -> usize {
        let edges = self.gains.iter().filter(|(_, gain)| gain.is_ok()).count()
            + self.dead_zones.iter().filter(|(_, zone)| zone.is_ok()).count();
        let leaks = self.leakage.iter().flat_map(|leakage| [&leakage.cap, &leakage.rod]).filter(|side| side.is_ok());
        edges + leaks.count() + usize::from(self.friction.is_ok())
    }
}

/// Runs all procedures on every cylinder of `model`.
pub fn characterise(model: &Model, recordings: &[&Recording]) -> Vec<Characterisation> {
    (0..model.machine.cylinders.len()).map(|cylinder| characterise_cylinder(model, cylinder, recordings)).collect()
}

fn characterise_cylinder(model: &Model, cylinder: usize, recordings: &[&Recording]) -> Characterisation {
    let constants = &model.machine.cylinders[cylinder];
    let found = Characterisation {
        cylinder: constants.name.clone(),
        maximum_orifice_area: constants.chambers.map_or(1.0, |chambers| chambers.full_command()),
        unit: constants.chambers.map_or(CommandUnit::One, |chambers| chambers.drive.command_unit()),
        leakage: Err(Refusal::NoValve { cylinder: constants.name.clone() }),
        dead_zones: Vec::new(),
        gains: Vec::new(),
        friction: Err(Refusal::NoValve { cylinder: constants.name.clone() }),
        drive: Err(Refusal::NoValve { cylinder: constants.name.clone() }),
        stops: [None, None],
    };
    let tracks: Result<Vec<Track>, Refusal> =
        recordings.iter().map(|recording| Track::of(model, cylinder, recording)).collect();
    let mut tracks = match tracks {
        Ok(tracks) => tracks,
        Err(refusal) => {
            let every = |_: &Edge| refusal.clone();
            return Characterisation {
                leakage: Err(refusal.clone()),
                dead_zones: Edge::ALL.iter().map(|edge| (*edge, Err(every(edge)))).collect(),
                gains: Edge::ALL.iter().map(|edge| (*edge, Err(every(edge)))).collect(),
                friction: Err(refusal.clone()),
                drive: Err(refusal.clone()),
                ..found
            };
        }
    };
    let friction = friction(model, cylinder, recordings, &tracks);
    let drive = drive_curve(model, cylinder, &tracks);
    let null = drive.as_ref().ok().and_then(DriveCurve::null).map_or(0.0, |null| null.value);
    let stops = stops(&tracks, null);
    let has_pump = matches!(constants.chambers.map(|chambers| chambers.drive), Some(Drive::Pump { .. }));
    let no_valve = has_pump.then(|| Refusal::NoValve { cylinder: constants.name.clone() });
    if let Some(refusal) = no_valve.or_else(|| pump_pressure_unknown(&tracks)) {
        let of_edges = || Edge::ALL.into_iter();
        return Characterisation {
            leakage: Err(refusal.clone()),
            dead_zones: of_edges().map(|edge| (edge, Err(refusal.clone()))).collect(),
            gains: of_edges().map(|edge| (edge, Err(refusal.clone()))).collect(),
            friction,
            drive,
            stops,
            ..found
        };
    }
    let leakage = valve_leakage(&tracks);
    if let Ok(leakage) = &leakage {
        tracks.iter_mut().for_each(|track| leakage.take_off(track));
    }
    let dead_zones = dead_zones(&tracks);
    let gains = directional_gains(&tracks, &dead_zones);
    Characterisation { leakage, dead_zones, gains, friction, drive, stops, ..found }
}

/// Why procedures that need the pressure drop of every edge have no result, if neither recording nor model has a pump pressure.
fn pump_pressure_unknown(tracks: &[Track]) -> Option<Refusal> {
    let without = tracks.iter().find(|track| track.pump_pressure.iter().all(|pressure| pressure.is_nan()))?;
    Some(Refusal::MissingSignal {
        source_name: without.source.clone(),
        signal: "pump_pressure".to_string(),
        needed_for: "gives the pressure drops of the edges towards the pump",
    })
}
