"""Models: effects, parameters, formulas, simulation."""

import pickle

import numpy as np
import pytest

import excavator

LAW = {
    "name": "load_damping",
    "acts_on": "piston_force",
    "formula": "-k*v*abs(p_cap - p_rod)",
    "summary": "Damping that grows with the load.",
    "parameters": {"k": {"unit": "N s/(m Pa)", "maximum": 1.0, "start": [1e-3], "meaning": "damping per pressure"}},
}


def test_a_built_in_model_is_loaded():
    model = excavator.Model.load("zx30u-arm")
    assert model.name == "zx30u-arm" and model.cylinders == ["arm"]
    assert "zx30u-arm" in excavator.Model.built_in()
    inertia = model.parameters["arm.inertia"]
    assert inertia.unit == "kg m2" and inertia.effect == "inertia" and inertia.meaning
    assert float(inertia) == model["arm.inertia"]
    assert "inertia@arm" in map(str, model.effects)
    assert "<table>" in model._repr_html_() and "zx30u-arm" in repr(model)


def test_unknown_models_are_told():
    with pytest.raises(excavator.ModelError, match="did you mean"):
        excavator.Model.load("zx30u-arn")
    with pytest.raises(excavator.ModelError, match="no template"):
        excavator.Model.template("nothing")
    with pytest.raises(excavator.ModelError, match="is not a model file"):
        excavator.Model.from_toml("x =")


def test_templates_are_models():
    assert excavator.Model.templates()
    for name in excavator.Model.templates():
        model = excavator.Model.template(name)
        assert excavator.Model.from_toml(model.to_toml()).parameters == model.parameters


def test_text_is_read_back(tmp_path):
    model = excavator.Model.load("zx30u-arm")
    assert excavator.Model.from_toml(model.to_toml()).to_toml() == model.to_toml()
    model.save(tmp_path / "model.toml")
    assert excavator.Model.load(tmp_path / "model.toml").to_toml() == model.to_toml()
    with pytest.raises(FileExistsError):
        model.save(tmp_path / "model.toml")
    assert pickle.loads(pickle.dumps(model)).to_toml() == model.to_toml()


def test_values_are_set():
    model = excavator.Model.load("zx30u-arm")
    other = model.with_values({"arm.inertia": 2 * model["arm.inertia"]})
    assert other["arm.inertia"] == 2 * model["arm.inertia"]
    other.set("arm.inertia", 50.0, known=True, source="CAD")
    assert other.parameters["arm.inertia"].known and other.parameters["arm.inertia"].source == "CAD"
    with pytest.raises(KeyError, match="no parameter"):
        model.set("arm.nothing", 1.0)
    with pytest.raises(excavator.ModelError, match="impossible"):
        model.set("arm.bulk_modulus", -1.0)


def test_effects_come_and_go():
    model = excavator.Model.load("zx30u-arm")
    more = model.with_effect("pump_leakage")
    assert [str(one) for one in more.effects if one not in model.effects] == ["pump_leakage@pump"]
    assert more.without_effect("pump_leakage@pump").to_toml() == model.to_toml()
    with pytest.raises(excavator.ModelError, match="did you mean"):
        model.with_effect("pump_leakag")
    with pytest.raises(excavator.ModelError, match="has no effect"):
        model.without_effect("pump_leakage")


def test_formulas_become_effects(tmp_path):
    model = excavator.Model.load("zx30u-arm")
    own = model.with_effect(LAW, at="arm", values={"k": 5e-3})
    assert own["arm.k"] == 5e-3
    assert "load_damping" in own.to_toml()
    assert "load_damping" in model.with_catalogue(LAW).catalogue
    assert "load_damping" not in {one.name for one in model.with_catalogue(LAW).effects}
    with pytest.raises(excavator.ModelError, match="cannot add"):
        model.with_catalogue(LAW | {"formula": "k + p_cap"})


def test_commands_are_simulated_from_rest():
    model = excavator.Model.load("zx30u-arm")
    time = np.arange(0, 2, 1e-3)
    simulated = model.simulate({"time": time, "arm.orifice_command": 3e-5 * np.sin(2 * np.pi * time)})
    assert len(simulated) == len(time)
    assert np.ptp(simulated["arm.displacement"]) > 0.005
    profile = {"profiles": [{"cylinder": "arm", "segments": [
        {"kind": "sine", "duration": 2.0, "amplitude": 3e-5, "frequency": 1.0}]}]}
    assert np.ptp(model.simulate(profile, start={"arm": 0.05})["arm.displacement"]) > 0.005
    with pytest.raises(excavator.ModelError, match="times"):
        model.simulate({"arm.orifice_command": time})


def test_recordings_are_simulated(samples):
    model = excavator.Model.load("zx30u-arm")
    rec = excavator.read(samples / "arm-swing")
    simulated = model.simulate(rec)
    np.testing.assert_array_equal(simulated.time, rec.time)
    found = excavator.compare(model, rec)
    np.testing.assert_array_equal(simulated["arm.cap_pressure"], found.simulated["arm.cap_pressure"])
    with pytest.raises(excavator.ModelError, match="start"):
        model.simulate(rec, start={"arm": 0.1})
