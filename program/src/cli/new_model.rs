//! `excavator model new`

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{Overwriting, OwnEffects, ResultFile};

/// What an engineer says of a machine. Numbers with their units, as on a data sheet.
#[derive(Debug, Clone, Default, Args)]
pub struct NewModelArguments {
    /// What drives it. Without, five questions are asked.
    #[arg(long, value_enum)]
    pub drive: Option<DriveChoice>,
    /// Bore, rod and stroke of a cylinder in mm: "16/10 x 100".
    #[arg(long, value_name = "BORE/ROD x STROKE", conflicts_with = "motor")]
    pub cylinder: Option<String>,
    /// The cylinder has a rod on both sides.
    #[arg(long, conflicts_with_all = ["single_acting", "motor"])]
    pub double_rod: bool,
    /// The cylinder has oil on its cap side only.
    #[arg(long, conflicts_with = "motor")]
    pub single_acting: bool,
    /// Volume of one turn of a hydraulic motor: "50 cm3".
    #[arg(long, value_name = "VOLUME")]
    pub motor: Option<String>,
    /// Turns of the motor's shaft for one of the load.
    #[arg(long, value_name = "TURNS", requires = "motor")]
    pub gear: Option<f64>,
    /// Radius of the drum or pinion of a motor that moves a mass along a line: "150 mm".
    #[arg(long, value_name = "LENGTH", requires = "motor")]
    pub drum: Option<String>,
    /// A mass that is moved along a line: "5 kg".
    #[arg(long, conflicts_with = "inertia")]
    pub mass: Option<String>,
    /// Slope of that line: 90 where extension lifts the mass.
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, allow_negative_numbers = true)]
    pub slope: f64,
    /// Moment of inertia of a link or of what a motor turns: "40 kg m2".
    #[arg(long)]
    pub inertia: Option<String>,
    /// Torque of a load that hangs on what a motor turns: "735 N m".
    #[arg(long, requires = "motor")]
    pub torque: Option<String>,
    /// Mass times distance of a link's centre of gravity from its joint: "190 kg m".
    #[arg(long)]
    pub gravity_moment: Option<String>,
    /// A link turned by a cylinder: distances in mm from the joint to the foot pin and to the rod's pin, and from pin to pin at mid-stroke:
    /// "1100, 330, 1100".
    #[arg(long, value_name = "FOOT, ROD, PINS", conflicts_with_all = ["mass", "motor"])]
    pub link: Option<String>,
    /// Extension lowers the link's angle.
    #[arg(long, requires = "link")]
    pub mirrored: bool,
    /// Input at which the valve is fully open, in the unit of the recordings: "10 V", "20 mA", "115 mm2", "100 %".
    #[arg(long)]
    pub command: Option<String>,
    /// Flow of the fully open valve over one of its edges: "4 l/min".
    #[arg(long, value_name = "FLOW")]
    pub rated_flow: Option<String>,
    /// Pressure drop over one edge at the rated flow: "35 bar".
    #[arg(long, value_name = "PRESSURE", requires = "rated_flow", default_value = "35 bar")]
    pub rated_drop: String,
    /// Pressure of the supply; of the charge line of a pump drive; the cut-off of a load-sensing pump: "70 bar".
    #[arg(long, value_name = "PRESSURE")]
    pub supply: Option<String>,
    /// Largest flow of the pump: "23 l/min".
    #[arg(long, value_name = "FLOW")]
    pub pump_flow: Option<String>,
    /// Oil between valve and cap side and between valve and rod side, hoses included: "50 cm3, 45 cm3", or one number for both.
    #[arg(long, value_name = "VOLUMES")]
    pub dead_volume: Option<String>,
    /// Bulk modulus of the oil: "10000 bar".
    #[arg(long, value_name = "PRESSURE")]
    pub bulk_modulus: Option<String>,
    /// Pressure that a load-sensing pump keeps above the highest load: "20 bar".
    #[arg(long, value_name = "PRESSURE")]
    pub margin: Option<String>,
    /// Pressure drop that a compensator leaves to the metering edge: "7 bar".
    #[arg(long, value_name = "PRESSURE")]
    pub metering_drop: Option<String>,
    /// Name of the machine, a word.
    #[arg(long, default_value = "bench")]
    pub name: String,
    /// Name of the cylinder or motor, a word: that of the recordings' signals.
    #[arg(long, default_value = "load")]
    pub part: String,
    /// Model file to write; without, it is printed.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub overwriting: Overwriting,
}

/// What drives a cylinder or motor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DriveChoice {
    /// A valve on a supply of constant pressure.
    Valve,
    /// An open-centre valve on a pump of constant flow.
    OpenCentre,
    /// A compensated valve on a load-sensing pump.
    LoadSensing,
    /// A pump of its own in a closed circuit.
    Pump,
    /// A measured force, without oil.
    Force,
    /// A testing machine that moves the rod.
    ImposedMotion,
}

/// A table of a static valve test, and the model that it goes into.
#[derive(Debug, Clone, Args)]
pub struct ValveTestArguments {
    /// Table of the test (.csv, .xlsx, .mat, .parquet).
    #[arg(long, value_name = "FILE")]
    pub table: PathBuf,
    /// Pressure drop over the metering edge that the flow passes: "35 bar".
    #[arg(long, value_name = "PRESSURE")]
    pub drop: String,
    /// Heading of the column with the valve's input; without, the only column that can be it.
    #[arg(long, value_name = "COLUMN")]
    pub input: Option<String>,
    /// Unit of the input; without, that of the heading, or of the model.
    #[arg(long, value_name = "UNIT")]
    pub input_unit: Option<String>,
    /// Heading of the column with the flow over one edge; without, the only column with a unit of flow.
    #[arg(long, value_name = "COLUMN")]
    pub flow: Option<String>,
    /// Unit of the flow; without, that of the heading.
    #[arg(long, value_name = "UNIT")]
    pub flow_unit: Option<String>,
    /// Input at which the valve is closed, for a test of one side: "5 V".
    #[arg(long, value_name = "INPUT", allow_hyphen_values = true)]
    pub null: Option<String>,
    /// Model that gets the result: built-in name or TOML file. Without, the result is printed only.
    #[arg(long, requires = "output")]
    pub model: Option<String>,
    #[command(flatten)]
    pub own: OwnEffects,
    /// The cylinder; without, the model's first one.
    #[arg(long, value_name = "NAME", requires = "model")]
    pub cylinder: Option<String>,
    /// Model file to write.
    #[arg(short, long, value_name = "MODEL", requires = "model")]
    pub output: Option<PathBuf>,
    #[command(flatten)]
    pub result: ResultFile,
}

/// Tables of a drive under its own position controller.
#[derive(Debug, Clone, Args)]
pub struct PositionTestArguments {
    /// Tables that the model is fitted to (.csv, .xlsx, .mat, .parquet).
    #[arg(long, required = true, num_args = 1.., value_name = "FILE")]
    pub identification: Vec<PathBuf>,
    /// Tables that the model predicts.
    #[arg(long, num_args = 1.., value_name = "FILE")]
    pub validation: Vec<PathBuf>,
    /// Heading of the column with the reference; without, the only one named so.
    #[arg(long, value_name = "COLUMN")]
    pub reference: Option<String>,
    /// Heading of the column with the position; without, the only other length.
    #[arg(long, value_name = "COLUMN")]
    pub position: Option<String>,
    #[command(flatten)]
    pub result: ResultFile,
}
