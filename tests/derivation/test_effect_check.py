"""The check of the entries of the catalogue: pytest tests/derivation."""

import casadi as ca
import pytest
from casadi_program import ExportError
from catalogue import EFFECTS
from effect import Effect, Enters, Kind, Parameter
from effect_check import check
from layout import drift

KNOWN = [element.id for element in drift.elements]


def effect(term, kind: Kind = Kind.REGRESSOR, **fields) -> Effect:
    return Effect("gyro_x.own", kind, Enters.RATE, "a term", (Parameter("size", "deg/h"),), 0.01,
                  term=term, **fields)


def refused(entry: Effect) -> str:
    with pytest.raises(ExportError) as error:
        check([entry], [*KNOWN, entry.id])
    return str(error.value)


def test_the_catalogue_is_accepted():
    check(EFFECTS, KNOWN + [entry.id for entry in EFFECTS])


@pytest.mark.parametrize("power, term", [
    (1, lambda at: at.temperature_rate_k_per_h),
    (1, lambda at: at.a["y"] * at.temperature_hysteresis_k),
    (2, lambda at: at.temperature_k**2),
    (2, lambda at: at.temperature_k * at.temperature_rate_k_per_h),
    (3, lambda at: at.temperature_k**3),
])
def test_a_regressor_has_its_power(power, term):
    own = [effect(lambda p, at: {"x": p["size"] * term(at)}, power=other) for other in (1, 2, 3)]
    for other, entry in enumerate(own, start=1):
        if other == power:
            check([entry], [*KNOWN, entry.id])
        else:
            assert f"proportional to the power {other} of the regressors" in refused(entry)


@pytest.mark.parametrize("term, found", [
    (lambda at: at.a["y"], "kind REGRESSOR without a regressor in its term"),
    (lambda at: at.time_s, "kind REGRESSOR without a regressor in its term"),
    (lambda at: 1 + at.temperature_k, "proportional to the power 1"),
    (lambda at: ca.exp(at.temperature_rate_k_per_h), "proportional to the power 1"),
    (lambda at: at.humidity, "its term asks for `humidity`"),
])
def test_what_is_no_power_of_a_regressor_is_refused(term, found):
    text = refused(effect(lambda p, at: {"x": p["size"] * term(at)}))
    assert found in text
    assert "codegen/derive/catalogue.py: effect `gyro_x.own`" in text


@pytest.mark.parametrize("name", [
    "temperature_k", "temperature_rate_k_per_h", "temperature_hysteresis_k",
])
def test_a_constant_has_no_regressor(name):
    entry = effect(lambda p, at: {"x": p["size"] * getattr(at, name)}, Kind.CONSTANT)
    assert "kind CONSTANT with a term of temperature" in refused(entry)
    assert f"`at.{name}`" in refused(effect(lambda p, at: {"x": p["size"] * at.a["x"]}))


@pytest.mark.parametrize("kind, power", [(Kind.CONSTANT, 2), (Kind.REGRESSOR, 0)])
def test_only_a_regressor_has_a_power(kind, power):
    entry = effect(lambda p, at: {"x": p["size"]}, kind, power=power)
    assert f"with the power {power}" in refused(entry)
