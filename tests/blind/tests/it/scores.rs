//! Answers are judged as they should be.

use excavator_blind::answer::{Answer, Outcome};
use excavator_blind::cases::Sort;
use excavator_blind::scoring::{Secret, median};
use excavator_identification::decision::Kind::{self, Adequate, MissingEffect, Unexplained};

fn judged(sort: Sort, hidden: &[&str], kind: Kind, set: &[&[&str]]) -> Outcome {
    let owned = |names: &[&str]| names.iter().map(|name| (*name).to_string()).collect::<Vec<String>>();
    let secret = Secret { sort, effects: owned(hidden), words: String::new() };
    let set = set.iter().map(|names| owned(names)).collect();
    Answer { kind, set, is_structural: false, log_error_ratios: [1.0, 0.0] }.against(&secret)
}

#[test]
fn single_effects() {
    let judge = |kind, set: &[&[&str]]| judged(Sort::Single, &["a"], kind, set);
    assert_eq!(judge(MissingEffect, &[&["a"]]), Outcome::Right);
    assert_eq!(judge(MissingEffect, &[&["a"], &["b"]]), Outcome::Tied);
    assert_eq!(judge(MissingEffect, &[&["b"], &["a"]]), Outcome::Tied);
    assert_eq!(judge(MissingEffect, &[&["b"]]), Outcome::WrongName);
    assert_eq!(judge(MissingEffect, &[&["a", "b"]]), Outcome::WrongName, "b is not there");
    assert_eq!(judge(MissingEffect, &[&["a", "a"]]), Outcome::Right, "at two places");
    assert_eq!(judge(Adequate, &[]), Outcome::Missed);
    assert_eq!(judge(Unexplained, &[&["a"]]), Outcome::CalledUnexplained);
}

#[test]
fn nothing_and_the_unknown() {
    assert_eq!(judged(Sort::Nothing, &[], Adequate, &[]), Outcome::Right);
    assert_eq!(judged(Sort::Nothing, &[], Unexplained, &[]), Outcome::FalseAlarm);
    assert_eq!(judged(Sort::Nothing, &[], MissingEffect, &[&["b"]]), Outcome::FalseAlarm);
    assert_eq!(judged(Sort::Unknown, &["x"], Unexplained, &[&["b"]]), Outcome::Right);
    assert_eq!(judged(Sort::Unknown, &["x"], MissingEffect, &[&["b"]]), Outcome::WrongName);
    assert_eq!(judged(Sort::Unknown, &["x"], Adequate, &[]), Outcome::Missed);
}

#[test]
fn pairs() {
    let judge = |set: &[&[&str]]| judged(Sort::Pair, &["a", "b"], MissingEffect, set);
    assert_eq!(judge(&[&["b", "a"]]), Outcome::Right);
    assert_eq!(judge(&[&["b", "c"], &["a", "b"]]), Outcome::Tied);
    assert_eq!(judge(&[&["b", "c"]]), Outcome::Partial);
    assert_eq!(judge(&[&["c"]]), Outcome::WrongName);
}

#[test]
fn medians() {
    assert_eq!(median(&mut []), None);
    assert_eq!(median(&mut [3.0, 1.0, 2.0]), Some(2.0));
    assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), Some(2.5));
}
