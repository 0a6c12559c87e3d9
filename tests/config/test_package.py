"""The ROS package `excavator`: an executable for each node, and everything that launch files and docs name in share/."""

import os
import re
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from interfaces import CONFIG, REPOSITORY

PACKAGE = REPOSITORY / "program"
CMAKE = (PACKAGE / "CMakeLists.txt").read_text()
PROGRAM = Path(os.environ.get("EXCAVATOR_BINARY", REPOSITORY / "target/debug/excavator")).resolve()


def test_every_node_has_an_executable():
    if not PROGRAM.is_file():
        pytest.skip(f"{PROGRAM} is not built")
    told = subprocess.run([PROGRAM, "node", "--help"], capture_output=True, text=True, check=True).stdout
    commands = told.split("Commands:")[1].split("Options:")[0]
    nodes = set(re.findall(r"^  ([a-z-]+)  ", commands, re.MULTILINE)) - {"help"}
    (listed,) = re.findall(r"foreach\(NODE ([\w ]+)\)", CMAKE)
    assert {name.replace("_", "-") for name in listed.split()} == nodes


def test_what_is_installed_is_there():
    folders = re.findall(r'"\$\{REPOSITORY\}/(config/\w+)"', CMAKE)
    assert {"config/launch", "config/layouts", "config/maps", "config/profiles"} <= set(folders)
    assert all((REPOSITORY / folder).is_dir() for folder in folders)
    assert list(CONFIG.glob("*.toml"))


def test_package_xml_names_what_launch_files_import():
    package = ElementTree.parse(PACKAGE / "package.xml").getroot()
    assert package.findtext("name") == "excavator"
    depends = {element.text for element in package.findall("exec_depend")}
    text = "".join(file.read_text() for file in (CONFIG / "launch").glob("*.py"))
    imported = set(re.findall(r"^from (\w+)", text, re.MULTILINE)) & {"launch", "launch_ros"}
    assert imported | {"excavator_msgs", "robot_state_publisher"} <= depends


def test_both_packages_and_the_program_have_one_version():
    versions = {ElementTree.parse(REPOSITORY / name / "package.xml").getroot().findtext("version") for name in ("program", "msgs")}
    (version,) = re.findall(r'\[workspace.package\]\nversion = "([\d.]+)"', (REPOSITORY / "Cargo.toml").read_text())
    assert versions == {version}
