//! Sets of effects that the flow balances ask for.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use excavator_model::Model;
use excavator_model::recording::Recording;
use rayon::prelude::*;

use super::super::Addition;
use super::super::starts::plain_starts;
use super::super::trial::key_of;
use super::flow_fit::{Balances, FlowFit, Step};
use super::{FlowSet, flow_additions};
use crate::regression::FlowGround;

/// Number of sets of one size that are extended.
const WIDTH: usize = 2;
/// Number of additions to one set that are fitted to the end.
const FITTED: usize = 4;
/// Decrease of the misfit that one more effect must bring.
const LEAST: f64 = 0.01;
/// Distance from the misfit of the best set within which a set with another effect in place of one of its own is its rival.
const RIVAL: f64 = 0.1;

struct Node {
    additions: Vec<Addition>,
    fit: FlowFit,
    misfit: f64,
}

struct Grounds<'a> {
    fitted: FlowGround,
    fitted_balances: Balances,
    others: FlowGround,
    other_balances: Balances,
    recordings: &'a [&'a Recording],
}

/// The sets that the flow balances ask for.
pub(in super::super) struct FlowSets<'a> {
    grounds: Grounds<'a>,
    /// The best, in this order.
    pub best: Vec<FlowSet>,
}

/// The best sets of at most `most_effects` for the flow balances of `model`. `None` if these cannot be evaluated.
pub(in super::super) fn flow_sets<'a>(
    model: &Model,
    most_effects: usize,
    identification: &'a [&'a Recording],
    validation: &[&Recording],
) -> Option<FlowSets<'a>> {
    let grounds = Grounds::new(model, identification, validation)?;
    let given = grounds.node(Vec::new(), model)?;
    let mut known: BTreeMap<Vec<String>, (f64, FlowSet)> = BTreeMap::from([(Vec::new(), given.set())]);
    let mut best = given.misfit;
    let mut wide = vec![given];
    for _ in 0..most_effects {
        // Noise is all that is left.
        if best < LEAST {
            break;
        }
        let mut children: Vec<Node> = wide.iter().flat_map(|parent| grounds.children(parent)).collect();
        children.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
        let Some(first) = children.first().filter(|first| best - first.misfit >= LEAST) else { break };
        best = first.misfit;
        wide.clear();
        for child in children {
            if let Entry::Vacant(place) = known.entry(key_of(&child.additions, model)) {
                place.insert(child.set());
                if wide.len() < WIDTH {
                    wide.push(child);
                }
            }
        }
    }
    let mut all: Vec<(f64, FlowSet)> = known.into_values().collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best: Vec<FlowSet> =
        all.into_iter().take_while(|(misfit, _)| *misfit < best + LEAST).map(|(_, set)| set).collect();
    Some(FlowSets { grounds, best })
}

impl FlowSets<'_> {
    /// Sets that do about as well as the first, with another effect in place of one of its own.
    pub fn rivals(&self) -> Vec<FlowSet> {
        self.best.first().map_or_else(Vec::new, |first| self.grounds.rivals(first))
    }
}

impl Node {
    fn set(&self) -> (f64, FlowSet) {
        (self.misfit, FlowSet { additions: self.additions.clone(), model: self.fit.model.clone() })
    }
}

impl<'a> Grounds<'a> {
    fn new(model: &Model, identification: &'a [&'a Recording], validation: &[&Recording]) -> Option<Self> {
        let (fitted, others) = (FlowGround::new(model, identification).ok()?, FlowGround::new(model, validation).ok()?);
        Some(Grounds {
            fitted_balances: Balances::new(&fitted, model)?,
            other_balances: Balances::new(&others, model)?,
            fitted,
            others,
            recordings: identification,
        })
    }

    fn node(&self, additions: Vec<Addition>, start: &Model) -> Option<Node> {
        let fit = self.fitted_balances.fit(&self.fitted, start)?;
        let misfit = 0.5 * (fit.misfit + self.other_balances.evaluate(&self.others, &fit.model)?);
        Some(Node { additions, fit, misfit })
    }

    /// Sets that do about as well with another effect in place of one of their own.
    fn rivals(&self, best: &FlowSet) -> Vec<FlowSet> {
        let Some(least) = self.node(best.additions.clone(), &best.model).map(|node| node.misfit + RIVAL) else {
            return Vec::new();
        };
        let mut rivals = Vec::new();
        for replaced in &best.additions {
            let mut model = best.model.clone();
            model.effects.retain(|effect| !effect.is(&replaced.physics.card().name, replaced.site));
            let rest = best.additions.iter().filter(|one| *one != replaced).cloned().collect();
            let Some(parent) = self.node(rest, &model) else { continue };
            let near = |child: &Node| child.misfit < least && !child.additions.contains(replaced);
            rivals.extend(self.children(&parent).into_iter().filter(near).map(|child| child.set().1));
        }
        rivals
    }

    /// The most promising sets with one effect more.
    fn children(&self, parent: &Node) -> Vec<Node> {
        let begun = flow_additions(&parent.fit.model, self.recordings).into_par_iter().filter_map(|addition| {
            let extended = parent.fit.model.with_effect(&addition.physics, addition.site).ok()?;
            let starts = plain_starts(&extended, self.recordings);
            let steps: Vec<Step> = starts
                .par_iter()
                .filter_map(|start| self.fitted_balances.promise(&self.fitted, &parent.fit, start))
                .collect();
            let first = steps.into_iter().min_by(|a, b| a.misfit.total_cmp(&b.misfit))?;
            Some((addition, first))
        });
        let mut begun: Vec<(Addition, Step)> = begun.collect();
        begun.retain(|(_, first)| parent.fit.misfit - first.misfit >= 0.5 * LEAST);
        begun.sort_by(|a, b| a.1.misfit.total_cmp(&b.1.misfit));
        begun.truncate(FITTED);
        let ended = begun.into_par_iter().filter_map(|(addition, first)| {
            let additions = parent.additions.iter().cloned().chain([addition]).collect();
            self.node(additions, &first.model)
        });
        ended.collect()
    }
}
