//! Writes the three report pages of one practice case: `cargo run -p excavator-report --example pages -- [CASE] [FOLDER]`.

use std::error::Error;
use std::path::Path;

use excavator_identification::diagnosis::DiagnosisSettings;
use excavator_identification::refinement::{Additions, refine};
use excavator_report::{comparison_page, diagnosis_page, refinement_page, verdict_sentence};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let case = arguments.next().unwrap_or_else(|| "p01".to_string());
    let folder = arguments.next().unwrap_or_else(|| "/tmp".to_string());
    let bags = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/practice").join(&case);
    if !bags.exists() {
        println!("no practice case at {}: nothing to do", bags.display());
        return Ok(());
    }
    let model = excavator_model::document::built_in(if case == "p09" { "zx30u" } else { "zx30u-arm" })?;
    let (identification, _) = excavator_bags::read_recording(&bags.join("identification"), &Default::default())?;
    let (validation, _) = excavator_bags::read_recording(&bags.join("validation"), &Default::default())?;
    let progress = |what: &str, fraction: f64| eprintln!("{:3.0} % {what}", 100.0 * fraction);
    let refinement = refine(
        &model,
        &[&identification],
        &[&validation],
        &Additions::Auto,
        &DiagnosisSettings::default(),
        "2025-01-01T00:00:00Z",
        &progress,
    )?;
    let write = |name: &str, page: String| {
        let path = Path::new(&folder).join(format!("{case}-{name}.html"));
        println!("{}: {} kB", path.display(), page.len() / 1024);
        std::fs::write(path, page)
    };
    write("refinement", refinement_page(&refinement))?;
    if let (Some(diagnosis), Some(first)) = (refinement.diagnosis(), refinement.steps.first()) {
        println!("{}", verdict_sentence(&model, diagnosis));
        write("diagnosis", diagnosis_page(&model, diagnosis, &first.comparisons, &[]))?;
        write("comparison", comparison_page(&first.fit.model, &first.comparisons, &[], &[]))?;
    }
    Ok(())
}
