//! Priors of nuisance parameters. A fit treats each as one more reading.

use std::collections::{BTreeMap, BTreeSet};

use excavator_model::effects::{Prior, PriorScale, RecordingScales, Site, Start};
use excavator_model::recording::Recording;
use excavator_model::{Model, ModelEffect, Parameter};
use nalgebra::{DMatrix, DVector};

use super::normal_equations::SegmentSums;

/// The priors of the fitted parameters, in their order. A parameter of the machine has no prior.
pub(crate) struct ParameterPriors {
    each: Vec<Option<Known>>,
    instruments: usize,
    /// Smallest and largest value of every parameter of the model, in its unit: the limits of its card, restricted to
    /// the range of its prior.
    pub bounds: Vec<[f64; 2]>,
}

#[derive(Debug, Clone, Copy)]
struct Known {
    /// Index of the parameter in the model.
    parameter: usize,
    /// The value at which its effect changes nothing, in its unit.
    centre: f64,
    /// Standard deviation, in its unit or as the logarithm of a factor.
    deviation: f64,
    scale: PriorScale,
}

impl Known {
    fn of(index: usize, parameter: &Parameter, prior: Prior, scales: &RecordingScales) -> Option<Self> {
        let spread = prior.standard_deviation(scales);
        let deviation = if prior.scale == PriorScale::Logarithmic { spread.ln() } else { spread };
        let known = Known { parameter: index, centre: centre(parameter), deviation, scale: prior.scale };
        // There is no prior if the recordings give no scale, for example if an opening is always zero.
        (known.deviation > 0.0 && known.deviation.is_finite()).then_some(known)
    }

    /// Distance above the centre in standard deviations, and its slope in one over the parameter's unit.
    fn standardised(&self, value: f64) -> (f64, f64) {
        match self.scale {
            PriorScale::Linear => ((value - self.centre) / self.deviation, 1.0 / self.deviation),
            PriorScale::Logarithmic => ((value / self.centre).ln() / self.deviation, 1.0 / (value * self.deviation)),
        }
    }
}

/// The value of a nuisance parameter at which its effect changes nothing. A search starts from it.
pub(crate) fn centre(parameter: &Parameter) -> f64 {
    match &parameter.card.start {
        Start::At(starts) => starts.first().copied().unwrap_or(0.0),
        _ => 0.0,
    }
}

/// Scales of the priors' standard deviations, for each site with a nuisance effect. Recordings are long, so each is
/// read only once.
fn scales_by_site(model: &Model, recordings: &[&Recording]) -> BTreeMap<Site, RecordingScales> {
    let has_prior = |effect: &&ModelEffect| effect.parameters.iter().any(|parameter| parameter.card.prior.is_some());
    let sites: BTreeSet<Site> = model.effects.iter().filter(has_prior).map(|effect| effect.site).collect();
    if sites.is_empty() {
        return BTreeMap::new();
    }
    let sample_interval_s = recordings.iter().map(|recording| recording.sample_interval()).fold(0.0, f64::max);
    let scales = |site: Site| RecordingScales {
        sample_interval_s,
        largest_opening_m2: largest_opening(model, site, recordings),
    };
    sites.into_iter().map(|site| (site, scales(site))).collect()
}

/// Largest absolute opening at a site, m²; 0 if there is no valve.
fn largest_opening(model: &Model, site: Site, recordings: &[&Recording]) -> f64 {
    let Site::Cylinder(index) = site else { return 0.0 };
    let Some(cylinder) = model.machine.cylinders.get(index) else { return 0.0 };
    let openings = recordings.iter().filter_map(|recording| recording.cylinder(&cylinder.name).ok());
    let areas = openings.flat_map(|signals| &signals.orifice_area).filter(|area| area.is_finite());
    areas.fold(0.0, |largest, area| largest.max(area.abs()))
}

impl ParameterPriors {
    /// The priors of the parameters `fitted` of a model, for recordings with this number of instruments.
    pub fn of(model: &Model, fitted: &[usize], recordings: &[&Recording], instruments: usize) -> Self {
        let scales = scales_by_site(model, recordings);
        let (known, bounds): (Vec<Option<Known>>, Vec<[f64; 2]>) = model
            .parameters()
            .enumerate()
            .map(|(index, (effect, parameter))| {
                let card = &parameter.card;
                match card.prior.zip(scales.get(&model.effects[effect].site)) {
                    Some((prior, scales)) => {
                        let [lowest, highest] = prior.bounds(centre(parameter), scales);
                        let bounds = [lowest.max(card.minimum), highest.min(card.maximum)];
                        (Known::of(index, parameter, prior, scales), bounds)
                    }
                    None => (None, [card.minimum, card.maximum]),
                }
            })
            .unzip();
        ParameterPriors { each: fitted.iter().map(|&index| known[index]).collect(), instruments, bounds }
    }

