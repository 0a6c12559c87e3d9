"""The interface package lists all its files and all packages that they use, so that `colcon build` makes it whole."""

import re
import xml.etree.ElementTree as ElementTree

from interfaces import REPOSITORY

MSGS = REPOSITORY / "msgs"


def interface_files():
    return sorted(f"{kind}/{file.name}" for kind in ("msg", "action") for file in (MSGS / kind).iterdir())


def used_packages():
    """Packages before the slash of a field's type, and what actions need."""
    used = set()
    for name in interface_files():
        for line in (MSGS / name).read_text().splitlines():
            match = re.match(r"([a-z][a-z0-9_]*)/[A-Z]", line)
            if match:
                used.add(match[1])
    return used | {"action_msgs", "builtin_interfaces"}


def test_cmake_generates_every_interface():
    text = (MSGS / "CMakeLists.txt").read_text()
    assert sorted(re.findall(r'"((?:msg|action)/\w+\.\w+)"', text)) == interface_files()
    (dependencies,) = re.findall(r"DEPENDENCIES ([\w ]+)", text)
    assert set(dependencies.split()) == used_packages()
    found = set(re.findall(r"find_package\((\w+) REQUIRED\)", text))
    assert used_packages() | {"ament_cmake", "rosidl_default_generators"} <= found


def test_package_xml_depends_on_what_is_used():
    package = ElementTree.parse(MSGS / "package.xml").getroot()
    assert package.findtext("name") == "excavator_msgs"
    assert {element.text for element in package.findall("depend")} == used_packages()
    assert package.findtext("member_of_group") == "rosidl_interface_packages"
    assert package.findtext("license") == "Apache-2.0"


def test_the_action_has_goal_result_and_feedback():
    goal, result, feedback = (MSGS / "action" / "Identify.action").read_text().split("---")
    assert "string[] bags" in goal and "float64[] nmse_after" in result and "float64 progress" in feedback
