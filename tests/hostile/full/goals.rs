//! Goals of `/identification/run` from whoever is on the network.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use excavator_msgs::common::Text;
use nix::sys::stat::Mode;
use nix::unistd::mkfifo;
use ros2_client::action::{ActionClient, ActionClientQosPolicies, GoalId, GoalStatusEnum};
use ros2_client::qos::{History, QosProfile};
use ros2_client::{ActionTypeName, Context, Name, Node, NodeName, NodeOptions, ServiceMapping};
use serde::{Deserialize, Serialize};

use crate::hostile::fault::Fault;
use crate::hostile::inside::{inside, peak_memory};
use crate::live::{LONGEST_WAIT, Network, folder, found, messages, recorded, records, until};

#[derive(Debug, Clone, Default, Serialize, Deserialize)]
struct Goal {
    model: String,
    bags: Vec<String>,
    effects: Vec<String>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Outcome {
    model: String,
    signals: Vec<String>,
    nmse_before: Vec<f64>,
    nmse_after: Vec<f64>,
    success: bool,
    message: String,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
struct Feedback {
    stage: String,
    progress: f64,
}

impl ros2_client::Message for Goal {}
impl ros2_client::Message for Outcome {}
impl ros2_client::Message for Feedback {}

/// A goal for the machine of the samples.
fn goal(model: &str, bag: &str) -> Goal {
    Goal { model: model.to_string(), bags: vec![bag.to_string()], effects: Vec::new() }
}

/// Work for some seconds.
fn long_goal() -> Goal {
    Goal { effects: vec!["entrained_air".to_string()], ..goal("zx30u-arm", "arm-swing") }
}

struct Client {
    _node: Node,
    action: ActionClient<Goal, Outcome, Feedback>,
}

impl Client {
    /// A client that has met the server.
    fn new() -> Self {
        let mut node = Context::new()
            .unwrap()
            .new_node(NodeName::new("/", "stranger").unwrap(), NodeOptions::new().enable_rosout(false))
            .unwrap();
        let qos = QosProfile::publisher_default().history(History::KeepLast { depth: 100 });
        let policies = ActionClientQosPolicies {
            goal_service: qos.clone(),
            result_service: qos.clone(),
            cancel_service: qos.clone(),
            feedback_subscription: qos.clone(),
            status_subscription: qos,
        };
        let name = Name::new("/identification", "run").unwrap();
        let type_name = ActionTypeName::new("excavator_msgs", "Identify");
        let action = node.create_action_client(ServiceMapping::Enhanced, &name, &type_name, policies).unwrap();
        let client = Client { _node: node, action };
        found("the server", || client.send_within(&Goal::default(), Duration::from_secs(1)));
        client
    }

    /// The identity of a goal and whether it was accepted; `None` without an answer.
    fn send_within(&self, goal: &Goal, time: Duration) -> Option<(GoalId, bool)> {
        let (request, id) = self.action.send_goal(goal.clone()).ok()?;
        let end = Instant::now() + time;
        while Instant::now() < end {
            if let Ok(Some(response)) = self.action.receive_goal_response(request) {
                return Some((id, response.accepted));
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        None
    }

    fn send(&self, goal: &Goal) -> (GoalId, bool) {
        self.send_within(goal, LONGEST_WAIT).expect("an answer to a goal")
    }

    /// The result of a goal that is accepted.
    fn run(&self, goal: &Goal) -> (GoalStatusEnum, Outcome) {
        let (id, accepted) = self.send(goal);
        assert!(accepted, "{goal:?}");
        let request = self.action.request_result(id).unwrap();
        found("the result", || self.action.receive_result(request).unwrap_or(None))
    }
}

/// A folder that is offered with the sample bag, a pipe and ways out in it; a secret lies beside it.
fn offered(folder: &Path) -> PathBuf {
    let root = folder.join("offered");
    let bag = root.join("arm-swing");
    std::fs::create_dir_all(&bag).unwrap();
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("../bags/samples/arm-swing");
    for entry in sample.read_dir().unwrap() {
        let entry = entry.unwrap();
        std::fs::copy(entry.path(), bag.join(entry.file_name())).unwrap();
    }
    std::fs::write(folder.join("secret"), "root:x:0:0:secret\n").unwrap();
    std::fs::write(root.join("odd.toml"), "# a model\nroot:x:0:0:secret\n").unwrap();
    std::os::unix::fs::symlink("/etc/passwd", root.join("link.toml")).unwrap();
    mkfifo(&root.join("pipe"), Mode::S_IRWXU).unwrap();
    root
}

fn node(parameters: &[String]) -> Vec<&str> {
    let mut words = vec!["node", "identification", "--ros-args"];
    parameters.iter().for_each(|parameter| words.extend(["-p", parameter.as_str()]));
    words
}

fn folders(root: &Path) -> Vec<String> {
    vec![format!("model_folder:={}", root.display()), format!("bag_folder:={}", root.display())]
}

#[test]
fn files_of_the_machine_are_neither_read_nor_betrayed() {
    let Some(network) = Network::new("goals") else { return };
    let (_keep, folder) = folder();
    let root = offered(&folder);
    let program = network.start(&node(&folders(&root)));
    let secret = folder.join("secret").display().to_string();
    let (messages, longest, work) = inside(&network, move || {
        let client = Client::new();
        let there =
            ["/etc/passwd", "/proc/self/environ", "/dev/zero", "../secret", "link.toml", "pipe", secret.as_str()];
        let absent = ["/etc/nothing", "../nothing", "nothing.toml", "/proc/0/environ"];
        let mut messages = Vec::new();
        let mut longest = Duration::ZERO;
        for name in there.into_iter().chain(absent) {
            for goal in [goal(name, "arm-swing"), goal("zx30u-arm", name)] {
                let start = Instant::now();
                let (status, outcome) = client.run(&goal);
                longest = longest.max(start.elapsed());
                assert_eq!(status, GoalStatusEnum::Aborted, "{name}: {outcome:?}");
                messages.push(outcome.message.replace(name, "NAME"));
            }
        }
        messages.push(client.run(&goal("odd.toml", "arm-swing")).1.message);
        let start = Instant::now();
        let (status, outcome) = client.run(&goal("zx30u-arm", "arm-swing"));
        assert_eq!(status, GoalStatusEnum::Succeeded, "{}", outcome.message);
        (messages, longest, start.elapsed())
    });
    let peak = peak_memory(&network, "identification");
    let (status, log) = program.interrupt();
    assert_eq!(status, 0, "{log}");
    let odd = messages.last().unwrap();
    assert!(odd.contains("line 2") && !odd.contains("root"), "{odd}");
    let mut kinds: Vec<&String> = messages[..messages.len() - 1].iter().collect();
    kinds.sort_unstable();
    kinds.dedup();
    // One sentence for models and one for bags, whatever is there.
    assert_eq!(kinds.len(), 2, "{kinds:#?}");
    // The operator's own console has the reader's words about a file of the folder; `/rosout` has what the asker was told.
    let spread: Vec<&str> = log.lines().filter(|line| line.starts_with('[')).collect();
    assert!(spread.iter().all(|line| !line.contains("secret\"") && !line.contains("x:0:0")), "{log}");
    assert!(peak < 200.0, "{peak} MB");
    Fault {
        group: "Remote goals",
        tried: "a goal names the password file, the process environment, /dev/zero, a pipe, a link that leads out",
        outcome: "aborted in one sentence, the same whether the file exists; the next goal is worked on",
    }
    .survived(&[
        ("longest answer [s]", format!("{:.2}", longest.as_secs_f64())),
        ("identification after it [s]", format!("{:.1}", work.as_secs_f64())),
        ("peak memory [MB]", format!("{peak:.0}")),
    ]);
}

#[test]
fn too_large_and_too_many_goals_are_refused() {
    let Some(network) = Network::new("flood") else { return };
    let (_keep, folder) = folder();
    let root = offered(&folder);
    let program = network.start(&node(&folders(&root)));
    let (large, small) = inside(&network, || {
        let client = Client::new();
        // A request that is in pieces may be lost on its way when they come too fast: what counts is that none is accepted.
        let huge = Goal { model: "#\n".repeat(100_000), ..long_goal() };
        let large =
            (0..300).filter(|_| client.send_within(&huge, Duration::from_millis(30)).is_some_and(|(_, yes)| yes));
        let large = large.count();
        let small = (0..300).filter(|_| client.send(&long_goal()).1).count();
        let request = client.action.cancel_all_goals().unwrap();
        found("the answer to a cancel request", || client.action.receive_cancel_response(request).unwrap_or(None));
        let (status, outcome) = client.run(&goal("zx30u-arm", "arm-swing"));
        assert_eq!(status, GoalStatusEnum::Succeeded, "{}", outcome.message);
        (large, small)
    });
    let peak = peak_memory(&network, "identification");
    let (status, log) = program.interrupt();
    assert_eq!(status, 0, "{log}");
    assert_eq!(large, 0);
    // Eight wait and one is worked on; while 300 are sent some are done.
    assert!((9..=40).contains(&small), "{small}");
    let lines = log.lines().filter(|line| line.contains("a goal is refused")).count();
    let refused = 300 - small;
    assert!((1..=refused / 4).contains(&lines), "{lines} lines about {refused} refused goals");
    assert!(peak < 200.0, "{peak} MB");
    Fault {
        group: "Remote goals",
        tried: "300 goals of 200 kB, then 300 small ones with long work",
        outcome: "the large ones are refused, of the others eight wait; one line per two seconds says so",
    }
    .survived(&[
        ("large goals accepted", large.to_string()),
        ("small goals accepted", small.to_string()),
        ("lines about refusals", lines.to_string()),
        ("peak memory [MB]", format!("{peak:.0}")),
    ]);
}

#[test]
fn work_ends_at_the_time_limit_and_the_next_goal_is_worked_on() {
    let Some(network) = Network::new("limit") else { return };
    let (_keep, folder) = folder();
    let root = offered(&folder);
    let mut parameters = folders(&root);
    parameters.push("time_limit:=0.1".to_string());
    let program = network.start(&node(&parameters));
    let times = inside(&network, || {
        let client = Client::new();
        [(); 2].map(|()| {
            let start = Instant::now();
            let (status, outcome) = client.run(&long_goal());
            assert_eq!(status, GoalStatusEnum::Aborted);
            assert!(outcome.message.contains("time_limit"), "{}", outcome.message);
            start.elapsed().as_secs_f64()
        })
    });
    assert_eq!(program.interrupt().0, 0);
    Fault {
        group: "Remote goals",
        tried: "goals whose work takes longer than the time limit of 0.1 s",
        outcome: "aborted with a line that names the limit, one after the other",
    }
    .survived(&[("answered after [s]", times.map(|time| format!("{time:.2}")).join(", "))]);
}

#[test]
fn a_result_is_the_model_in_use_only_where_the_operator_said_so() {
    let Some(network) = Network::new("result") else { return };
    let (_keep, folder) = folder();
    let root = offered(&folder);
    let mut published = Vec::new();
    for wanted in [false, true] {
        let bag = folder.join(format!("bag-{wanted}"));
        let mut parameters = folders(&root);
        if wanted {
            parameters.push("publish_result:=true".to_string());
        }
        let recorder = network.start(&["record", "/arm/model", "/diagnostics", "-o", bag.to_str().unwrap()]);
        let program = network.start(&node(&parameters));
        records(&bag, "/diagnostics", 2);
        inside(&network, || {
            let (status, outcome) = Client::new().run(&goal("zx30u-arm", "arm-swing"));
            assert_eq!(status, GoalStatusEnum::Succeeded, "{}", outcome.message);
        });
        if wanted {
            until("the model", || recorded(&bag, "/arm/model") > 0);
        }
        // What the node would have published has had its time: diagnostics of two seconds have come since.
        records(&bag, "/diagnostics", 4);
        assert_eq!(program.interrupt().0, 0);
        assert_eq!(recorder.interrupt().0, 0);
        published.push(messages::<Text>(&bag, "/arm/model").len());
    }
    assert_eq!(published, [0, 1]);
    Fault {
        group: "Remote goals",
        tried: "a goal of a stranger succeeds",
        outcome: "its model is not published on /arm/model; it is with the parameter publish_result",
    }
    .survived(&[("models published without, with", format!("{}, {}", published[0], published[1]))]);
}
