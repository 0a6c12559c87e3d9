"""Verbs: agreement with the program, progress, interruption, plots."""

import os
import signal
import threading
import time

import numpy as np
import pytest

import excavator

MODEL = "zx30u-arm"
LAW = {
    "name": "load_damping",
    "acts_on": "piston_force",
    "formula": "-k*v*abs(p_cap - p_rod)",
    "summary": "Damping that grows with the load.",
    "parameters": {"k": {"unit": "N s/(m Pa)", "maximum": 1.0, "start": [1e-3], "meaning": "damping per pressure difference"}},
}


@pytest.fixture(scope="module")
def hidden():
    """Model and recordings of the sample with a law that is not in the catalogue."""
    from conftest import SAMPLES

    folder = SAMPLES / "hidden-law"
    return excavator.Model.load(MODEL), excavator.read(folder / "identification"), excavator.read(folder / "validation")


LONG = bool(os.environ.get("EXCAVATOR_LONG"))


@pytest.fixture(scope="module")
def pair(hidden):
    """Model and two recordings for slow tests: the halves of one recording, or both recordings if EXCAVATOR_LONG is set."""
    from conftest import SAMPLES

    path = SAMPLES / "hidden-law/validation"
    return hidden if LONG else (hidden[0], excavator.read(path, stop=5.0), excavator.read(path, start=5.0))


@pytest.fixture(scope="module")
def diagnosis(pair):
    """A diagnosis, and the reported progress."""
    told = []
    found = excavator.diagnose(*pair, progress=lambda what, done: told.append((what, done)))
    return found, told


def names(samples):
    folder = samples / "hidden-law"
    parts = [folder / "identification", folder / "validation"] if LONG else [f"{folder}/validation@..5", f"{folder}/validation@5.."]
    return ["--identification", parts[0], "--validation", parts[1]]


