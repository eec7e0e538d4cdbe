"""Plants that are refused, and what the catalogue leaves out; all in words."""

import json

import casadi as ca
import pytest
from gyrocal_plant import Plant, PlantError, units


def oscillator():
    plant = Plant("Oscillator", "A mass on a spring.")
    x = plant.state("x", "m", typical=1.0)
    v = plant.state("v", "m/s", typical=1.0)
    k = plant.parameter("k", "s^-2", 4.0)
    plant.rate("x", v)
    plant.rate("v", -k * x)
    plant.output("y", "m", x, sigma=0.01)
    return plant, x, v


def test_units_that_disagree_are_refused():
    plant = Plant("Wrong", "")
    x, c = plant.state("x", "m"), plant.parameter("c", "kg")
    plant.rate("x", -c * x)
    plant.output("y", "m", x, sigma=1.0)
    with pytest.raises(PlantError, match="units of the rate of `x` disagree"):
        plant.to_json()


def test_a_state_that_no_output_depends_on_is_refused():
    plant, x, _ = oscillator()
    hidden = plant.state("hidden")
    plant.rate("hidden", -hidden)
    with pytest.raises(PlantError, match="no output depends on state `hidden`"):
        plant.to_json()


@pytest.mark.parametrize("term, why", [
    (lambda x, v: 0 * x, "is identically zero"),
    (lambda x, v: 3 * x, "does the same as a change of the nominal parameter `k`"),
])
def test_terms_that_add_nothing_are_refused(term, why):
    plant, x, v = oscillator()
    plant.effect("mine", ca.SX(term(x, v)), rate="v")
    with pytest.raises(PlantError, match=why):
        plant.to_json()


def test_a_copy_is_refused():
    plant, x, v = oscillator()
    plant.effect("one", x**3, rate="v")
    plant.effect("other", 2 * x**3, rate="v")
    with pytest.raises(PlantError, match="is a copy of `one`"):
        plant.to_json()


def test_terms_that_differ_by_a_nominal_one_are_equivalent():
    plant, x, v = oscillator()
    plant.effect("one", x**3, rate="v")
    plant.effect("other", x**3 + x, rate="v")
    tables = {table["name"]: table for table in json.loads(plant.to_json())["tables"]}
    effects = {row[0]: row[-1] for row in tables["plant_effects"]["rows"]}
    assert effects["one"] == ["other"] and effects["other"] == ["one"]


def test_rates_by_definition_get_no_terms():
    plant, *_ = oscillator()
    tables = {table["name"]: table for table in json.loads(plant.to_json())["tables"]}
    names = [row[0] for row in tables["plant_effects"]["rows"]]
    assert "v_rate.x^3" in names and not any(name.startswith("x_rate") for name in names)


def test_a_known_period_gives_waves():
    plant, *_ = oscillator()
    plant.regressor("temperature")
    plant.period("shaft", 3.0)
    tables = {table["name"]: table for table in json.loads(plant.to_json())["tables"]}
    assert tables["plant_periods"]["rows"] == [["shaft", 3.0]]
    fields = [field["name"] for field in tables["plant_effects"]["fields"]]
    place = {row[0]: row[fields.index("regressor")] for row in tables["plant_effects"]["rows"]}
    assert place["v_rate.temperature"] == 0
    assert (place["v_rate.shaft.sine"], place["v_rate.shaft.cosine"]) == (1, 2)
    with pytest.raises(PlantError, match="declared twice"):
        plant.period("shaft", 4.0)
    with pytest.raises(PlantError, match="expected more than 0"):
        plant.period("day", 0.0)


