//! Energies and powers over time for the head of a recording.

use excavator_model::Model;
use excavator_model::effects::{ActsOn, Site, Text};

use super::analysis::PhaseDelays;
use super::smoothing::Parabola;
use super::{Books, EnergySettings};
use crate::validation::phase_delay_degrees;

/// A column with the standard error of each value from sensor noise.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Band {
    /// Values.
    pub value: Vec<f64>,
    /// Standard errors.
    pub error: Vec<f64>,
}

/// Power of one effect over time, W.
#[derive(Debug, Clone, PartialEq)]
pub struct TermTrace {
    /// Name in the catalogue.
    pub effect: Text,
    /// At the measured state.
    pub analytical: Vec<f64>,
    /// At the simulated state; `NaN` if there is none.
    pub numerical: Vec<f64>,
}

/// One cylinder with its joint, or all of them together; every column is as long as `time`.
#[derive(Debug, Clone, PartialEq)]
pub struct CylinderTraces {
    /// Name of the cylinder, or of the machine for all of them.
    pub name: String,
    /// The cylinders that are included.
    pub members: Vec<usize>,
    /// Time, s.
    pub time: Vec<f64>,
    /// Spool opening of the first member, m².
    pub opening: Vec<f64>,
    /// Kinetic energy, J.
    pub kinetic: Vec<f64>,
    /// Potential energy, J.
    pub potential: Vec<f64>,
    /// Compression energy of the cap side's oil, J.
    pub cap_internal: Vec<f64>,
    /// Compression energy of the rod side's oil, J.
    pub rod_internal: Vec<f64>,
    /// Stored energy of the measured state, J.
    pub hamiltonian: Band,
    /// Rate of the stored energy of the measured state, W.
    pub experimental: Band,
    /// Supply and dissipation of Eq. 10-12 at the measured state, W.
    pub analytical: Band,
    /// The same at the simulated state, W; `NaN` if there is none.
    pub numerical: Vec<f64>,
    /// Supply at the measured state, W.
    pub supply: Band,
    /// Supply at the simulated state, W.
    pub numerical_supply: Vec<f64>,
    /// Dissipation at the measured state, W; negative = lost.
    pub dissipation: Band,
    /// Dissipation at the simulated state, W.
    pub numerical_dissipation: Vec<f64>,
    /// The dissipation by effect.
    pub terms: Vec<TermTrace>,
    /// Lags between the three rates, if the excitation has a frequency.
    pub phase: Option<PhaseDelays>,
}

/// All traces over time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Traces {
    /// One entry per cylinder, preceded by one for all together if there are several.
    pub cylinders: Vec<CylinderTraces>,
}

impl Traces {
    /// Empty traces of a model.
    pub(super) fn new(model: &Model) -> Self {
        let machine = &model.machine;
        let all: Vec<usize> = (0..machine.cylinders.len()).collect();
        let mut cylinders = Vec::new();
        if all.len() > 1 {
            cylinders.push(CylinderTraces::new(model, machine.name.clone(), all.clone()));
        }
        for index in all {
            cylinders.push(CylinderTraces::new(model, machine.cylinders[index].name.clone(), vec![index]));
        }
        Traces { cylinders }
    }

    /// Adds the entries of `books` within the block's own time; `draws` are the same books with added noise.
    pub(super) fn add(&mut self, books: &Books, draws: &[Books], own: (f64, f64), settings: &EnergySettings) {
        for trace in &mut self.cylinders {
            trace.add(books, draws, own, settings);
        }
    }

    /// Adds the simulated values at the existing times.
    pub(super) fn add_simulation(&mut self, books: &Books) {
        for trace in &mut self.cylinders {
            trace.add_simulation(books);
        }
    }

    /// Measures lags at `frequency`, Hz.
    pub(super) fn measure_phases(&mut self, frequency: f64) {
        for trace in &mut self.cylinders {
            trace.phase = Some(trace.phases(frequency));
        }
    }
}

/// Quantities derived from books.
struct Derived {
    hamiltonian: Vec<f64>,
    rate: Vec<f64>,
    supply: Vec<f64>,
    dissipation: Vec<f64>,
    balance: Vec<f64>,
}

impl Derived {
    fn of(books: &Books, members: &[usize], settings: &EnergySettings) -> Self {
        let sum = |of: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            (0..books.len()).map(|k| members.iter().map(|&member| of(member, k)).sum()).collect()
        };
        let hamiltonian = sum(&|member, k| books.hamiltonian(member, k));
        let supply = sum(&|member, k| books.supply(member, k));
        let dissipation = sum(&|member, k| books.dissipation(member, k));
        let mut parabola = Parabola::default();
        let rate = (0..books.len())
            .map(|k| {
                if parabola.set(&books.time, k, settings.half_width) { parabola.slope(&hamiltonian) } else { f64::NAN }
            })
            .collect();
        let balance = supply.iter().zip(&dissipation).map(|(supply, dissipation)| supply + dissipation).collect();
        Derived { hamiltonian, rate, supply, dissipation, balance }
    }
}

