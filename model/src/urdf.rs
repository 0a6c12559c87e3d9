//! The robot description of a machine as URDF, for RViz and robot_state_publisher.
//!
//! x points forwards, z up. At angle zero a link hangs straight down; a positive angle raises it forwards, so joints turn about
//! -y. A joint's name is its cylinder's name plus `_joint`, as in `joint_states`. Distances between joints come from the model if
//! it has them. Otherwise (the last link, both links of a machine whose dynamics need no lengths) a link is as long as the longer
//! arm of the linkage that drives it. Link widths are for display only; no computation uses them.

use std::fmt::Write;

use crate::machine::{Cylinder, Linkage, Machine, Mechanism, Supply};

/// Pressure for the force limits, Pa: a usual relief valve setting of mobile machines.
const RELIEF_PRESSURE: f64 = 25e6;
/// Largest joint rate if no pump flow limits it, rad/s or m/s.
const USUAL_RATE: f64 = 1.0;
/// Length of a link whose machine defines no lengths, m.
const NO_LENGTH: f64 = 1.0;
/// Width of a link as a fraction of its length.
const SLENDERNESS: f64 = 0.1;
/// Height of the first joint above the ground, m.
const JOINT_HEIGHT: f64 = 0.7;

/// The description of a machine.
pub fn urdf(machine: &Machine) -> String {
    let mut writer = Writer { text: String::new(), machine };
    let _ = write!(
        writer.text,
        "<?xml version=\"1.0\"?>\n<!-- Made from the model: excavator model urdf -->\n<robot name=\"{}\">\n  \
         <material name=\"orange\"><color rgba=\"0.9 0.4 0.1 1\"/></material>\n  \
         <material name=\"grey\"><color rgba=\"0.4 0.4 0.4 1\"/></material>\n",
        escaped(&machine.name)
    );
    writer.link("base_link", "grey", [-0.6, 0.0, 0.35], [1.8, 1.5, 0.7]);
    match &machine.mechanism {
        Mechanism::SingleLink { base_angle } => writer.held_link(*base_angle),
        Mechanism::TwoLink | Mechanism::PlanarChain { .. } => writer.chain(),
        Mechanism::LinearLoad => writer.beside_each_other("prismatic", "1 0 0", [0.3; 3]),
        Mechanism::Rotor => writer.beside_each_other("continuous", "0 1 0", [0.6, 0.2, 0.1]),
    }
    writer.text.push_str("</robot>\n");
    writer.text
}

struct Writer<'m> {
    text: String,
    machine: &'m Machine,
}

