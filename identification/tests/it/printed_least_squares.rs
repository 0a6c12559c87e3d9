//! The paper's least squares against the solution of its printed equations by another program.

#![allow(clippy::excessive_precision)] // digits as numpy prints them
use excavator_identification::regression::{Regression, least_squares};
use excavator_model::document::built_in;
use excavator_model::recording::Recording;

/// The paper's machine of [`built_in`] with the paper's sine (0.5 Hz, 1e-4 m²) from rest at mid-stroke, simulated at 500 Hz: s in
/// nm, p+, p- and pp in 0.1 Pa, u in 1e-12 m². Both programs read these integers, so their rounding is in both.
const SINE: &str = include_str!("../data/sine_of_the_paper.txt");

/// Noise, mechanical parameters, hydraulic parameters, condition numbers.
type Solution = (f64, [f64; 4], [f64; 8], [f64; 4]);

/// What `identification/tests/data/printed_least_squares.py` prints with numpy 2.4: pressure noise, Pa; J2, Fd2, Fc2, W2; b, bp, Cf+,
/// Cf-, Cft, Ce+, Ce-, Ci; unscaled and scaled condition numbers of both groups.
const BY_NUMPY: [Solution; 3] = [
    (
        0.0,
        [2.406007654590670e+02, 1.360216357524537e+04, 1.360196071893889e+02, 1.902581305902370e+02],
        [
            1.773198411026595e+09,
            6.440322063982573e+07,
            4.588037818450926e-03,
            3.994689261640117e-03,
            1.100320803254131e-02,
            3.618144473608283e-12,
            3.545978510028581e-12,
            1.516801253117562e-11,
        ],
        [2.984437503112754e+02, 3.233987664859279e+00, 2.703121428011283e+07, 2.519842616157248e+00],
    ),
    (
        2e3,
        [2.373873541349605e+02, 1.363422481874791e+04, 1.341292198289102e+02, 1.901981749702970e+02],
        [
            1.769469186448782e+09,
            6.468056099015727e+07,
            4.583056321107621e-03,
            3.988615861013668e-03,
            1.101289409118116e-02,
            3.620629058514038e-12,
            3.092085436699034e-12,
            1.461542309467623e-11,
        ],
        [2.985533354578945e+02, 3.237866222054024e+00, 2.701672675395378e+07, 2.517401469594772e+00],
    ),
    (
        2e4,
        [2.355362273551113e+02, 1.363727983409758e+04, 1.341948664650697e+02, 1.902201400050824e+02],
        [
            1.720904705720003e+09,
            7.003424574928646e+07,
            4.465804373820837e-03,
            3.866620812998516e-03,
            1.110879762432226e-02,
            6.836842330561820e-12,
            -7.648195712885226e-12,
            4.569630428381922e-12,
        ],
        [2.985533354578945e+02, 3.237866222054024e+00, 2.678078428713178e+07, 2.465592901040111e+00],
    ),
];

const MECHANICAL: [&str; 4] = ["arm.inertia", "arm.viscous_damping", "arm.coulomb_friction", "arm.gravity_moment"];
const HYDRAULIC: [&str; 8] = [
    "arm.bulk_modulus",
    "pump.bulk_modulus",
    "arm.flow_gain_cap",
    "arm.flow_gain_rod",
    "pump.bypass_flow_gain",
    "arm.external_leakage_cap",
    "arm.external_leakage_rod",
    "arm.internal_leakage",
];

/// Sums of twelve uniform numbers less six, from the generator of the script.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        (0..12).fold(-6.0, |sum, _| {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            sum + (self.0 >> 11) as f64 / 2_f64.powi(53)
        })
    }
}