impl CylinderTraces {
    fn new(model: &Model, name: String, members: Vec<usize>) -> Self {
        let own = |site: Site| matches!(site, Site::Cylinder(index) if members.contains(&index));
        let mut terms: Vec<TermTrace> = Vec::new();
        for effect in &model.effects {
            let known = terms.iter().any(|term| term.effect == effect.name());
            if own(effect.site) && effect.physics.card().acts_on != ActsOn::Valve && !known {
                terms.push(TermTrace { effect: effect.name_text(), analytical: Vec::new(), numerical: Vec::new() });
            }
        }
        CylinderTraces {
            name,
            members,
            time: Vec::new(),
            opening: Vec::new(),
            kinetic: Vec::new(),
            potential: Vec::new(),
            cap_internal: Vec::new(),
            rod_internal: Vec::new(),
            hamiltonian: Band::default(),
            experimental: Band::default(),
            analytical: Band::default(),
            numerical: Vec::new(),
            supply: Band::default(),
            numerical_supply: Vec::new(),
            dissipation: Band::default(),
            numerical_dissipation: Vec::new(),
            terms,
            phase: None,
        }
    }

    fn add(&mut self, books: &Books, draws: &[Books], own: (f64, f64), settings: &EnergySettings) {
        let range = books.time.partition_point(|&t| t < own.0)..books.time.partition_point(|&t| t < own.1);
        let base = Derived::of(books, &self.members, settings);
        let drawn: Vec<Derived> = draws
            .iter()
            .filter(|draw| draw.len() == books.len())
            .map(|draw| Derived::of(draw, &self.members, settings))
            .collect();
        self.time.extend(&books.time[range.clone()]);
        if let Some(&first) = self.members.first() {
            self.opening.extend(&books.cylinders[first].opening[range.clone()]);
        }
        for (column, part) in [
            (&mut self.kinetic, (|c| &c.kinetic) as fn(&super::CylinderBooks) -> &Vec<f64>),
            (&mut self.potential, |c| &c.potential),
            (&mut self.cap_internal, |c| &c.cap_internal),
            (&mut self.rod_internal, |c| &c.rod_internal),
        ] {
            let members = &self.members;
            column.extend(range.clone().map(|k| members.iter().map(|&m| part(&books.cylinders[m])[k]).sum::<f64>()));
        }
        for (band, part) in [
            (&mut self.hamiltonian, (|d| &d.hamiltonian) as fn(&Derived) -> &Vec<f64>),
            (&mut self.experimental, |d| &d.rate),
            (&mut self.analytical, |d| &d.balance),
            (&mut self.supply, |d| &d.supply),
            (&mut self.dissipation, |d| &d.dissipation),
        ] {
            for k in range.clone() {
                let value = part(&base)[k];
                let squares: f64 = drawn.iter().map(|draw| (part(draw)[k] - value).powi(2)).sum();
                band.value.push(value);
                band.error.push(if drawn.is_empty() { f64::NAN } else { (squares / drawn.len() as f64).sqrt() });
            }
        }
        for term in &mut self.terms {
            let members = &self.members;
            term.analytical.extend(range.clone().map(|k| power_of(books, &term.effect, members, k)));
        }
    }

    fn add_simulation(&mut self, books: &Books) {
        /// Largest difference of timestamps of the same sample, due to rounding, s.
        const SAME: f64 = 1e-6;
        let entries: Vec<Option<usize>> = self
            .time
            .iter()
            .map(|&t| {
                let entry = books.time.partition_point(|&own| own < t - SAME);
                books.time.get(entry).filter(|own| (**own - t).abs() <= SAME).map(|_| entry)
            })
            .collect();
        let members = &self.members;
        let column = |of: &dyn Fn(usize) -> f64| -> Vec<f64> {
            entries.iter().map(|entry| entry.map_or(f64::NAN, of)).collect()
        };
        self.numerical_supply = column(&|k| members.iter().map(|&m| books.supply(m, k)).sum());
        self.numerical_dissipation = column(&|k| members.iter().map(|&m| books.dissipation(m, k)).sum());
        self.numerical = self.numerical_supply.iter().zip(&self.numerical_dissipation).map(|(s, d)| s + d).collect();
        for term in &mut self.terms {
            term.numerical = column(&|k| power_of(books, &term.effect, members, k));
        }
    }

    fn phases(&self, frequency: f64) -> PhaseDelays {
        let lag = |ahead: &[f64], behind: &[f64]| {
            (behind.len() == self.time.len())
                .then(|| phase_delay_degrees(&self.time, ahead, behind, frequency))
                .flatten()
        };
        PhaseDelays {
            frequency,
            analytical: lag(&self.experimental.value, &self.analytical.value),
            numerical: lag(&self.experimental.value, &self.numerical),
            numerical_behind_analytical: lag(&self.analytical.value, &self.numerical),
        }
    }
}

fn power_of(books: &Books, effect: &str, members: &[usize], entry: usize) -> f64 {
    let own = books
        .effects
        .iter()
        .filter(|own| own.effect == effect && matches!(own.site, Site::Cylinder(index) if members.contains(&index)));
    own.map(|own| own.into_cylinders(entry)).sum()
}
