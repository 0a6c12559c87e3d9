//! Remarks on what speaks against a law.

use super::Proposal;

impl Proposal {
    /// What speaks against the law, one line each.
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        if !self.merits.dissipates {
            remarks.push("puts energy into the machine at times".to_string());
        }
        if let Some(power) = self.merits.steep {
            remarks.push(format!("grows with the power {power:.1} beyond what was recorded"));
        }
        let unsure = match self.merits.unsure_signs.as_slice() {
            [] => None,
            [one] => Some(one.clone()),
            [head @ .., last] => Some(format!("{} and {last}", head.join(", "))),
        };
        remarks.extend(unsure.map(|names| format!("the interval of {names} holds zero")));
        if self.is_a_curve {
            remarks.push("is a table and no law".to_string());
        }
        remarks
    }
}
