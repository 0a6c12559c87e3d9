"""Launch files: valid Python everywhere; with ROS 2's launch here, descriptions that can be shown."""

import importlib.util
import os
import shutil
import signal
import subprocess
import time
from pathlib import Path

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


def test_ros2_launch_starts_simulator_and_monitor_and_ends_them(tmp_path):
    if not shutil.which("ros2"):
        pytest.skip("ROS 2's command line is not installed")
    program = Path(os.environ.get("EXCAVATOR_BINARY", CONFIG.parent / "target/debug/excavator")).resolve()
    if not program.is_file():
        pytest.skip(f"{program} is not built")
    words = ["ros2", "launch", CONFIG / "launch" / "simulation.launch.py", f"program:={program}"]
    output = tmp_path / "output"
    with open(output, "w") as file:
        environment = dict(os.environ, ROS_DOMAIN_ID="102", ROS_LOG_DIR=str(tmp_path))
        launched = subprocess.Popen(words, stdout=file, stderr=file, env=environment, start_new_session=True)
        try:
            # Each node has written a line of its own log: from there on it obeys Ctrl-C.
            while not all(f"[{name}]: " in output.read_text() for name in ("energy_monitor", "arm_simulator")):
                assert launched.poll() is None, output.read_text()
                time.sleep(0.1)
            launched.send_signal(signal.SIGINT)
            assert launched.wait() == 0, output.read_text()
        finally:
            if launched.poll() is None:
                os.killpg(launched.pid, signal.SIGKILL)
    said = output.read_text()
    assert "Caught exception" not in said
    assert said.count("process has finished cleanly") == 2, said
