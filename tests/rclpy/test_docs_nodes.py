"""The docs, followed by a reader on a network: a node starts as the page prints it, is on the graph, and ends when told to."""

import pytest
from excavator_msgs.msg import EnergyState
from pages import REPOSITORY, all_commands, starts_nodes
from support.simulator import STATE_QOS

NAMES = {
    "node arm-simulator": "arm_simulator",
    "node energy-monitor": "energy_monitor",
    "node arm-bridge": "arm_bridge",
    "node identification": "identification",
    "record": "bag_recorder",
    "dashboard": "dashboard",
}
PAGES = {page: found for page, found in all_commands().items() if any(map(starts_nodes, found))}
# Balances of a recording that a ledger can be made of.
ENOUGH = 500


def test_the_pages_with_nodes_are_found():
    assert list(PAGES) == ["arm-bridge.md", "design.md", "energy.md", "ros2.md", "security.md"]


@pytest.fixture
def folder(tmp_path, excavator, ros):
    """What the reader has: commands of a designed profile, a description of sensors, folders of models and bags."""
    profile = REPOSITORY / "bags" / "samples" / "profile.toml"
    made = ros.start(excavator, "simulate", "--model", "zx30u-arm", "--input", profile, "-o", tmp_path / "commands")
    assert made.wait() == 0, made.output()
    for name in ("models", "bags"):
        (tmp_path / name).mkdir()
    return tmp_path


# The page with the most commands stands for the others.
SHORT_CHECK = "ros2.md"


@pytest.mark.parametrize("page", [page if page == SHORT_CHECK else pytest.param(page, marks=pytest.mark.full) for page in PAGES])
def test_the_nodes_of_a_page_start_and_end(ros, excavator, folder, page):
    means = {
        "commands": folder / "commands",
        "both": folder / "both",
        "description:=FILE.toml": f"description:={REPOSITORY / 'config' / 'can' / 'arm.toml'}",
        "model_folder:=/data/models": f"model_folder:={folder / 'models'}",
        "bag_folder:=/data/bags": f"bag_folder:={folder / 'bags'}",
    }
    running = []
    try:
        for command in PAGES[page]:
            words = [str(means.get(word, word)) for word in command.words[1:] if word != "&"]
            if starts_nodes(command):
                running.append(start(ros, excavator, words, folder))
            elif page == "ros2.md":
                read_back(ros, excavator, words, running)
    finally:
        ended = [process.interrupt() for process in reversed(running)]
    assert all(status == 0 for status in ended), [process.output() for process in running]


def start(ros, excavator, words, folder):
    """Starts a command of a page, and waits until its node is on the graph. One that plays a bag is waited for to its end."""
    process = ros.start(excavator, *words, directory=folder)
    if words[0] == "play":
        assert process.wait() == 0, process.output()
        return process
    name = NAMES[" ".join(words[:2]) if words[0] == "node" else words[0]]
    namespace = next((word.removeprefix("__ns:=") for word in words if word.startswith("__ns:=")), "/")
    ros.spin_until(lambda: (name, namespace) in ros.node.get_node_names_and_namespaces(), f"{name} in {namespace}")
    return process


def read_back(ros, excavator, words, running):
    """Ends the recorder, and runs the command that reads its bag."""
    for topic in ("state", "energy"):
        ros.spin_until(
            lambda topic=topic: f"recording /left/arm/{topic} " in running[-1].output(), f"the recorder on the left {topic}"
        )
    energies = ros.hear(EnergyState, "/left/arm/energy", STATE_QOS)
    ros.spin_until(lambda: len(energies) > ENOUGH, "balances of the left machine")
    assert running.pop().interrupt() == 0
    read = ros.start(excavator, *words)
    assert read.wait() == 0, read.output()
