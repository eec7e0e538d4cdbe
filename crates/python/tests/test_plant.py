"""Plants of users: the numbers and names of the command, refusals in words."""

import json
import pickle
import re
from pathlib import Path

import pandas as pd
import pytest

import gyrocal
from conftest import run_command, without_command_line

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
    frame = found.to_dataframe()
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
