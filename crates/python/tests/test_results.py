"""Results as attributes, plain data, frames and HTML; the command of the package."""

import copy
import importlib.metadata
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import gyrocal
from conftest import ROOT, command


def test_keys_are_attributes(diagnosed):
    plain = diagnosed.to_dict()
    assert diagnosed.verdict == plain["verdict"] == "effects-found"
    assert diagnosed.findings[0].parameters[0].estimate == plain["findings"][0]["parameters"][0]["estimate"]
    assert diagnosed.findings[0].to_dict() == plain["findings"][0]
    assert "findings" in dir(diagnosed) and "findings" in diagnosed
    with pytest.raises(AttributeError, match="there is no `finding`; there are"):
        diagnosed.finding
    with pytest.raises(AttributeError, match="does not change"):
        diagnosed.verdict = "clean"
    plain["verdict"] = "changed"
    assert diagnosed.verdict == "effects-found"
    assert copy.deepcopy(diagnosed) == diagnosed


def test_a_hidden_cause_is_found_with_its_size(simulated, diagnosed):
    size = next(one for one in simulated.hidden[0].parameters if one.name == "size")
    found = diagnosed.findings[0]
    assert found.effect == simulated.hidden[0].effect
    parameter = found.parameters[0]
    # Five standard deviations: by chance once in two million seeds.
    assert abs(parameter.estimate - size.value) < 5 * parameter.sigma


def test_the_manifest_has_the_call(simulated):
    record, bench = simulated.record, simulated.bench
    options = {"average_s": 600.0, "robust_sigmas": 3, "noise": True, "effects": (one for one in ["gyro_y.g_z"])}
    found = gyrocal.calibrate(record, [bench.to_dict()], **options)
    assert found.manifest.command == (
        "gyrocal.calibrate(<simulation>, [<dict>], effects=['gyro_y.g_z'], average_s=600.0, robust_sigmas=3)"
    )
    found = gyrocal.calibrate(simulated.record.to_pandas(), bench, method="paper", factorised=True)
    assert found.manifest.command == (
        "gyrocal.calibrate(<DataFrame>, <simulation>.bench, method='paper', factorised=True)"
    )
    found = gyrocal.diagnose(record, bench, effects=[], false_alarm=np.float64(0.02), filter="euler")
    assert found.manifest.command == (
        "gyrocal.diagnose(<simulation>, <simulation>.bench, false_alarm=0.02, filter='euler')"
    )


def test_frames(simulated, diagnosed):
    findings = diagnosed.to_pandas()
    assert list(findings.effect) == [one.effect for one in diagnosed.findings]
    assert findings["size"][0] == diagnosed.findings[0].parameters[0].estimate
    calibrated = gyrocal.calibrate(simulated.record, simulated.bench)
    coefficients = calibrated.to_pandas().set_index("name")
    assert coefficients.loc["gyro_x.bias", "estimate"] == calibrated.estimates[0]
    assert list(simulated.record.to_pandas().columns) == list(gyrocal.COLUMNS[:4])
    assert list(simulated.to_pandas().name) == calibrated.names


def test_frames_of_all_kinds_hold_the_same(simulated, diagnosed):
    record = simulated.record
    calibrated = gyrocal.calibrate(record, simulated.bench)
    for one in (record, simulated, diagnosed, calibrated):
        by_pandas, by_polars, by_arrow = one.to_pandas(), one.to_polars(), one.to_arrow()
        assert list(by_pandas.columns) == by_polars.columns == by_arrow.column_names
        assert by_polars.to_dicts() == by_arrow.to_pylist() == pl.DataFrame(one).to_dicts()
    assert calibrated.to_polars()["estimate"].to_list() == calibrated.to_pandas().estimate.tolist()
    assert gyrocal.Record.from_frame(record.to_polars()).sha256 == record.sha256


def test_a_missing_package_is_told(monkeypatch, diagnosed):
    for package, frame in [("pandas", "to_pandas"), ("polars", "to_polars"), ("pyarrow", "to_arrow")]:
        monkeypatch.setitem(sys.modules, package, None)
        with pytest.raises(ImportError, match=f"python -m pip install {package}"):
            getattr(diagnosed, frame)()
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    with pytest.raises(ImportError, match=r"python -m pip install 'gyrocal\[plot\]'") as caught:
        diagnosed.plot()
    assert caught.value.name == "matplotlib"


