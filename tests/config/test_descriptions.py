"""Robot descriptions: the joints form a tree, have the simulator's names, and reach as far as the linkage does."""

import math
import os
import subprocess
import tomllib
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from interfaces import CONFIG

MACHINES = ["zx30u-arm", "zx30u", "zx30u-bucket", "zx30u-excavator", "servo-bench", "emps"]
PROGRAM = Path(os.environ.get("EXCAVATOR_BINARY", CONFIG.parent / "target/debug/excavator")).resolve()


@pytest.fixture(params=MACHINES, scope="module")
def description(request):
    if not PROGRAM.is_file():
        pytest.skip(f"{PROGRAM} is not built")
    done = subprocess.run([PROGRAM, "model", "urdf", "--model", request.param], capture_output=True, check=True)
    return tomllib.loads((CONFIG / f"{request.param}.toml").read_text())["machine"], ElementTree.fromstring(done.stdout)


def joints(root):
    return {joint.get("name"): joint for joint in root.findall("joint")}


def test_joints_form_one_tree(description):
    _, root = description
    links = [link.get("name") for link in root.findall("link")]
    assert len(links) == len(set(links))
    parents = {}
    for joint in joints(root).values():
        child = joint.find("child").get("link")
        assert child not in parents, f"{child} hangs on two joints"
        parents[child] = joint.find("parent").get("link")
    assert set(parents) | set(parents.values()) == set(links)
    (base,) = set(links) - set(parents)
    assert base == "base_link"
    for link in links:
        seen = set()
        while link != base:
            assert link not in seen, f"{link} hangs on itself"
            seen.add(link)
            link = parents[link]


def test_moving_joints_are_those_of_the_cylinders(description):
    """joint_states names the joint of cylinder `arm` `arm_joint`."""
    machine, root = description
    moving = {name for name, joint in joints(root).items() if joint.get("type") != "fixed"}
    assert moving == {f"{cylinder['name']}_joint" for cylinder in machine["cylinders"]}


def test_joints_reach_as_far_as_the_linkage(description):
    machine, root = description
    for cylinder in machine["cylinders"]:
        joint, linkage = joints(root)[f"{cylinder['name']}_joint"], cylinder["linkage"]
        limit = joint.find("limit")
        assert float(limit.get("velocity")) > 0 and float(limit.get("effort")) >= 0
        if joint.get("type") != "revolute" or linkage["kind"] != "triangle":
            continue
        foot, rod = linkage["foot_arm"]["value"], linkage["rod_arm"]["value"]
        reach = []
        for end in (-0.5, 0.5):
            length = linkage["mid_stroke_length"]["value"] + end * cylinder["stroke"]["value"]
            interior = math.acos((foot**2 + rod**2 - length**2) / (2 * foot * rod))
            reach.append(2 * math.pi - interior if linkage.get("mirrored") else interior)
        assert [float(limit.get("lower")), float(limit.get("upper"))] == pytest.approx(sorted(reach), abs=1e-4)


def test_distances_between_joints_are_those_of_the_model(description):
    machine, root = description
    lengths = machine["mechanism"].get("link_lengths")
    if lengths is None:
        pytest.skip("a machine whose dynamics need no lengths")
    first = "swing" in machine["mechanism"]
    for cylinder, length in zip(machine["cylinders"][first + 1 :], lengths, strict=True):
        origin = joints(root)[f"{cylinder['name']}_joint"].find("origin").get("xyz")
        assert [float(part) for part in origin.split()] == pytest.approx([0, 0, -length["value"]])
