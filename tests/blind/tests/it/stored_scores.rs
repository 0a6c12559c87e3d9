//! Scores of machines that were asked once, judged again: a rule that changes an outcome is seen here.

use std::collections::BTreeMap;
use std::path::Path;

use excavator_blind::replay::Stored;
use excavator_identification::decision::Policy;

#[test]
fn every_stored_machine_has_the_outcome_that_is_written_down() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scores");
    let outcomes = std::fs::read_to_string(folder.join("outcomes.tsv")).unwrap();
    let outcomes: BTreeMap<&str, &str> = outcomes.lines().filter_map(|line| line.split_once('\t')).collect();
    let stored = Stored::read_all(&folder).unwrap();
    assert_eq!(stored.len(), outcomes.len());
    for one in &stored {
        let answer = one.answer(&Policy::default());
        let outcome = answer.against(&one.secret).name();
        assert_eq!(outcomes.get(one.source.as_str()), Some(&outcome), "{}: {}", one.source, answer.words());
    }
}

#[test]
fn thinning_keeps_the_verdict() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scores");
    for one in Stored::read_all(&folder).unwrap() {
        let thin = one.clone().thinned();
        assert!(thin.scores.hypotheses.len() <= one.scores.hypotheses.len());
        assert_eq!(thin.answer(&Policy::default()), one.answer(&Policy::default()), "{}", one.source);
    }
}
