"""The examples of the docstrings run, and everything public has one."""

import doctest
import inspect
import sys

import pytest

import gyrocal
from gyrocal import fleet

PUBLIC = {f"gyrocal.{name}": getattr(gyrocal, name) for name in gyrocal.__all__}
PUBLIC |= {f"gyrocal.fleet.{name}": getattr(fleet, name) for name in fleet.__all__}
PUBLIC = {name: one for name, one in PUBLIC.items() if inspect.isclass(one) or inspect.isfunction(one)}


@pytest.mark.parametrize("name", PUBLIC)
def test_examples_of_docstrings_run(name):
    one = PUBLIC[name]
    found = doctest.DocTestFinder().find(one, name, module=sys.modules[one.__module__], globs={})
    examples = [test for test in found if test.examples]
    assert name in [test.name for test in examples], "it has no example"
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE)
    for test in examples:
        shown = []
        runner.run(test, out=shown.append)
        assert runner.summarize(verbose=False).failed == 0, "".join(shown)


@pytest.mark.parametrize("name", [name for name in PUBLIC if inspect.isfunction(PUBLIC[name])])
def test_docstrings_of_functions_name_all_arguments(name):
    one = PUBLIC[name]
    for argument in inspect.signature(one).parameters:
        assert f"        {argument}: " in inspect.getdoc(one).replace("\n", "\n    "), argument