    /// Sum of squared deviations of the parameters from their priors, in standard deviations. `values` are those of the
    /// whole model.
    pub fn loss(&self, values: &[f64]) -> f64 {
        self.each.iter().flatten().map(|known| known.standardised(values[known.parameter]).0.powi(2)).sum()
    }

    /// Information of each parameter and its gradient, for parameters in units of these scales. Both are zero without a
    /// prior.
    pub fn equations(&self, values: &[f64], scales: &[f64]) -> Vec<(f64, f64)> {
        let equation = |(known, scale): (&Option<Known>, &f64)| {
            known.as_ref().map_or((0.0, 0.0), |known| {
                let (off, slope) = known.standardised(values[known.parameter]);
                let slope = slope * scale;
                (slope * slope, -off * slope)
            })
        };
        self.each.iter().zip(scales).map(equation).collect()
    }

    /// The equations of the priors as sums of a fit.
    pub(super) fn sums(&self, values: &[f64], scales: &[f64]) -> SegmentSums {
        let fitted = self.each.len();
        let (mut information, mut gradient) = (DMatrix::zeros(fitted, fitted), DVector::zeros(fitted));
        let mut blocks = Vec::new();
        for (number, (own, downhill)) in self.equations(values, scales).into_iter().enumerate() {
            information[(number, number)] = own;
            gradient[number] = downhill;
            if own > 0.0 {
                // The scatter of a prior is one standard deviation, whatever the fitted value.
                let mut block = DVector::zeros(fitted);
                block[number] = own.sqrt();
                blocks.push(block);
            }
        }
        SegmentSums::without_readings(information, gradient, blocks, self.loss(values), self.instruments)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use excavator_model::document::built_in;
    use excavator_model::effects::Catalogue;

    use super::*;

    fn with(effect: &str) -> Model {
        built_in("zx30u-arm")
            .unwrap()
            .with_effect(&Catalogue::built_in().find(effect).unwrap(), Site::Cylinder(0))
            .unwrap()
    }

    fn recording() -> Recording {
        let time: Vec<f64> = (0..100).map(|index| f64::from(index) * 2e-3).collect();
        let mut recording = Recording::unmeasured("bag", time, &["arm"]);
        recording.cylinders[0].orifice_area = vec![-4e-5; 100];
        recording
    }

    #[test]
    fn the_loss_is_quadratic_about_the_centre_and_its_equations_lead_there() {
        for effect in ["spool_sensor_lead", "spool_sensor_offset", "friction_reversal", "friction_corner"] {
            let model = with(effect);
            let fitted = vec![model.parameters().count() - 1];
            let priors = ParameterPriors::of(&model, &fitted, &[&recording()], 4);
            let mut values = model.parameter_values();
            assert_eq!(priors.loss(&values), 0.0, "{effect}");
            let known = priors.each[0].unwrap();
            let up = |deviations: f64| match known.scale {
                PriorScale::Linear => known.centre + deviations * known.deviation,
                PriorScale::Logarithmic => known.centre * (deviations * known.deviation).exp(),
            };
            values[fitted[0]] = up(2.0);
            assert!((priors.loss(&values) - 4.0).abs() < 1e-9, "{effect}");
            let sums = priors.sums(&values, &[up(2.0)]);
            let step = sums.gradient[0] / sums.information[(0, 0)] * up(2.0);
            let there = match known.scale {
                PriorScale::Linear => known.centre - up(2.0),
                PriorScale::Logarithmic => -2.0 * known.deviation * up(2.0),
            };
            assert!((step / there - 1.0).abs() < 1e-9, "{effect}: {step} {there}");
        }
    }

    #[test]
    fn a_parameter_of_the_machine_has_none() {
        let model = built_in("zx30u-arm").unwrap();
        let fitted = model.unknown_parameters();
        let priors = ParameterPriors::of(&model, &fitted, &[&recording()], 4);
        assert!(priors.each.iter().all(Option::is_none));
    }
}
