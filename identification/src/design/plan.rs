//! A sequence of manoeuvres with transfers between their places.

use excavator_model::machine::Machine;
use excavator_model::simulation::{Profile, Segment};

use super::ride::Rider;
use super::transfer::{NoWay, transfer};
use super::{DesignError, Limits, Manoeuvre, Violation};

/// A sequence of manoeuvres that stays inside the limits for every rival.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Names of the manoeuvres with the time at which each begins, s.
    pub chosen: Vec<(String, f64)>,
    /// Commands, each with its cylinder, in order; all other valves are closed meanwhile.
    pub moves: Vec<(usize, Segment)>,
    /// Length, s.
    pub duration: f64,
    /// State of each rival at the end.
    pub(super) states: Vec<Vec<f64>>,
}

/// Why a manoeuvre cannot be appended.
#[derive(Debug, Clone)]
pub(super) enum Refusal {
    Limit(Violation),
    TooLong,
}

/// Samples per second of simulations that only check limits.
pub(super) const RATE: f64 = 200.0;
/// Time at rest at the end of a profile, s.
const AFTER: f64 = 0.5;

impl Plan {
    /// An empty plan: every rival at rest at mid-stroke.
    ///
    /// # Errors
    /// [`DesignError::Signal`] if a rival has no such state.
    pub(super) fn empty(riders: &[Rider<'_>]) -> Result<Self, DesignError> {
        let states = riders
            .iter()
            .map(|rider| rider.at_rest(&vec![0.0; rider.system.layout().joints]))
            .collect::<Result<Vec<_>, _>>()?;
        Ok(Plan { chosen: Vec::new(), moves: Vec::new(), duration: 0.0, states })
    }

    /// The plan with one more manoeuvre, if it ends by `latest` s and stays inside the limits. Transfers are computed with the
    /// first rival.
    ///
    /// # Errors
    /// [`DesignError::Signal`]; the inner result is the refusal.
    pub(super) fn with(
        &self,
        manoeuvre: &Manoeuvre,
        riders: &[Rider<'_>],
        limits: &Limits,
        latest: f64,
    ) -> Result<Result<Plan, Refusal>, DesignError> {
        let Some(first) = riders.first() else { return Ok(Err(Refusal::TooLong)) };
        let cylinder = manoeuvre.cylinder;
        let machine = &first.system.model().machine;
        let target = manoeuvre.place * limits.half_way(machine.cylinders[cylinder].stroke);
        if self.duration + manoeuvre.duration() > latest {
            return Ok(Err(Refusal::TooLong));
        }
        let way = match transfer(first, cylinder, &self.states[0], target, self.duration, RATE) {
            Ok(way) => way,
            Err(NoWay::Violation(violation)) => return Ok(Err(Refusal::Limit(violation))),
            Err(NoWay::Error(error)) => return Err(error),
        };
        let begins = self.duration + way.iter().map(Segment::duration).sum::<f64>();
        if begins + manoeuvre.duration() > latest {
            return Ok(Err(Refusal::TooLong));
        }
        let segments = [way, manoeuvre.segments.clone()].concat();
        let name = manoeuvre.name.clone();
        self.appended(cylinder, &segments, Some((name, begins)), riders, limits)
    }

    /// The plan with a transfer of every cylinder back to mid-stroke and a rest, so that it can be run again.
    ///
    /// # Errors
    /// As [`Plan::with`].
    pub(super) fn brought_back(
        &self,
        cylinders: &[usize],
        riders: &[Rider<'_>],
        limits: &Limits,
    ) -> Result<Result<Plan, Refusal>, DesignError> {
        let Some(first) = riders.first() else { return Ok(Err(Refusal::TooLong)) };
        let mut plan = self.clone();
        for &cylinder in cylinders {
            let mut segments = match transfer(first, cylinder, &plan.states[0], 0.0, plan.duration, RATE) {
                Ok(way) => way,
                Err(NoWay::Violation(violation)) => return Ok(Err(Refusal::Limit(violation))),
                Err(NoWay::Error(error)) => return Err(error),
            };
            segments.push(Segment::Hold { duration: AFTER, area: 0.0 });
            plan = match plan.appended(cylinder, &segments, None, riders, limits)? {
                Ok(plan) => plan,
                refused => return Ok(refused),
            };
        }
        Ok(Ok(plan))
    }

    fn appended(
        &self,
        cylinder: usize,
        segments: &[Segment],
        chosen: Option<(String, f64)>,
        riders: &[Rider<'_>],
        limits: &Limits,
    ) -> Result<Result<Plan, Refusal>, DesignError> {
        let mut plan = self.clone();
        for (rider, state) in riders.iter().zip(&mut plan.states) {
            let ride = match rider.run(cylinder, segments, state.clone(), self.duration, RATE) {
                Ok(ride) => ride,
                Err(DesignError::Simulation(error)) => {
                    return Ok(Err(Refusal::Limit(Violation::Simulation(error.to_string()))));
                }
                Err(error) => return Err(error),
            };
            if let Err(violation) = limits.check(&rider.system.model().machine, &ride.extremes) {
                return Ok(Err(Refusal::Limit(violation)));
            }
            *state = ride.end;
        }
        plan.moves.extend(segments.iter().map(|segment| (cylinder, *segment)));
        plan.duration += segments.iter().map(Segment::duration).sum::<f64>();
        plan.chosen.extend(chosen);
        Ok(Ok(plan))
    }

    /// One profile per cylinder with a valve, all of the same length.
    pub fn profiles(&self, machine: &Machine) -> Vec<Profile> {
        let with_valve = machine.cylinders.iter().enumerate().filter(|(_, cylinder)| cylinder.chambers.is_some());
        with_valve
            .map(|(index, cylinder)| {
                let mut segments: Vec<Segment> = Vec::new();
                for &(own, segment) in &self.moves {
                    let wanted =
                        if own == index { segment } else { Segment::Hold { duration: segment.duration(), area: 0.0 } };
                    match (segments.last_mut(), wanted) {
                        (Some(Segment::Hold { duration, area }), Segment::Hold { duration: more, area: next })
                            if *area == next =>
                        {
                            *duration += more;
                        }
                        _ => segments.push(wanted),
                    }
                }
                Profile { cylinder: cylinder.name.clone(), segments }
            })
            .collect()
    }
}