/// The stored sine with this noise on pressures (Pa), and with 50 µm on the displacement if there is any.
fn recorded(pressure_noise: f64, seed: u64) -> Recording {
    let rows: Vec<Vec<f64>> =
        SINE.lines().map(|line| line.split(' ').map(|word| word.parse().unwrap()).collect()).collect();
    let mut noise = Noise(seed);
    let mut column = |index: usize, unit: f64, level: f64| -> Vec<f64> {
        rows.iter().map(|row| row[index] * unit + level * noise.next()).collect()
    };
    let displacement_noise = if pressure_noise == 0.0 { 0.0 } else { 5e-5 };
    let time = (0..rows.len()).map(|sample| sample as f64 * 2e-3).collect();
    let mut recording = Recording::unmeasured("sine of the paper", time, &["arm"]);
    recording.tank_pressure.fill(0.0);
    recording.pump_flow.fill(3.8e-4);
    recording.cylinders[0].displacement = column(0, 1e-9, displacement_noise);
    recording.cylinders[0].cap_pressure = column(1, 1e-1, pressure_noise);
    recording.cylinders[0].rod_pressure = column(2, 1e-1, pressure_noise);
    recording.pump_pressure = column(3, 1e-1, pressure_noise);
    recording.cylinders[0].orifice_area = column(4, 1e-12, 0.0);
    recording
}

fn identified(pressure_noise: f64, seed: u64) -> Regression {
    least_squares(&built_in("zx30u-arm").unwrap(), &[&recorded(pressure_noise, seed)]).unwrap()
}

fn margin_of(found: &Regression, name: &str) -> f64 {
    let index = found.model.parameter_names().iter().position(|candidate| candidate == name).unwrap();
    found.model.parameters().nth(index).unwrap().1.margin_95.unwrap()
}

#[test]
fn it_solves_the_printed_equations_as_numpy_does() {
    for (level, mechanical, hydraulic, conditions) in BY_NUMPY {
        let found = identified(level, 1);
        let limit = if level == 0.0 { 1e-9 } else { 1e-6 };
        let check = |name: &str, value: f64, wanted: f64| {
            let difference = (value / wanted - 1.0).abs();
            assert!(difference < limit, "{name} at {level} Pa: {value:e} is not {wanted:e}, off by {difference:e}");
        };
        for (name, wanted) in MECHANICAL.iter().zip(mechanical).chain(HYDRAULIC.iter().zip(hydraulic)) {
            check(name, found.model.value_of(name).unwrap(), wanted);
        }
        let numbers = found.condition_numbers.iter().flat_map(|one| [one.unscaled, one.scaled]);
        assert_eq!(numbers.clone().count(), conditions.len());
        numbers.zip(conditions).for_each(|(value, wanted)| check("condition number", value, wanted));
    }
}

/// The vapour pressure and the stiffness of the end stops are no part of the printed equations.
#[test]
fn what_confines_the_state_has_no_term() {
    let recording = recorded(2e4, 1);
    let model = built_in("zx30u-arm").unwrap();
    let mut other = model.clone();
    let confining = other.effects.iter_mut().filter(|effect| ["cavitation", "end_stop"].contains(&effect.name()));
    confining.flat_map(|effect| &mut effect.parameters).for_each(|parameter| parameter.value *= 0.01);
    let [one, two] = [&model, &other].map(|model| least_squares(model, &[&recording]).unwrap());
    for name in MECHANICAL.iter().chain(&HYDRAULIC) {
        assert_eq!(one.model.value_of(name), two.model.value_of(name), "{name}");
    }
}

/// Margins are those of noise: values from other noise scatter by as much. The lack
/// of the model behind the average of 86 ms adds to them, so they may be wider.
#[test]
fn margins_are_the_scatter_over_noise() {
    const DRAWS: u64 = 24;
    let all: Vec<Regression> = (1..=DRAWS).map(|seed| identified(2e4, 1_000_003 * seed)).collect();
    for name in MECHANICAL.iter().chain(&HYDRAULIC) {
        let each = |of: &dyn Fn(&Regression) -> f64| all.iter().map(of).collect::<Vec<f64>>();
        let values = each(&|one| one.model.value_of(name).unwrap());
        let margins = each(&|one| margin_of(one, name));
        let count = DRAWS as f64;
        let mean = values.iter().sum::<f64>() / count;
        let deviation = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
        let margin = margins.iter().sum::<f64>() / count;
        println!(
            "{name}: mean {mean:.4e}, scatter {deviation:.2e}, margin / (1.96 scatter) {:.2}",
            margin / (1.96 * deviation)
        );
        assert!(margin > 1.2 * deviation, "{name}: margin {margin:e}, scatter {deviation:e}");
    }
}
