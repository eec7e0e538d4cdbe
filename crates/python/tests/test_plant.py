"""Plants of users: the numbers and names of the command, refusals in words."""

import json
import pickle
import re
import subprocess
import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import gyrocal
from conftest import command, run_command, without_command_line

FOLDER = Path("examples/duffing")
COLUMNS = {"time": "time_s", "inputs": {"u": "drive_n"}, "outputs": {"y": "displacement_m"}}


class Declared:
    """What a declaration gives: the text of its program file."""

    def to_json(self):
        return (FOLDER / "plant.json").read_text()


@pytest.fixture(scope="module")
def found():
    plant = gyrocal.Plant(FOLDER / "plant.json")
    return plant.diagnose(FOLDER / "record.csv", FOLDER / "columns.toml", later=FOLDER / "later.csv")


def test_numbers_and_names_are_those_of_the_command(tmp_path, found):
    arguments = ["plant", "diagnose", FOLDER / "plant.json", FOLDER / "record.csv"]
    arguments += ["--columns", FOLDER / "columns.toml", "--validate", FOLDER / "later.csv"]
    by_command = run_command(arguments, tmp_path)
    assert without_command_line(found.to_dict()) == without_command_line(by_command)
    assert found.manifest.command.startswith("gyrocal.Plant.diagnose('examples/duffing/record.csv'")
    assert len(found.findings) == 1
    frame = found.to_pandas()
    assert list(frame.effect) == [found.findings[0].effect]
    assert frame["size"][0] == found.findings[0].parameters[0].estimate
    assert found.findings[0].effect in repr(found)
    assert "<p>" in found._repr_html_()
    assert pickle.loads(pickle.dumps(found)) == found
    assert str(pickle.loads(pickle.dumps(found))) == str(found)
    again = gyrocal.from_json(found.to_json())
    assert type(again) is gyrocal.PlantDiagnosis and again == found and again.summary() == found.summary()
    assert again.names == [one.name for one in found.coefficients.extended]
    assert again.conf_int().shape == (len(again.names), 2) and list(again.pvalues) == [found.findings[0].effect]


@pytest.fixture(scope="module")
def fitted():
    plant = gyrocal.Plant(FOLDER / "plant.json")
    files = FOLDER / "record.csv", FOLDER / "columns.toml"
    return plant.fit(*files, later=FOLDER / "later.csv", first_rows=20)


def test_a_fit_is_that_of_the_command(tmp_path, fitted):
    arguments = ["plant", "fit", FOLDER / "plant.json", FOLDER / "record.csv", "--first-rows", 20]
    arguments += ["--columns", FOLDER / "columns.toml", "--later", FOLDER / "later.csv"]
    by_command = run_command(arguments, tmp_path)
    assert without_command_line(fitted.to_dict()) == without_command_line(by_command)
    assert fitted.manifest.command.endswith("later='examples/duffing/later.csv', first_rows=20)")
    again = gyrocal.from_json(fitted.to_json())
    assert type(again) is gyrocal.PlantFit and again == fitted and again.summary() == fitted.summary()
    page = tmp_path / "page.html"
    fitted.report(page)
    assert "Largest correlations" in page.read_text()
    frame = fitted.to_pandas()
    assert list(frame.name) == fitted.names and list(frame.declared) == fitted.coefficients.declared


def test_a_fit_has_the_names_that_other_packages_use(fitted):
    assert (fitted.llf, fitted.nobs) == (fitted.log_likelihood, fitted.values)
    assert fitted.aic == pytest.approx(2 * fitted.unknowns - 2 * fitted.llf, rel=1e-12)
    assert np.allclose(fitted.bse**2, np.diag(fitted.cov_params()), rtol=1e-9)
    low, high = fitted.conf_int().T
    assert np.all((low < fitted.params) & (fitted.params < high))


def rms(errors):
    return float(np.sqrt(np.nanmean(errors**2)))


