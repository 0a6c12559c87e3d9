"""Robot descriptions: the joints form a tree, have the simulator's names, and reach as far as the linkage does."""

import math
import tomllib
import xml.etree.ElementTree as ElementTree

import pytest
from interfaces import CONFIG

DESCRIPTIONS = sorted((CONFIG / "description").glob("*.urdf"))


def joints(root):
    return {joint.get("name"): joint for joint in root.findall("joint")}


def machine_of(file):
    return tomllib.loads((CONFIG / f"{file.stem}.toml").read_text())["machine"]


@pytest.fixture(params=DESCRIPTIONS, ids=lambda file: file.name)
def description(request):
    return request.param, ElementTree.parse(request.param).getroot()


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
    for link in links:
        seen = set()
        while link != base:
            assert link not in seen, f"{link} hangs on itself"
            seen.add(link)
            link = parents[link]


def test_moving_joints_are_those_of_the_cylinders(description):
    """/joint_states names the joint of cylinder `arm` `arm_joint`."""
    file, root = description
    moving = {name for name, joint in joints(root).items() if joint.get("type") != "fixed"}
    assert moving == {f"{cylinder['name']}_joint" for cylinder in machine_of(file)["cylinders"]}


def test_joints_reach_as_far_as_the_linkage(description):
    file, root = description
    for cylinder in machine_of(file)["cylinders"]:
        limit = joints(root)[f"{cylinder['name']}_joint"].find("limit")
        linkage = cylinder["linkage"]
        foot, rod = linkage["foot_arm"]["value"], linkage["rod_arm"]["value"]
        reach = []
        for end in (-0.5, 0.5):
            length = linkage["mid_stroke_length"]["value"] + end * cylinder["stroke"]["value"]
            interior = math.acos((foot**2 + rod**2 - length**2) / (2 * foot * rod))
            reach.append(2 * math.pi - interior if linkage["mirrored"] else interior)
        assert [float(limit.get("lower")), float(limit.get("upper"))] == pytest.approx(sorted(reach), abs=1e-4)


def test_the_held_boom_is_held_at_the_angle_of_the_model():
    file = CONFIG / "description" / "zx30u-arm.urdf"
    joint = joints(ElementTree.parse(file).getroot())["boom_joint"]
    assert joint.get("type") == "fixed"
    _, pitch, _ = (float(angle) for angle in joint.find("origin").get("rpy").split())
    # links turn about -y, as the axis of the moving boom says
    assert -pitch == pytest.approx(machine_of(file)["mechanism"]["base_angle"]["value"])


def test_descriptions_differ_in_the_boom_joint_only():
    """One machine, drawn twice: what is changed in one has to be changed in the other."""
    both, held = (
        ElementTree.parse(CONFIG / "description" / f"{name}.urdf").getroot() for name in ("zx30u", "zx30u-arm")
    )

    def parts(root):
        return [
            ElementTree.tostring(part).strip()
            for part in root
            if (part.tag, part.get("name")) != ("joint", "boom_joint")
        ]

    assert parts(both) == parts(held)


def test_inertias_are_possible(description):
    """Principal moments of a body obey the triangle inequality."""
    _, root = description
    for inertia in root.iter("inertia"):
        x, y, z = (float(inertia.get(axis)) for axis in ("ixx", "iyy", "izz"))
        assert min(x, y, z) > 0 and x + y >= z and y + z >= x and z + x >= y
