//! The same machine, larger or smaller, that works with the same pressures and speeds.
#![allow(dead_code, clippy::unwrap_used)]

use excavator_model::machine::{Drive, Linkage, Size, Supply};
use excavator_model::{Model, ModelEffect};

/// Ratio of all lengths, and of the unit of openings: 1e6 for openings in mm2.
pub type Scale = (f64, f64);

/// Pressures and speeds are the same on both machines, so areas grow with the square of lengths, and times with lengths.
pub fn size_of((length, unit): Scale) -> Size {
    Size { stroke: length, area: length * length, opening: length * length * unit, lever: length, ..Size::REFERENCE }
}

/// The machine with every length times the ratio, its openings in another unit, and its parameters in proportion.
pub fn scaled(model: &Model, scale: Scale) -> Model {
    let mut scaled = model.clone();
    let (length, size) = (scale.0, size_of(scale));
    // Weights then grow as forces do.
    scaled.machine.gravity /= length;
    if let Supply::PumpLine(line) = &mut scaled.machine.supply {
        line.flow *= length.powi(2);
        line.volume *= length.powi(3);
    }
    for cylinder in &mut scaled.machine.cylinders {
        cylinder.stroke *= length;
        cylinder.ends.iter_mut().for_each(|end| *end *= length);
        if let Linkage::Triangle { foot_arm, rod_arm, mid_stroke_length, .. } = &mut cylinder.linkage {
            [foot_arm, rod_arm, mid_stroke_length].into_iter().for_each(|arm| *arm *= length);
        }
        let chambers = cylinder.chambers.as_mut().unwrap();
        [&mut chambers.cap_area, &mut chambers.rod_area].into_iter().for_each(|area| *area *= length.powi(2));
        [&mut chambers.cap_dead_volume, &mut chambers.rod_dead_volume]
            .into_iter()
            .for_each(|volume| *volume *= length.powi(3));
        let Drive::Valve { full_command, .. } = &mut chambers.drive else { unreachable!() };
        *full_command *= size.opening;
    }
    for effect in &mut scaled.effects {
        // Its limits are those of the new size, too.
        let fresh = ModelEffect::new(&effect.physics, &scaled.machine, effect.site).unwrap();
        effect.size = fresh.size;
        for (parameter, fresh) in effect.parameters.iter_mut().zip(fresh.parameters) {
            parameter.value *= size.factor(parameter.card.growth);
            parameter.card = fresh.card;
        }
    }
    scaled
}
