//! How far a model is from noise, but for a few moments.

use super::Fit;

/// Share of the blocks that may fail without the model being called short of something. A chamber that touches the
/// vapour limit or a stop that is hit makes a few moments that no simulation meets exactly: small errors before decide
/// what happens then.
const ALLOWED_TO_FAIL: f64 = 0.05;

impl Fit {
    /// [`Fit::loss`] over all blocks but, for each instrument, the worst twentieth.
    pub fn typical_loss(&self) -> f64 {
        let losses = self.typical_losses();
        losses.iter().sum::<f64>() / losses.len() as f64
    }

    /// The same of each instrument that has readings.
    pub fn typical_losses(&self) -> Vec<f64> {
        self.instruments
            .iter()
            .enumerate()
            .filter_map(|(number, instrument)| {
                let mut blocks: Vec<(f64, usize)> =
                    self.block_errors.iter().map(|block| block[number]).filter(|(_, readings)| *readings > 0).collect();
                blocks.sort_by(|a, b| (a.0 / a.1 as f64).total_cmp(&(b.0 / b.1 as f64)));
                blocks.truncate(blocks.len() - (blocks.len() as f64 * ALLOWED_TO_FAIL).ceil() as usize);
                let (squares, readings) =
                    blocks.iter().fold((0.0, 0), |(squares, readings), block| (squares + block.0, readings + block.1));
                let variance = squares / readings as f64;
                (readings > 0).then(|| (variance / (instrument.noise * instrument.noise)).max(1e-6).ln())
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::made_up::made_up_fit;

    fn fit(squares: &[f64]) -> Fit {
        let model = excavator_model::document::built_in("emps").unwrap_or_else(|_| unreachable!());
        let block_errors = squares.iter().map(|&squares| vec![(squares, 10)]).collect();
        Fit { block_errors, ..made_up_fit(model, 2.0, 2.0) }
    }

    #[test]
    fn pure_noise_is_zero_and_one_bad_block_in_twenty_does_not_count() {
        let mut squares = vec![40.0; 20];
        assert!(fit(&squares).typical_loss().abs() < 1e-12);
        squares[7] = 1e9;
        assert!(fit(&squares).typical_loss().abs() < 1e-12);
        squares[8] = 1e9;
        assert!(fit(&squares).typical_loss() > 10.0);
    }

    #[test]
    fn e_fold_in_all_blocks_is_one() {
        assert!((fit(&[40.0 * std::f64::consts::E; 7]).typical_loss() - 1.0).abs() < 1e-12);
    }
}
