//! Units as loggers, data sheets and people write them.

/// Other spellings of units, in lower case and without blanks, each with the unit that it is. A pressure with `g` is above that of the
/// air, as all pressures here are; an absolute one (`psia`, `bara`) is no spelling of them, since its zero differs.
const WORDS: &[(&str, &[&str])] = &[
    ("s", &["sec", "secs", "second", "seconds", "sek", "sekunde", "sekunden"]),
    ("ms", &["msec", "msecs", "millisec", "millisecs", "millisecond", "milliseconds", "millisekunden"]),
    ("us", &["usec", "usecs", "microsec", "microsecs", "microsecond", "microseconds"]),
    ("ns", &["nsec", "nsecs", "nanosec", "nanosecs", "nanosecond", "nanoseconds"]),
    ("min", &["mins", "minute", "minutes", "minuten"]),
    ("h", &["hr", "hrs", "hour", "hours"]),
    ("d", &["day", "days"]),
    ("Hz", &["hertz", "cps", "1/s", "s-1"]),
    ("V", &["volt", "volts", "vdc", "vdc.", "voltdc", "voltsdc"]),
    ("mV", &["millivolt", "millivolts", "mvolt"]),
    ("A", &["amp", "amps", "ampere", "amperes", "adc"]),
    ("mA", &["milliamp", "milliamps", "milliampere", "milliamperes", "mamp"]),
    ("Pa", &["pascal", "pascals", "n/m2"]),
    ("kPa", &["kilopascal", "kilopascals", "kn/m2", "kpag"]),
    ("MPa", &["megapascal", "megapascals", "n/mm2", "mpag"]),
    ("bar", &["bars", "barg", "bar(g)", "barü", "bar(ü)", "bar(rel)"]),
    ("psi", &["psig", "psi(g)", "lbf/in2", "lb/in2", "lbs/in2"]),
    ("kgf/cm2", &["kg/cm2", "kp/cm2"]),
    ("deg", &["degree", "degrees", "degs", "deg."]),
    ("rad", &["radian", "radians", "rads"]),
    ("rev", &["revs", "turn", "turns", "revolution", "revolutions", "umdr"]),
    ("m", &["meter", "meters", "metre", "metres"]),
    ("cm", &["centimeter", "centimeters", "centimetre", "centimetres"]),
    ("mm", &["millimeter", "millimeters", "millimetre", "millimetres"]),
    ("um", &["micron", "microns", "micrometer", "micrometre"]),
    ("in", &["inch", "inches", "in.", "\""]),
    ("ft", &["foot", "feet"]),
    ("m/s", &["m/sec", "m/second", "meter/s", "meters/s", "meters/sec", "meter/sec", "metres/s", "mps", "ms-1"]),
    ("mm/s", &["mm/sec", "mm/second", "mmps", "mms-1"]),
    ("cm/s", &["cm/sec", "cm/second", "cms-1"]),
    ("in/s", &["in/sec", "inch/s", "inch/sec", "inches/s", "inches/sec", "ips"]),
    ("ft/s", &["ft/sec", "fps", "feet/s", "feet/sec"]),
    ("km/h", &["kmh", "kph", "km/hr"]),
    ("rad/s", &["rad/sec", "rads/s", "radian/s", "radians/s", "radians/sec", "rads-1"]),
    ("deg/s", &["deg/sec", "degs/s", "degree/s", "degrees/s", "degrees/sec", "degree/sec", "dps", "degs-1"]),
    ("rpm", &["rev/min", "revs/min", "r/min", "u/min", "min-1", "umdr/min"]),
    ("m/s2", &["m/s/s", "m/sec2", "m/sec/sec", "ms-2", "m/ss"]),
    ("mm/s2", &["mm/s/s", "mm/sec2", "mm/sec/sec", "mms-2"]),
    ("N", &["newton", "newtons"]),
    ("kN", &["kilonewton", "kilonewtons"]),
    ("kgf", &["kp", "kg-force"]),
    ("lbf", &["lb", "lbs", "lbsf", "pound", "pounds", "pound-force"]),
    ("Nm", &["n-m", "newtonmeter", "newtonmeters", "newton-meter", "n.m"]),
    (
        "l/min",
        &["litre/min", "liter/min", "litres/min", "liters/min", "ltr/min", "lit/min", "l/minute", "dm3/min", "lmin-1"],
    ),
    ("l/s", &["l/sec", "litre/s", "liter/s", "litres/s", "liters/s", "dm3/s"]),
    ("ml/s", &["ml/sec"]),
    ("cm3/s", &["cc/s", "cc/sec", "ccm/s", "cm3/sec"]),
    ("cm3/min", &["cc/min", "ccm/min", "ml/min"]),
    ("m3/h", &["m3/hr", "m3/hour", "cbm/h"]),
    ("m3/s", &["m3/sec"]),
    ("gpm", &["gal/min", "usgpm", "gallon/min", "gallons/min", "usgal/min", "galpm"]),
    ("mm2", &["sqmm", "mmsq", "sq.mm"]),
    ("cm2", &["sqcm", "sq.cm"]),
    ("m2", &["sqm", "sq.m"]),
    ("in2", &["sqin", "sq.in"]),
    ("degC", &["celsius", "degcelsius", "degreec", "degreesc", "degreescelsius", "deg.c", "gradc", "centigrade"]),
    ("degF", &["fahrenheit", "degfahrenheit", "degreesf", "deg.f"]),
    ("K", &["kelvin"]),
    ("W", &["watt", "watts"]),
    ("%", &["prozent", "percentage", "percent.", "%fs"]),
    ("counts", &["count", "cts", "raw", "bit", "bits", "digit", "increments"]),
];

