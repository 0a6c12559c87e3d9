//! Effects on the arm.

/// Distance from the joint to the bucket, m: the link of 2.0 m with its centre of gravity at 1.0 m, bucket pin before the tip.
const TIP: f64 = 1.6;
/// Time over which a contact force or a load builds up and goes, s.
const RAMP: f64 = 0.08;

/// Effects on the arm.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Load {
    /// Mass in the bucket, kg.
    pub payload: f64,
    /// When it is picked up, as a share of the recording; at 0 it is there from the start.
    pub payload_begin: f64,
    /// Force from outside, felt at the piston, N, + = extends.
    pub contact_force: f64,
    /// When it begins, as a share of the recording.
    pub contact_begin: f64,
    /// When it ends, as a share of the recording.
    pub contact_end: f64,
}

impl Load {
    /// Added inertia, kg m², at a time of a recording, both s.
    pub fn inertia(&self, time: f64, duration: f64) -> f64 {
        self.payload * self.lifted(time, duration) * TIP * TIP
    }

    /// Added gravity moment, kg m, at a time of a recording, both s.
    pub fn gravity_moment(&self, time: f64, duration: f64) -> f64 {
        self.payload * self.lifted(time, duration) * TIP
    }

    /// Share of the mass that hangs on the arm. What is picked up moves with the arm already.
    fn lifted(&self, time: f64, duration: f64) -> f64 {
        if self.payload_begin == 0.0 {
            return 1.0;
        }
        ((time - self.payload_begin * duration) / RAMP).clamp(0.0, 1.0)
    }

    /// Contact force in N at a time of a recording, both s.
    pub fn contact(&self, time: f64, duration: f64) -> f64 {
        if self.contact_force == 0.0 {
            return 0.0;
        }
        let (begin, end) = (self.contact_begin * duration, self.contact_end * duration);
        let ramp = |since: f64| (since / RAMP).clamp(0.0, 1.0);
        self.contact_force * ramp(time - begin) * ramp(end - time)
    }
}