impl Writer<'_> {
    /// One moving link on a fixed link.
    fn held_link(&mut self, base_angle: f64) {
        let Some(cylinder) = self.machine.cylinders.first() else { return };
        let held = match cylinder.linkage {
            Linkage::Triangle { foot_arm, .. } => foot_arm,
            Linkage::Direct | Linkage::Gear { .. } => NO_LENGTH,
        };
        let _ = write!(
            self.text,
            "\n  <joint name=\"held_joint\" type=\"fixed\">\n    <parent link=\"base_link\"/>\n    <child link=\"held\"/>\n    \
             <origin xyz=\"0.4 0 {JOINT_HEIGHT}\" rpy=\"0 {} 0\"/>\n  </joint>\n",
            -base_angle
        );
        self.hanging("held", "grey", held);
        self.joint(0, "revolute", "held", [0.0, 0.0, -held], "0 -1 0");
        self.hanging(&cylinder.name, "orange", drawn_length(&cylinder.linkage));
    }

    /// Links in series, after the swing if there is one.
    fn chain(&mut self) {
        let machine = self.machine;
        let chain = machine.mechanism.chain();
        let (mut parent, mut origin) = ("base_link".to_string(), [0.4, 0.0, JOINT_HEIGHT]);
        for (number, cylinder) in machine.cylinders.iter().enumerate() {
            if let Some(swing) = chain.and_then(|chain| chain.swing.filter(|_| chain.is_swing(number))) {
                self.joint(number, "continuous", &parent, [0.0, 0.0, JOINT_HEIGHT / 2.0], "0 0 1");
                self.link(&cylinder.name, "grey", [-0.6, 0.0, JOINT_HEIGHT], [1.6, 1.4, JOINT_HEIGHT]);
                origin = [swing.boom_foot, 0.0, JOINT_HEIGHT / 2.0];
            } else {
                let known = chain.map_or(0.0, |chain| chain.length(number));
                let length = if known > 0.0 { known } else { drawn_length(&cylinder.linkage) };
                self.joint(number, "revolute", &parent, origin, "0 -1 0");
                self.hanging(&cylinder.name, "orange", length);
                origin = [0.0, 0.0, -length];
            }
            parent.clone_from(&cylinder.name);
        }
    }

    /// Every load on its own axis, side by side.
    fn beside_each_other(&mut self, kind: &str, axis: &str, size: [f64; 3]) {
        for (number, cylinder) in self.machine.cylinders.iter().enumerate() {
            self.joint(number, kind, "base_link", [0.5, number as f64, JOINT_HEIGHT], axis);
            self.link(&cylinder.name, "orange", [0.0; 3], size);
        }
    }

    /// A link that hangs down from its joint.
    fn hanging(&mut self, name: &str, colour: &str, length: f64) {
        let width = SLENDERNESS * length;
        self.link(name, colour, [0.0, 0.0, -length / 2.0], [width, width, length]);
    }

    fn link(&mut self, name: &str, colour: &str, centre: [f64; 3], size: [f64; 3]) {
        let (name, centre, size) = (escaped(name), triple(centre), triple(size));
        let shape = format!("      <origin xyz=\"{centre}\"/>\n      <geometry><box size=\"{size}\"/></geometry>\n");
        let _ = write!(
            self.text,
            "\n  <link name=\"{name}\">\n    <visual>\n{shape}      <material name=\"{colour}\"/>\n    </visual>\n    \
             <collision>\n{shape}    </collision>\n  </link>\n"
        );
    }

    /// The joint of a cylinder, between the parent link and the link named after the cylinder.
    fn joint(&mut self, number: usize, kind: &str, parent: &str, origin: [f64; 3], axis: &str) {
        let cylinder = &self.machine.cylinders[number];
        let (name, parent) = (escaped(&cylinder.name), escaped(parent));
        let _ = write!(
            self.text,
            "\n  <joint name=\"{name}_joint\" type=\"{kind}\">\n    <parent link=\"{parent}\"/>\n    <child link=\"{name}\"/>\n    \
             <origin xyz=\"{}\"/>\n    <axis xyz=\"{axis}\"/>\n{}  </joint>\n",
            triple(origin),
            self.limit(cylinder, kind != "continuous")
        );
    }

    /// Joint limits: range, force of the cylinder at the longest lever, and speed at the shortest lever with the full pump flow.
    fn limit(&self, cylinder: &Cylinder, has_ends: bool) -> String {
        let [retracted, extended] = cylinder.ends;
        let joints = [retracted, 0.0, extended].map(|displacement| cylinder.linkage.joint(displacement));
        let levers = joints.map(|joint| cylinder.linkage.lever(joint).abs());
        let (shortest, longest) =
            levers.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), lever| (low.min(*lever), high.max(*lever)));
        let effort = cylinder.chambers.map_or(0.0, |chambers| RELIEF_PRESSURE * chambers.cap_area * longest);
        let rate = match (self.machine.supply, cylinder.chambers) {
            (Supply::PumpLine(line), Some(chambers)) => line.flow / chambers.rod_area.min(chambers.cap_area) / shortest,
            _ => USUAL_RATE,
        };
        let reach = if has_ends {
            let (low, high) = (joints[0].min(joints[2]), joints[0].max(joints[2]));
            format!("lower=\"{low:.5}\" upper=\"{high:.5}\" ")
        } else {
            String::new()
        };
        format!("    <limit {reach}effort=\"{effort:.0}\" velocity=\"{rate:.3}\"/>\n")
    }
}

fn drawn_length(linkage: &Linkage) -> f64 {
    match *linkage {
        Linkage::Triangle { foot_arm, rod_arm, .. } => foot_arm.max(rod_arm),
        Linkage::Direct | Linkage::Gear { .. } => NO_LENGTH,
    }
}

fn triple(values: [f64; 3]) -> String {
    values.map(|value| format!("{value:.4}").trim_end_matches('0').trim_end_matches('.').to_string()).join(" ")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
