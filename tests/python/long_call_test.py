# SPDX-License-Identifier: Apache-2.0
"""Long calls: other threads run, Ctrl-C stops, progress is told, exceptions come through."""
import os
import signal
import subprocess
import sys
import threading
import time

import pytest
import vdbfuse
from scenes import INTRINSICS, sphere


@pytest.fixture(scope="module")
def data():
    depths, poses = sphere()
    return vdbfuse.data_set(depths, INTRINSICS, poses)


def test_progress_tells_every_step_on_the_calling_thread(data):
    told = []
    vdbfuse.fuse(data, voxel=0.04, check=False, progress=lambda step, share: told.append((step, share, threading.get_ident())))
    steps = list(dict.fromkeys(step for step, _, _ in told))
    assert "load views" in steps and len(steps) >= 5
    assert {thread for _, _, thread in told} == {threading.get_ident()}
    assert all(0 <= share <= 1 for _, share, _ in told)
    for step in steps:
        shares = [share for other, share, _ in told if other == step]
        assert shares[-1] == max(shares)


def test_what_progress_raises_stops_the_call(data):
    class Enough(Exception):
        pass

    def stop(step, share):
        raise Enough(step)
    with pytest.raises(Enough):
        vdbfuse.fuse(data, voxel=0.04, progress=stop)
    assert len(vdbfuse.fuse(data, voxel=0.1).triangles) > 0  # and nothing stays behind


def test_bars_of_tqdm_fit(data):
    class Bar:
        """What is used of tqdm, and its names."""

        made = []

        def __init__(self, total=None, desc=None, bar_format=None):
            self.total, self.desc, self.n, self.closed = total, desc, 0, False
            Bar.made.append(self)

        def reset(self, total):
            self.total = total

        def set_description(self, text):
            self.desc = text

        def refresh(self):
            assert not self.closed

        def close(self):
            self.closed = True
    vdbfuse.fuse(data, voxel=0.1, check=False, progress=Bar)
    assert len(Bar.made) >= 5 and all(bar.total == 1 for bar in Bar.made) and "load views" in [bar.desc for bar in Bar.made]
    bar = Bar()
    vdbfuse.fuse(data, voxel=0.1, check=False, progress=bar)
    assert bar.total == 1 and 0 < bar.n <= 1


def test_other_threads_run_meanwhile(data):
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.002)
    clock = threading.Thread(target=tick)
    clock.start()
    begin = time.monotonic()
    vdbfuse.fuse(data, voxel=0.012, check=False)
    end = time.monotonic()
    done.set()
    clock.join()
    during = [begin, *(t for t in ticks if begin < t < end), end]
    assert len(during) > 10
    assert max(b - a for a, b in zip(during, during[1:])) < 0.5 * (end - begin)


def test_several_calls_at_once_give_the_same_as_one_after_the_other(data):
    expected = vdbfuse.fuse(data, voxel=0.05)
    meshes = []
    threads = [threading.Thread(target=lambda: meshes.append(vdbfuse.fuse(data, voxel=0.05, check=False))) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(meshes) == 3 and all((mesh.vertices == expected.vertices).all() for mesh in meshes)


def interrupted(program):
    """Seconds from Ctrl-C to the end of a program that prints when it is under way."""
    child = subprocess.Popen([sys.executable, "-B", "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert child.stdout.readline().strip() == "under way"
    time.sleep(0.3)
    begin = time.monotonic()
    child.send_signal(signal.SIGINT)
    _, errors = child.communicate(timeout=120)
    assert errors.strip().splitlines()[-1].startswith("KeyboardInterrupt"), errors
    assert child.returncode == -signal.SIGINT
    return time.monotonic() - begin


FUSE = """
import sys
sys.path.insert(0, {here!r})
import vdbfuse, scenes
depths, poses = scenes.sphere(24)
def tell(step, share):
    if step == {step!r}:
        print("under way", flush=True)
vdbfuse.fuse(depths, scenes.INTRINSICS, poses, voxel=0.003, check=False, bbox=(-1, -1, -1, 1, 1, 1), progress=tell)
"""


def test_ctrl_c_interrupts_a_fusion():
    here = os.path.dirname(os.path.abspath(__file__))
    assert interrupted(FUSE.format(here=here, step="count agreement")) < 20


def test_ctrl_c_interrupts_a_generator():
    here = os.path.dirname(os.path.abspath(__file__))
    assert interrupted(f"""
import itertools, sys
sys.path.insert(0, {here!r})
import numpy as np
import vdbfuse, scenes
print("under way", flush=True)
vdbfuse.data_set((np.ones((480, 640), np.float32) for _ in itertools.count()), scenes.INTRINSICS,
                 np.stack([np.eye(4)] * 10**5))
""") < 10