def test_outputs_over_time_are_those_that_the_errors_are_of(found, fitted):
    record = pd.read_csv(FOLDER / "record.csv")
    for one in (found, fitted):
        assert one.output_names == ["y"] and np.array_equal(one.time_s, record.time_s)
        assert np.array_equal(one.measured[:, 0], record.displacement_m)
        assert np.array_equal(one.resid, one.measured - one.fittedvalues)
        assert np.array_equal(one.predict(), one.fittedvalues)
        with pytest.raises(ValueError, match="read-only"):
            one.measured[0] = 0.0
        again = pickle.loads(pickle.dumps(one))
        assert np.array_equal(again.resid, one.resid) and not again.measured.flags.writeable
    # What the first rows are, is not counted.
    assert rms(fitted.resid[20:]) == pytest.approx(fitted.outputs[0].open_loop.rms, rel=1e-9)
    ahead = fitted.measured - fitted.predict(one_step=True)
    assert rms(ahead[20:]) == pytest.approx(fitted.outputs[0].one_step.rms, rel=1e-9)
    # That of the model with what was found, which the nominal one is beside.
    error = found.open_loop[0]
    assert rms(found.resid) == pytest.approx(error.extended, rel=1e-9) and error.extended < error.nominal / 2


def test_columns_of_arrays_are_the_outputs_of_the_plant():
    plant = gyrocal.Plant("examples/cart_pole_diagnosed/plant.json")
    random, time_s = np.random.default_rng(1), 0.02 * np.arange(200)
    record = {"time_s": time_s, "force": 0.1 * np.sin(3.0 * time_s)}
    record |= {"theta": 0.02 * random.normal(size=200), "x": 0.01 * random.normal(size=200)}
    fit = plant.fit(record)
    assert fit.output_names == plant.outputs == ["x", "theta"] and fit.nobs == 400
    assert np.array_equal(fit.measured, np.column_stack([record["x"], record["theta"]]))
    for place, one in enumerate(fit.outputs):
        assert rms(fit.resid[:, place]) == pytest.approx(one.open_loop.rms, rel=1e-9)
    assert [axes.get_ylabel().split(" [")[0] for axes in fit.plot().axes] == [
        "x", "residual of x", "theta", "residual of theta"
    ]


def test_a_result_from_json_tells_that_it_has_no_outputs_over_time(found, fitted):
    for one in (found, fitted):
        again = gyrocal.from_json(one.to_json())
        assert not hasattr(again, "resid") and not hasattr(again, "time_s")
        for call in (lambda of: of.resid, lambda of: of.predict(), lambda of: of.plot()):
            with pytest.raises(AttributeError, match="not in the JSON .* again"):
                call(again)


def test_plots_show_record_simulation_and_residual(found, fitted):
    for one in (found, fitted):
        above, below = one.plot().axes
        measured, simulated = above.lines
        assert np.array_equal(measured.get_ydata(), one.measured[:, 0])
        assert np.array_equal(simulated.get_ydata(), one.fittedvalues[:, 0])
        assert np.array_equal(below.lines[0].get_ydata(), one.resid[:, 0])
        assert above.get_ylabel() == "y [m]" and below.get_xlabel() == "time [s]"
    with pytest.raises(gyrocal.InputError, match="fig: found a int, expected a figure"):
        fitted.plot(fig=3)


def test_gaps_are_told_in_the_words_of_the_command(tmp_path):
    gap = tmp_path / "gap.csv"
    frame = pd.read_csv(FOLDER / "record.csv")
    frame.drop(range(100, 130)).to_csv(gap, index=False)
    plant, columns = gyrocal.Plant(FOLDER / "plant.json"), FOLDER / "columns.toml"
    call = [command(), "plant", "fit", FOLDER / "plant.json", gap, "--columns", columns]
    told = subprocess.run(call, capture_output=True, text=True, check=True).stderr
    for work in (plant.fit, plant.diagnose):
        with pytest.warns(gyrocal.GyrocalWarning, match="column `drive_n`.*between rows 100 and 101") as caught:
            work(gap, columns)
        assert len(caught) == 1 and caught[0].filename == __file__
        assert str(caught[0].message) in told
    # A user makes an error of it: it is told before the work.
    with warnings.catch_warnings():
        warnings.simplefilter("error", gyrocal.GyrocalWarning)
        with pytest.raises(gyrocal.GyrocalWarning, match="^<DataFrame>: input `u`"):
            plant.fit(frame, COLUMNS, later=frame.drop(range(100, 130)))
        plant.fit(frame, COLUMNS)


