//! Text as YAML: metadata of bags, parameter files, quality of service.

use rosbag2::yaml::{self, Yaml};
use rosbag2::{Qos, ReadLimits};

use crate::samples;

pub fn run(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    let _ = Qos::list_from_yaml(&text);
    yaml::from_str::<Yaml>(&text, &ReadLimits::DEFAULT).is_ok()
}

pub fn seeds() -> Vec<Vec<u8>> {
    let parameters = "/**:\n  ros__parameters:\n    rate: 500\nsim:\n  ros__parameters: &p\n    noise: {pressure: 2e3, \"a b\": [1, 2.5, true, ~]}\n\
                      other: *p\ntext: |\n  - history: keep_last\n    depth: 10\nfolded: >-\n  a\n  b\n";
    vec![
        samples::bytes("bags/samples/arm-swing/metadata.yaml"),
        samples::bytes("bags/samples/joint-states/metadata.yaml"),
        parameters.as_bytes().to_vec(),
    ]
}