def test_compare(hidden, samples, tmp_path):
    model, _, validation = hidden
    found = excavator.compare(model, validation)
    assert found.mean_nmse == pytest.approx(0.131, abs=0.001)
    assert found.nmse["arm.displacement"] == pytest.approx(0.1059, abs=1e-4)
    assert "explains 87 %" in found.sentence
    assert "<iframe" in found._repr_html_()
    found.page(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text() == found.html()
    assert len(found.measured) == len(found.simulated) == len(validation)


def test_compare_equals_the_program(hidden, samples, program):
    model, identification, validation = hidden
    folder = samples / "hidden-law"
    own = program("compare", "--model", MODEL, "--bag", folder / "validation")
    assert excavator.compare(model, validation).to_dict() == own
    own = program("compare", "--model", MODEL, "--bag", folder / "validation", "--against", "zx30u-arm", "--where", "abs(v) > 0.002")
    with pytest.warns(excavator.Remark, match="left out"):
        assert excavator.compare(model, validation, against=model, where="abs(v) > 0.002").to_dict() == own


def test_json_is_that_of_the_program_character_by_character(hidden, samples, program):
    model, _, validation = hidden
    text = program("compare", "--model", MODEL, "--bag", samples / "hidden-law/validation", as_text=True)
    assert excavator.compare(model, validation).to_json() == text
    assert text.startswith('{\n  "') and text.endswith("}\n")


@pytest.mark.parametrize("method", ["weak-form", "least-squares", pytest.param("best", marks=pytest.mark.full)])
def test_identify_equals_the_program(hidden, samples, program, method):
    model, identification, _ = hidden
    own = program("identify", "--model", MODEL, "--bag", samples / "hidden-law/identification", "--method", method)
    assert excavator.identify(model, identification, method=method).to_dict() == own


def test_identify(hidden):
    model, identification, _ = hidden
    found = excavator.identify(model, identification)
    name = next(iter(found.parameters))
    assert found.model[name] == found.parameters[name]["value"]
    assert found.model.history and "Identified" in found.sentence
    assert "<table>" in found._repr_html_()
    assert len(found.to_pandas()) == len(found.parameters)


def test_energy_equals_the_program(hidden, samples, program):
    model, _, validation = hidden
    own = program("energy", "--model", MODEL, "--bag", samples / "hidden-law/validation")
    assert excavator.energy(model, validation).to_dict() == own


def test_energy(hidden):
    model, _, validation = hidden
    found = excavator.energy(model, validation)
    assert found.losses and isinstance(found.closes, bool) and "ledger" in found.sentence


def test_characterise_equals_the_program(hidden, samples, program):
    model, identification, _ = hidden
    own = program("characterise", "--model", MODEL, samples / "hidden-law/identification")
    assert excavator.characterise(model, identification).to_dict() == own


@pytest.mark.full
def test_diagnose(diagnosis):
    found, told = diagnosis
    if LONG:
        assert found.verdict == "unexplained"
        assert "Something is missing" in found.sentence
    assert found.verdict in ("missing_effect", "unexplained", "adequate", "ambiguous") and found.sentence.endswith(".")
    assert told and all(isinstance(what, str) and 0 <= done <= 1 for what, done in told)
    assert found.model.effects and "<iframe" in found._repr_html_()


@pytest.mark.full
def test_diagnose_equals_the_program(diagnosis, samples, program):
    assert diagnosis[0].to_dict() == program("diagnose", "--model", MODEL, *names(samples))


def test_own_laws_compete(hidden, samples):
    model, *recordings = hidden
    found = excavator.refine(model.with_catalogue(LAW), *recordings, add="load_damping@arm")
    assert found.steps[-1]["added"] == "load_damping@arm"
    assert found.model["arm.k"] == pytest.approx(0.0184, rel=0.05)
    after = excavator.compare(found.model, recordings[1])
    assert after.mean_nmse < 0.1 * excavator.compare(model, recordings[1]).mean_nmse


@pytest.mark.full
def test_refine_equals_the_program_and_tells_its_progress(hidden, samples, program, tmp_path, capfd):
    model, *recordings = hidden
    folder = samples / "hidden-law"
    names = ["--identification", folder / "identification", "--validation", folder / "validation"]
    added = ["--add", "pump_leakage", "-o", tmp_path / "out.toml"]
    own = program("refine", "--model", MODEL, *names, *added)
    assert own.pop("model") == str(tmp_path / "out.toml")
    found = excavator.refine(model, *recordings, add="pump_leakage", progress=True).to_dict()
    assert "%" in capfd.readouterr().err
    assert found.pop("model") is None
    assert found == own


def test_design(hidden, tmp_path):
    model = hidden[0]
    found = excavator.design(model, parameter="arm.inertia", duration=20.0)
    assert found["parameter"] == "arm.inertia"
    found.save(tmp_path / "profile.toml")
    assert len(model.simulate(tmp_path / "profile.toml")) > 1000
    assert "<table>" in found._repr_html_()
    with pytest.raises(excavator.ComputationError, match="nothing to be told from"):
        excavator.design(model, between=["none"])


def test_checks_refuse_and_are_overruled(hidden):
    model, _, validation = hidden
    swapped = validation.with_signals(
        {"arm.cap_pressure": validation["arm.rod_pressure"], "arm.rod_pressure": validation["arm.cap_pressure"]}
    )
    with pytest.raises(excavator.CheckError, match=r'accept=\["'):
        excavator.compare(model, swapped)
    with pytest.warns(excavator.Remark, match="accepted"):
        excavator.compare(model, swapped, accept=["swapped-pressures"])


def test_conditions_are_read(hidden):
    model, _, validation = hidden
    with pytest.raises(excavator.ModelError):
        excavator.compare(model, validation, where="abs(v >")


def test_other_threads_run_meanwhile(hidden):
    ticks, stop = [], threading.Event()

    def tick():
        while not stop.wait(0.005):
            ticks.append(time.perf_counter())

    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.perf_counter()
    excavator.identify(hidden[0], hidden[1], method="output-error")
    took = time.perf_counter() - begin
    stop.set()
    thread.join()
    assert len([one for one in ticks if one > begin]) > 10 * min(took, 1.0)


def test_ctrl_c_ends_the_work(hidden):
    # A shell starts background processes with SIGINT ignored, and Python keeps this setting.
    usual = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        told = [0.0]
        # From another thread, so that it finds this one at work and not in the report of its progress.
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        with pytest.raises(KeyboardInterrupt):
            excavator.diagnose(*hidden, progress=lambda what, done: told.append(done))
        assert max(told) < 0.9, "the search went on to its end"
    finally:
        signal.signal(signal.SIGINT, usual)


def test_errors_in_progress_are_passed_on(hidden):
    def fail(what, done):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        excavator.diagnose(*hidden, progress=fail)


@pytest.mark.full
def test_pictures(hidden, diagnosis):
    pytest.importorskip("matplotlib").use("agg")
    model, identification, validation = hidden
    found = excavator.compare(model, validation)
    assert len(found.plot().axes) == len(found.nmse)
    assert len(found.plot("arm.displacement").axes) == 1
    for one in [excavator.identify(model, identification), diagnosis[0], excavator.energy(model, validation)]:
        assert one.plot().axes


def test_arrays_of_a_result_are_recordings(hidden):
    found = excavator.compare(hidden[0], hidden[2])
    error = found.measured["arm.displacement"] - found.simulated["arm.displacement"]
    nmse = np.mean(error**2) / np.var(found.measured["arm.displacement"])
    assert nmse == pytest.approx(found.nmse["arm.displacement"], rel=0.05)
