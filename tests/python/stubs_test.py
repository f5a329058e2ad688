# SPDX-License-Identifier: Apache-2.0
"""The stubs say what there is, and the types of uses of the package come out right."""
import ast
import importlib.util
import inspect
import os
import subprocess
import sys

import pytest
import vdbfuse
from vdbfuse import _core

STUB = os.path.join(os.path.dirname(vdbfuse.__file__), "__init__.pyi")
needs_mypy = pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="python3-mypy is not installed")
# The stub lists the keywords that these take as **options; the test after the next compares them.
WITH_OPTIONS = ["vdbfuse.fuse", "vdbfuse.judge", "vdbfuse.read", "vdbfuse.stereo", "vdbfuse.view", "vdbfuse.data_set",
                "vdbfuse.TSDF.__init__", "vdbfuse.TSDF.load", "vdbfuse.Scanner.__init__"]
# Classes of pybind11 have a metaclass and a constructor that no stub knows.
MADE_BY_PYBIND = [r"vdbfuse\.(DataSet|JudgedView|Judgement|Mesh|View)(\.__init__)?", "vdbfuse._live.NamedTuple"]


def mypy(module, *arguments):
    return subprocess.run([sys.executable, "-B", "-m", module, *map(str, arguments)], capture_output=True, text=True,
                          env=dict(os.environ, MYPYPATH=os.environ["PYTHONPATH"]))


@needs_mypy
def test_the_stubs_are_those_of_the_package(tmp_path):
    (tmp_path / "allowed").write_text("\n".join(WITH_OPTIONS + MADE_BY_PYBIND) + "\n")
    done = mypy("mypy.stubtest", "vdbfuse", "--ignore-missing-stub", "--ignore-unused-allowlist", "--allowlist",
                tmp_path / "allowed")
    assert done.returncode == 0, done.stdout


@needs_mypy
def test_uses_are_checked(tmp_path):
    (tmp_path / "right.py").write_text("import vdbfuse\nmesh = vdbfuse.fuse('scan', voxel=0.1, method='tsdf')\n"
                                       "print(mesh.vertices.shape, mesh.topology()['closed'])\n")
    (tmp_path / "wrong.py").write_text("import vdbfuse\nvdbfuse.fuse('scan', voxl=0.1)\nvdbfuse.fuse('scan', method='magic')\n")
    assert mypy("mypy", "--cache-dir", tmp_path / "cache", tmp_path / "right.py").returncode == 0
    wrong = mypy("mypy", "--cache-dir", tmp_path / "cache", tmp_path / "wrong.py").stdout
    assert 'wrong.py:2: error: Unexpected keyword argument "voxl"' in wrong and "wrong.py:3: error" in wrong


def keywords_of(name):
    tree = ast.parse(open(STUB, encoding="utf-8").read())
    owner, _, function = name.rpartition(".")
    body = next(node.body for node in tree.body if getattr(node, "name", None) == owner) if owner else tree.body
    return {argument.arg for argument in next(n for n in body if getattr(n, "name", None) == function).args.kwonlyargs}


def own_keywords(function):
    return {name for name, parameter in inspect.signature(function).parameters.items()
            if parameter.kind == parameter.KEYWORD_ONLY}


ARRAYS = own_keywords(vdbfuse.data_set) | set(_core.depth_option_names())
READ = set(_core.read_option_names()) - {"intrinsics"}


@pytest.mark.parametrize("name, options", [
    ("fuse", own_keywords(vdbfuse.fuse) | ARRAYS | READ | set(_core.fuse_option_names()) - {"voxel"}),
    ("judge", own_keywords(vdbfuse.judge) | ARRAYS | READ | set(_core.judge_option_names())),
    ("data_set", ARRAYS),
    ("view", own_keywords(vdbfuse.view) | set(_core.depth_option_names())),
    ("read", {"progress", "intrinsics"} | READ),
    ("stereo", own_keywords(vdbfuse.stereo) | set(_core.stereo_option_names())),
    ("TSDF.__init__", set(_core.tsdf_option_names()) - {"voxel"}),
    ("Scanner.__init__", set(_core.scanner_option_names()) - {"voxel"}),
])
def test_the_stub_lists_every_keyword(name, options):
    assert keywords_of(name) == options


def test_everything_public_is_documented():
    for name in vdbfuse.__all__:
        thing = getattr(vdbfuse, name)
        assert thing.__doc__, name
        if inspect.isclass(thing):
            for member, value in vars(thing).items():
                if not member.startswith("_") and not issubclass(thing, tuple):
                    assert value.__doc__ or member in ("name", "names", "format"), f"{name}.{member}"
