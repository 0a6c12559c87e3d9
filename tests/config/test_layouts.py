"""Layouts of plotting tools: well formed, and every curve is a field that exists."""

import json
import re
import xml.etree.ElementTree as ElementTree

import pytest
from interfaces import CONFIG, OTHER_TOPICS, TOPICS, check_path

LAYOUTS = CONFIG / "layouts"


@pytest.mark.parametrize("file", sorted(LAYOUTS.glob("*.xml")), ids=lambda file: file.name)
def test_plotjuggler(file):
    root = ElementTree.parse(file).getroot()
    assert root.tag == "root" and root.find("tabbed_widget/Tab") is not None
    (subscriber,) = [plugin for plugin in root.iter("plugin") if plugin.get("ID") == "ROS2 Topic Subscriber"]
    selected = set(subscriber.find("selected_topics").get("value").split(";"))
    curves = [curve.get("name") for curve in root.iter("curve")]
    assert len(curves) >= 5
    shown = set()
    for curve in curves:
        (topic,) = [topic for topic in TOPICS if curve.startswith(topic + "/")]
        shown.add(topic)
        steps = [re.fullmatch(r"(\w+)(\[\d+\])?", step) for step in curve[len(topic) + 1 :].split("/")]
        assert all(steps), f"{curve} is no path"
        check_path(topic, [(step[1], step[2] is not None) for step in steps])
    # what is shown is subscribed to, and nothing else
    assert selected == shown
    for splitter in root.iter("DockSplitter"):
        assert int(splitter.get("count")) == len(splitter) == len(splitter.get("sizes").split(";"))


def panels_of(layout):
    """Identifiers of the panels in a tree of splits."""
    if isinstance(layout, str):
        return [layout]
    assert layout["direction"] in ("row", "column")
    return panels_of(layout["first"]) + panels_of(layout["second"])


@pytest.mark.parametrize("file", sorted(LAYOUTS.glob("*.json")), ids=lambda file: file.name)
def test_foxglove(file):
    layout = json.loads(file.read_text())
    assert sorted(panels_of(layout["layout"])) == sorted(layout["configById"])
    curves = [path["value"] for panel in layout["configById"].values() for path in panel.get("paths", [])]
    assert len(curves) >= 5
    for curve in curves:
        topic, _, rest = curve.partition(".")
        steps = [re.fullmatch(r"(\w+)(\[:\](\{name==\"\w+\"\})?)?", step) for step in rest.split(".")]
        assert all(steps), f"{curve} is no message path"
        check_path(topic, [(step[1], step[2] is not None) for step in steps])
    for panel in layout["configById"].values():
        assert panel.get("topicToRender", "/diagnostics") in OTHER_TOPICS


def test_rviz():
    """The frame that everything is shown in, and the topic that robot_state_publisher describes the arm on."""
    yaml = pytest.importorskip("ruamel.yaml", reason="no YAML reader is installed")
    manager = yaml.YAML(typ="safe").load(LAYOUTS / "arm.rviz")["Visualization Manager"]
    # Every description that `excavator model urdf` writes stands on it.
    assert manager["Global Options"]["Fixed Frame"] == "base_link"
    (robot,) = [display for display in manager["Displays"] if display["Class"].endswith("/RobotModel")]
    assert robot["Description Topic"]["Value"] == "/robot_description"


def test_there_are_layouts_for_state_and_energy():
    names = {file.name for file in LAYOUTS.iterdir()}
    wanted = {"arm"} | {f"{tool}-{topic}" for tool in ("plotjuggler", "foxglove") for topic in ("state", "energy")}
    assert wanted == {name.split(".")[0] for name in names}
