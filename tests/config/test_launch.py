"""Launch files: valid Python everywhere; with ROS 2's launch here, descriptions that can be shown."""

import importlib.util

import pytest
from interfaces import CONFIG

FILES = sorted((CONFIG / "launch").glob("*.launch.py"))


def test_there_are_launch_files():
    assert {file.name for file in FILES} == {"simulation.launch.py", "bridge.launch.py"}


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_it_compiles_and_defines_what_launch_asks_for(file):
    names = compile(file.read_text(), str(file), "exec").co_names
    assert "generate_launch_description" in names


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
def test_it_describes_a_launch(file):
    launch = pytest.importorskip("launch", reason="ROS 2's launch is not installed")
    pytest.importorskip("launch_ros", reason="ROS 2's launch_ros is not installed")
    spec = importlib.util.spec_from_file_location("launch_file", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    description = module.generate_launch_description()
    arguments = {argument.name: argument for argument in description.get_launch_arguments()}
    assert set(module.ARGUMENTS) == set(arguments)
    # actions that depend on arguments are made with their defaults
    context = launch.LaunchContext()
    for name, (default, _) in module.ARGUMENTS.items():
        context.launch_configurations[name] = default
    assert module.start(context)
