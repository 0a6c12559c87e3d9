//! Answers are judged as they should be.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

use excavator_blind::cases::Sort;
use excavator_blind::scoring::{Outcome, median, outcome};
use excavator_identification::diagnosis::Verdict::{Adequate, MissingEffect, Unexplained};

#[test]
fn single_effects() {
    let judge = |verdict, tied: &[&str], first| outcome(Sort::Single, verdict, &["a"], tied, &[], first);
    assert_eq!(judge(MissingEffect, &[], Some("a")), Outcome::Right);
    assert_eq!(judge(MissingEffect, &["a", "b"], Some("a")), Outcome::Tied);
    assert_eq!(judge(MissingEffect, &["b", "a"], Some("b")), Outcome::Tied);
    assert_eq!(judge(MissingEffect, &[], Some("b")), Outcome::WrongName);
    assert_eq!(judge(Adequate, &[], None), Outcome::Missed);
    assert_eq!(judge(Unexplained, &[], Some("a")), Outcome::CalledUnexplained);
}

#[test]
fn nothing_and_the_unknown() {
    assert_eq!(outcome(Sort::Nothing, Adequate, &[], &[], &[], None), Outcome::Right);
    assert_eq!(outcome(Sort::Nothing, Unexplained, &[], &[], &[], None), Outcome::FalseAlarm);
    assert_eq!(outcome(Sort::Nothing, MissingEffect, &[], &[], &["b"], Some("b")), Outcome::FalseAlarm);
    assert_eq!(outcome(Sort::Unknown, Unexplained, &["x"], &[], &["b"], Some("b")), Outcome::Right);
    assert_eq!(outcome(Sort::Unknown, MissingEffect, &["x"], &[], &["b"], Some("b")), Outcome::WrongName);
    assert_eq!(outcome(Sort::Unknown, Adequate, &["x"], &[], &[], None), Outcome::Missed);
}

#[test]
fn pairs() {
    let judge = |chain: &[&str]| outcome(Sort::Pair, MissingEffect, &["a", "b"], &[], chain, chain.first().copied());
    assert_eq!(judge(&["b", "a"]), Outcome::Right);
    assert_eq!(judge(&["b", "c"]), Outcome::Partial);
    assert_eq!(judge(&["c"]), Outcome::WrongName);
}

#[test]
fn medians() {
    assert_eq!(median(&mut []), None);
    assert_eq!(median(&mut [3.0, 1.0, 2.0]), Some(2.0));
    assert_eq!(median(&mut [4.0, 1.0, 2.0, 3.0]), Some(2.5));
}
