use excavator_identification::energy::*;
use excavator_identification::fit::*;
use excavator_identification::regression::*;
fn main() {
    for case in std::env::args().skip(1) {
        let t = std::time::Instant::now();
        let base = format!("/work/shared/practice/{case}");
        let model = excavator_model::document::built_in(if case=="p09" {"zx30u"} else {"zx30u-arm"}).unwrap();
        let read = |n: &str| excavator_bags::read_recording(format!("{base}/{n}").as_ref(), &Default::default()).unwrap().0;
        let id = read("identification");
        let weak = weak_form(&model, &[&id], &WeakFormSettings::default()).unwrap();
        println!("{case} weak {:?}", t.elapsed());
        let fitted = if std::env::var("FIT").is_ok() { fit(&weak.model, &[&id], &FitSettings{sample_rate: 170.0, ..Default::default()}).unwrap().model } else { weak.model };
        println!("fit {:?}", t.elapsed());
        for n in ["identification", "validation"] {
            let rec = read(n);
            let t = std::time::Instant::now();
            let a = analyse(&fitted, &rec, EnergySettings::default()).unwrap();
            println!("{case} {n} {:?} windows {}", t.elapsed(), a.windows.len());
            for p in &a.places {
                println!("  {:20} outside {:.3}", p.place.equation(&fitted), p.share_outside);
                for r in &p.regimes { println!("      {:15} n {:4} mean {:8.3} peak {:8.2} size {:6.2} band {:6.2} noise {:6.3} par {:6.3} flow {:7.1} {}", r.regime.name(), r.windows, r.mean, r.peak, r.size, r.band, r.noise, r.parameters, r.flow, if r.is_explained() {""} else {"<<<"}); }
            }
            for m in missing_power(&fitted, &a) { println!("  {}", m.sentence); }
        }
    }
}