def test_names_that_other_packages_use(simulated, diagnosed):
    calibrated = gyrocal.calibrate(simulated.record, simulated.bench)
    for one in (calibrated, diagnosed):
        count = len(one.names)
        assert one.params.shape == one.bse.shape == (count,) and one.cov_params().shape == (count, count)
        assert np.allclose(one.bse**2, np.diag(one.cov_params()), rtol=1e-9)
        low, high = one.conf_int().T
        assert np.all((low < one.params) & (one.params < high))
    # Of a normal distribution: 1.959964 and 2.575829 standard deviations.
    for alpha, sigmas in [(0.05, 1.959964), (0.01, 2.575829)]:
        width = np.diff(calibrated.conf_int(alpha))[:, 0]
        assert np.allclose(width, 2 * sigmas * calibrated.bse, rtol=1e-6)
    assert np.array_equal(diagnosed.conf_int(), [one.interval for one in diagnosed.coefficients.over_set])
    assert calibrated.nobs == calibrated.rows == len(simulated.record)
    again = gyrocal.from_json(calibrated.to_json())
    assert copy.copy(calibrated).llf == calibrated.llf and not hasattr(again, "llf")
    with pytest.raises(AttributeError, match="read from JSON"):
        again.llf
    assert diagnosed.pvalues == {one.effect: one.p_value for one in diagnosed.findings}
    for wrong, one in [(2.0, calibrated), ("a", calibrated), (0.1, diagnosed)]:
        with pytest.raises(gyrocal.InputError, match="^alpha: found"):
            one.conf_int(wrong)


def test_the_likelihood_of_a_calibration_is_that_of_its_values():
    bench = gyrocal.Bench.read("examples/data/three_days.bench.toml").to_dict()
    wide = bench | {"noise": {name: 10.0 * value for name, value in bench["noise"].items()}}
    right, wide = (
        gyrocal.calibrate("examples/data/three_days.csv", one, noise=False) for one in (bench, wide)
    )
    # Ten times the noise of all: each value has a tenth of the density, less its square, of which a hundredth is left.
    expected = right.nobs * (3.0 * np.log(10.0) - 0.5 * right.nis_mean * (1.0 - 1.0 / 100.0))
    # Priors of the attitude stay as they are.
    assert right.llf - wide.llf == pytest.approx(expected, rel=0.02)


def test_plots_show_the_coefficients_with_their_intervals(simulated, diagnosed):
    calibrated = gyrocal.calibrate(simulated.record, simulated.bench)
    for one, alpha in [(calibrated, 0.1), (diagnosed, 0.05)]:
        figure = one.plot(alpha)
        assert [axes.get_xlabel() for axes in figure.axes] == ["deg/h", "deg/h/g", "deg/h/g^2"]
        shown = {}
        for axes in figure.axes:
            names = [label.get_text() for label in axes.get_yticklabels()]
            (bars,) = axes.containers
            points, _, (ends,) = bars.lines
            for name, value, end in zip(names, points.get_xdata(), ends.get_segments()):
                shown[name] = (value, *end[:, 0])
        assert list(shown) != one.names and set(shown) == set(one.names)
        expected = np.column_stack([one.params, one.conf_int(alpha)])
        assert np.allclose([shown[name] for name in one.names], expected, rtol=1e-12, atol=0.0)
    other = one.plot(fig=figure)
    assert other is figure
    with pytest.raises(gyrocal.InputError, match="^alpha: found"):
        calibrated.plot(2.0)


def test_a_wrong_set_up_leaves_no_coefficients(simulated):
    record = gyrocal.Record(simulated.record.time_s, 9.80665 * simulated.record.accel_g)
    found = gyrocal.diagnose(record, simulated.bench)
    with pytest.raises(gyrocal.SetupError) as caught:
        gyrocal.calibrate(record, simulated.bench)
    for one in (found, caught.value.result):
        assert one.verdict == "setup" and one.names == [] and one.params.shape == one.bse.shape == (0,)
        assert one.conf_int().shape == (0, 2) and one.cov_params().size == 0 and not hasattr(one, "llf")
        with pytest.raises(gyrocal.InputError, match="plot: found a result without coefficients"):
            one.plot()