/// The usual name of a unit that is written as one of these words.
pub(super) fn usual(word: &str) -> Option<&'static str> {
    let lower = word.to_lowercase();
    WORDS.iter().find(|(_, words)| words.contains(&lower.as_str())).map(|(unit, _)| *unit)
}

#[cfg(test)]
mod tests {
    use super::super::unit::Unit;
    use super::*;

    #[test]
    fn every_word_is_one_known_unit() {
        let mut seen = Vec::new();
        for (unit, words) in WORDS {
            assert_eq!(Unit::named(unit).map(|found| found.name), Some(*unit));
            for word in *words {
                assert_eq!(Unit::named(word).map(|found| found.name), Some(*unit), "{word}");
                assert!(!seen.contains(word), "{word} stands for two units");
                seen.push(word);
            }
        }
    }

    #[test]
    fn units_are_read_as_people_write_them() {
        for (word, unit) in [
            ("Sec", "s"),
            ("SECONDS", "s"),
            ("msec", "ms"),
            ("Volt", "V"),
            ("Volts", "V"),
            ("psig", "psi"),
            ("degrees", "deg"),
            ("°", "deg"),
            ("°C", "degC"),
            ("Deg C", "degC"),
            ("°/s", "deg/s"),
            ("m/s^2", "m/s2"),
            ("m/s²", "m/s2"),
            ("mm/sec", "mm/s"),
            ("Liter / min", "l/min"),
            ("N·m", "Nm"),
            ("BAR", "bar"),
            ("µm", "um"),
            ("mm²", "mm2"),
        ] {
            assert_eq!(Unit::named(word).map(|found| found.name), Some(unit), "{word}");
        }
        for word in ["psia", "bara", "furlong", "", "position", "pressure", "mPa"] {
            assert_eq!(Unit::named(word), None, "{word}");
        }
    }

    #[test]
    fn factors_are_those_of_the_units() {
        for (word, si) in [
            ("ft/s", 0.3048),
            ("kgf/cm2", 98_066.5),
            ("cm3/min", 1e-6 / 60.0),
            ("in2", 6.4516e-4),
            ("km/h", 1.0 / 3.6),
            ("d", 86_400.0),
        ] {
            assert!(Unit::named(word).is_some_and(|unit| (unit.to_si(1.0) / si - 1.0).abs() < 1e-12), "{word}");
        }
    }
}