def test_a_declared_plant_takes_frames(found):
    plant = pickle.loads(pickle.dumps(gyrocal.Plant(Declared())))
    assert (plant.name, plant.inputs, plant.outputs) == ("Duffing", ["u"], ["y"])
    assert found.findings[0].effect in plant.effects
    frame = pd.read_csv(FOLDER / "record.csv")
    again = plant.diagnose(frame, COLUMNS)
    assert again.findings == found.findings
    # Values and declarations have no files: their hashes are of what they hold.
    assert [one.path for one in again.manifest.inputs] == ["<DataFrame>", "<columns>", "<Declared>"]
    assert again.manifest.inputs[2].sha256 == found.manifest.inputs[2].sha256
    # A later record is another frame.
    later = plant.diagnose(frame, COLUMNS, later=pd.read_csv(FOLDER / "later.csv"), false_alarm=0.02)
    assert later.gain.validation.log_score_nats == found.gain.validation.log_score_nats
    assert later.manifest.command == (
        "gyrocal.Plant.diagnose(<DataFrame>, <dict>, later=<DataFrame>, false_alarm=0.02)"
    )
    # Other units of the same numbers: factors of two change no bit.
    doubled = frame.assign(displacement_m=2.0 * frame.displacement_m)
    columns = COLUMNS | {"outputs": {"y": {"column": "displacement_m", "factor": 0.5}}}
    assert plant.diagnose(doubled, columns).findings == found.findings


def data_of(page):
    """What the charts of a page show."""
    return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.S)[1])


def test_its_page_is_that_of_the_command(tmp_path, found, diagnosed):
    by_command, page = tmp_path / "command.html", tmp_path / "page.html"
    arguments = ["plant", "diagnose", FOLDER / "plant.json", FOLDER / "record.csv"]
    arguments += ["--columns", FOLDER / "columns.toml", "--validate", FOLDER / "later.csv"]
    run_command([*arguments, "--report", by_command], tmp_path)
    found.report(page)
    text = page.read_text()
    assert "MODEL LACKS SOMETHING" in text and "v_rate.x^3" in text and "gyrocal.Plant.diagnose(" in text
    assert data_of(text) == data_of(by_command.read_text())
    gyrocal.report([found, diagnosed], page)
    assert "v_rate.x^3" in page.read_text() and "gyro_y.g_z" in page.read_text()
    # One that was pickled has all but the charts.
    pickle.loads(pickle.dumps(found)).report(page)
    assert "v_rate.x^3" in page.read_text() and not data_of(page.read_text())["charts"]


def test_wrong_input_is_refused_in_words(tmp_path):
    plant = gyrocal.Plant(FOLDER / "plant.json")
    frame = pd.read_csv(FOLDER / "record.csv")
    for columns, words in [
        (COLUMNS | {"inputs": {}}, "input `u`"),
        (COLUMNS | {"inputs": {"u": "drive_n", "w": "drive_n"}}, "input `w`"),
        (COLUMNS | {"outputs": {"y": "displacement"}}, "column `displacement`"),
        ({key: COLUMNS[key] for key in ("inputs", "outputs")}, "time"),
        (None, "column `time`|column `u`|column `time_s`"),
    ]:
        with pytest.raises(gyrocal.InputError, match=words):
            plant.diagnose(frame, columns)
    with pytest.raises(gyrocal.InputError, match="object"):
        plant.diagnose(frame.assign(drive_n=[None] + ["a"] * (len(frame) - 1)), COLUMNS)
    with pytest.raises(gyrocal.InputError, match="drive|input|number"):
        plant.diagnose(frame.assign(drive_n=float("nan")), COLUMNS)
    with pytest.raises(gyrocal.InputError, match="a list of 2, expected one record"):
        plant.diagnose([frame, frame], COLUMNS)
    with pytest.raises(gyrocal.InputError, match="false_alarm"):
        plant.diagnose(frame, COLUMNS, false_alarm=0.0)
    with pytest.raises(gyrocal.InputError, match="cannot be read"):
        gyrocal.Plant(tmp_path / "missing.json")
    with pytest.raises(gyrocal.GyrocalError):
        plant_file = tmp_path / "other.json"
        plant_file.write_text("{}")
        gyrocal.Plant(plant_file)
    with pytest.raises(gyrocal.InputError, match="found a int"):
        gyrocal.Plant(3)
    short = tmp_path / "short.csv"
    short.write_text("time_s,drive_n,displacement_m\n0,1\n")
    with pytest.raises(gyrocal.InputError, match="short.csv:2"):
        plant.diagnose(short, COLUMNS)