def test_a_summary_is_the_first_screen_of_the_command(tmp_path):
    files = ["examples/data/hidden_fault.csv", "examples/data/hidden_fault.bench.toml"]
    # Lines of a pipe are as long as they need.
    unbroken = {name: value for name, value in os.environ.items() if name != "COLUMNS"}
    for name in ("diagnose", "calibrate", "plan"):
        found = getattr(gyrocal, name)(*files)
        shown = subprocess.run(
            [command(), name, files[0], "--bench", files[1]],
            capture_output=True, text=True, check=True, env=unbroken,
        ).stdout
        # The command sets the same words in columns, and its next steps otherwise.
        facts = found.summary().split("\n\nNext")[0]
        screen = re.split(r"^(?:next|all tables) ", shown, flags=re.MULTILINE)[0]
        facts, screen = (re.sub(r"[-:\s]+", " ", text).strip() for text in (facts, screen))
        assert facts == screen
        commands = re.findall(r"^next +(.*?)   # ", shown, flags=re.MULTILINE)
        assert found.summary().count("Next, ") == len(commands) > 0
        assert all(" ".join(one.split()) in " ".join(found.summary().split()) for one in commands)
        assert str(found).startswith(found.summary() + "\n") and len(found.summary()) < len(str(found)) / 2


def test_results_are_read_from_json(tmp_path, simulated, diagnosed):
    calibrated = gyrocal.calibrate(simulated.record, simulated.bench)
    planned = gyrocal.plan(simulated.record, simulated.bench, diagnosis=diagnosed, hours=24)
    measured = gyrocal.characterise("clean", runs=1, methods=[])
    file = tmp_path / "result.json"
    assert "figures hold" in measured.summary() and len(measured.summary()) < len(str(measured)) / 2
    for one in (calibrated, diagnosed, planned, measured):
        file.write_text(one.to_json(), encoding="utf-8")
        for again in (gyrocal.from_json(one.to_json()), gyrocal.from_json(file), gyrocal.from_json(str(file))):
            assert type(again) is type(one) and again == one and again.summary() == one.summary()
    for wrong, words in [
        (simulated.to_json(), "another kind"),
        ("{", "found no JSON"),
        ('{"findings": [], "subject": "platform"}', "no whole Diagnosis"),
        ('{"cells": 1}', "no whole Characteristics"),
        ("none.json", "cannot be read"),
    ]:
        with pytest.raises(gyrocal.InputError, match=words):
            gyrocal.from_json(wrong)


def test_words_and_html_are_those_of_the_command(simulated, diagnosed):
    words = " ".join(str(diagnosed).split())
    assert diagnosed.findings[0].name in words
    shown = diagnosed._repr_html_()
    assert "<table" in shown and "gyro_y.g_z" in shown and "<script" not in shown
    assert shown.count("<table") == shown.count("</table>")
    record = gyrocal.Record(simulated.record.time_s, simulated.record.accel_g, name="<b>&")
    shown = gyrocal.diagnose(record, simulated.bench)._repr_html_()
    assert "<b>&" not in shown and "&lt;b&gt;&amp;" in shown
    assert "gyro_y.g_z" in simulated._repr_html_()


def test_the_command_of_the_package(tmp_path):
    command = Path(sys.executable).parent / "gyrocal"
    version = subprocess.run([command, "--version"], capture_output=True, text=True, check=True)
    assert version.stdout == f"gyrocal {gyrocal.__version__}\n"
    module = [sys.executable, "-m", "gyrocal"]
    wrong = subprocess.run([*module, "diagnose"], capture_output=True, text=True)
    assert wrong.returncode == 2 and "--bench" in wrong.stderr
    missing = [*module, "diagnose", "none.csv", "--bench", "none.toml"]
    failed = subprocess.run(missing, capture_output=True, text=True)
    assert failed.returncode == 1 and "cannot be read" in failed.stderr
    out = tmp_path / "truth.json"
    scenario = ROOT / "examples" / "data" / "three_days.scenario.toml"
    call = ["simulate", str(scenario), "--out", str(tmp_path / "r.csv"), "--json", str(out)]
    subprocess.run([command, *call], check=True, capture_output=True)
    # The manifest has the command line as it was typed, not that of the interpreter.
    assert f'"gyrocal simulate {scenario}' in out.read_text()


def test_the_package_is_typed_and_stubs_name_what_there_is():
    files = importlib.metadata.files("gyrocal")
    names = {file.name for file in files}
    assert {"py.typed", "_gyrocal.pyi"} <= names
    stub = (Path(gyrocal.__file__).parent / "_gyrocal.pyi").read_text()
    from gyrocal import _gyrocal

    for name in dir(_gyrocal):
        if not name.startswith("__"):
            assert f"def {name}(" in stub or f"class {name}:" in stub or f"{name}:" in stub, name
    for name in gyrocal.__all__:
        assert getattr(gyrocal, name).__doc__