def test_a_knee_is_a_parameter_and_extends_the_plant_as_one():
    plant, *_ = oscillator()
    program = json.loads(plant.to_json())
    knees = next(table for table in program["tables"] if table["name"] == "plant_knees")
    fields = [field["name"] for field in knees["fields"]]
    elements = next(group for group in program["groups"] if group["name"] == "parameters")["elements"]
    for row in knees["rows"]:
        knee = dict(zip(fields, row))
        own = elements[int(knee["constant"])]["id"]
        assert own == elements[int(knee["size"])]["id"] + ".knee"
        assert (knee["unit"], knee["value"]) in [("m", 0.5), ("m/s", 0.5)]
    plant, *_ = oscillator()
    plant.extend("v_rate.above(x)", -2.0, knee=0.8)
    tables = {table["name"]: table for table in json.loads(plant.to_json())["tables"]}
    values = {row[0]: row[2] for row in tables["plant_parameters"]["rows"]}
    assert values == {"k": 4.0, "v_rate.above(x)": -2.0, "v_rate.above(x).knee": 0.8}
    plant, *_ = oscillator()
    plant.extend("v_rate.x^3", knee=0.8)
    with pytest.raises(PlantError, match="has no knee"):
        plant.to_json()


def test_units_are_parsed():
    assert units.parse("N s/m") == units.parse("kg s^-1")
    assert units.parse("V") == units.parse("W/A")
    with pytest.raises(ValueError, match="has `\\(m\\)`"):
        units.parse("(m)")


def test_a_dead_time_is_a_parameter_and_its_input_acts_late():
    plant = Plant("Late", "A lag with a dead time.")
    x = plant.state("x", "V", typical=1.0)
    u = plant.input("u", "V", typical=1.0)
    late = plant.delay(u, "s", 0.25, sigma=0.1)
    plant.rate("x", plant.parameter("b", "s^-1", 0.5) * (late - x))
    plant.output("y", "V", x, sigma=0.1)
    program = json.loads(plant.to_json())
    tables = {table["name"]: table for table in program["tables"]}
    assert tables["plant_parameters"]["rows"][0] == ["u.delay", "s", 0.25, 0.1, False]
    elements = next(group for group in program["groups"] if group["name"] == "parameters")["elements"]
    (delay,) = tables["plant_delays"]["rows"]
    assert [elements[int(place)]["id"] for place in delay[1:]] == ["u.late", "u.delay"]
    # What is estimated is no effect beside it.
    assert "u.delay" not in [row[0] for row in tables["plant_effects"]["rows"]]
    with pytest.raises(PlantError, match="is declared twice"):
        plant.delay(u, "s", 0.1)
    with pytest.raises(PlantError, match="is not that of an input"):
        plant.delay(x, "s", 0.1)
    with pytest.raises(PlantError, match="expected `s`"):
        plant.delay(plant.input("w", "V"), "ms", 1.0)


def test_a_reading_uses_no_delayed_input():
    plant = Plant("Late", "A lag with a dead time.")
    x = plant.state("x", "V", typical=1.0)
    late = plant.delay(plant.input("u", "V", typical=1.0))
    plant.rate("x", plant.parameter("b", "s^-1", 0.5) * (late - x))
    plant.output("y", "V", x + late, sigma=0.1)
    with pytest.raises(PlantError, match="uses a delayed input"):
        plant.to_json()


def test_a_delay_that_was_found_extends_the_plant():
    plant = Plant("Late", "A lag.")
    x = plant.state("x", "V", typical=1.0)
    plant.rate("x", plant.parameter("b", "s^-1", 0.5) * (plant.input("u", "V", typical=1.0) - x))
    plant.output("y", "V", x, sigma=0.1)
    plant.extend("u.delay", 0.3)
    tables = {table["name"]: table for table in json.loads(plant.to_json())["tables"]}
    values = {row[0]: row[2] for row in tables["plant_parameters"]["rows"]}
    assert values == {"b": 0.5, "u.delay": 0.3}
    effects = {row[0]: row[2] for row in tables["plant_effects"]["rows"]}
    assert "u.delay" not in effects and "u.play" in effects
    # Terms of the rates act late too; a reading has no part of what acts late.
    assert effects["x_rate.u^2"] == "sq(u_late)"
    assert "y.lag" not in effects
