//! Every effect changes something, more when it is stronger, and the strengths are what they say.

use excavator_blind::cases::{Case, Wish};
use excavator_blind::manoeuvres::Manoeuvre;
use excavator_blind::plant::{Base, CATALOGUE, Effects, Extras, FOREIGN, Plant, kind};
use excavator_blind::run::{Lever, run};
use excavator_blind::strength::{Strength, run_and_compare};

fn plant(name: &str, factor: f64) -> Plant {
    let mut effects = Effects::default();
    (kind(name).unwrap().set)(&mut effects, &[0.4; 4], factor);
    Plant {
        base: Base::published(),
        effects,
        extras: Extras::usual(),
        blind_spool: name == "valve_lag",
        duration: 0.0,
        boom_holding_torque: 0.0,
    }
}

#[test]
#[ignore = "minutes; tests/run --long"]
fn every_effect_shows_more_when_it_is_stronger() {
    for known in CATALOGUE.iter().chain(FOREIGN) {
        let (centre, begin) = if known.name == "end_cushion" { (-0.29, -0.25) } else { (0.0, 0.0) };
        // Seven seconds of 1 Hz are enough to show anything.
        let mut manoeuvre = Manoeuvre::validation(centre);
        manoeuvre.motions.truncate(2);
        manoeuvre.firmness = if centre == 0.0 { 1.0 } else { 2.0 };
        let share = |factor: f64| {
            let (_, change) = run_and_compare(&plant(known.name, factor), &manoeuvre, begin).unwrap();
            (change.nmse.iter().sum::<f64>(), change.share())
        };
        // The share ends at 1 per signal, the sum of errors does not.
        let ((little, _), (much, most)) = (share(0.3 * known.limit), share(known.limit));
        println!("{}: {little:.2e} at 30 % of the limit, {much:.2e} at the limit, share {most:.2e}", known.name);
        assert!(little >= 0.0 && much > little, "{}: {little} {much}", known.name);
        assert!(most > 1e-3, "{} cannot be made to show: {most}", known.name);
    }
}

#[test]
#[ignore = "minutes; tests/run --long"]
fn strengths_are_what_they_say() {
    for strength in Strength::ALL {
        let wish = Wish { effects: vec![kind("hose_loss").unwrap()], strength: Some(strength), ..Wish::default() };
        let case = Case::draw(3, 0, &wish);
        let (_, change) = run_and_compare(&case.plant, &case.validation, case.begin[1]).unwrap();
        let (least, most) = strength.band();
        println!("{}: {:.2e}", strength.name(), change.share());
        assert!(change.share() > least / 1.3 && change.share() < most * 1.3, "{}: {change:?}", strength.name());
    }
}

#[test]
fn a_seed_gives_the_same_case_again() {
    let wish = Wish { strength: Some(Strength::Medium), ..Wish::default() };
    let (one, other) = (Case::draw(5, 2, &wish), Case::draw(5, 2, &wish));
    assert_eq!(one.plant, other.plant);
    assert_eq!(one.secret(), other.secret());
    assert_ne!(one.plant.base, Case::draw(5, 3, &wish).plant.base);
}

/// The unmodelled extras stay within a few times the noise (0.05 mm, 2 kPa) when the same operator works.
#[test]
fn extras_are_small() {
    let manoeuvre = Manoeuvre::identification(0.0);
    let with = Plant { duration: manoeuvre.duration(), effects: Effects::default(), ..plant("hose_loss", 1.0) };
    let without = Plant { extras: Extras::none(), ..with };
    let plain = run(&without, Lever::Operator(&manoeuvre), 0.0).unwrap();
    let real = run(&with, Lever::Replay(&plain.command), 0.0).unwrap();
    let difference =
        |a: &[f64], b: &[f64]| (a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt();
    for (name, a, b, noise) in [
        ("displacement", &real.displacement, &plain.displacement, 5e-5),
        ("cap pressure", &real.cap, &plain.cap, 2e3),
        ("rod pressure", &real.rod, &plain.rod, 2e3),
        ("pump pressure", &real.pump, &plain.pump, 2e3),
    ] {
        let times = difference(a, b) / noise;
        println!("{name}: {times:.2} times the noise");
        assert!(times > 0.0 && times < 4.0, "{name}: {times}");
    }
}
