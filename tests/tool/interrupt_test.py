#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tests/tool/interrupt_test.py TOOL [--quick]: Ctrl-C in the middle of every step of every long command, and at times
spread over the whole run, ends it with exit code 130, leaves nothing new, and older results as they were. Says how long
the slowest took to end. --quick: the steps of fuse and stereo only."""

import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time

import tool_runs

LONGEST = 2.0  # seconds from Ctrl-C to the end


class Process:
    """A run that tells its steps; the time of the first line of each is kept."""

    def __init__(self, tool, run, folder, scratch):
        self.began = time.monotonic()
        self.steps = {}
        self.words = []
        self.process = subprocess.Popen(tool_runs.command(tool, run), cwd=folder, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.PIPE, text=True, env=tool_runs.environment(scratch))
        self.reader = threading.Thread(target=self.read)
        self.reader.start()

    def read(self):
        for line in self.process.stderr:
            if line.startswith("{"):
                self.steps.setdefault(json.loads(line)["step"], time.monotonic())
            elif line.strip():
                self.words.append(line.strip())

    def is_up(self):
        """Whether the program has begun: until then a signal ends it as any other, and there is nothing to leave."""
        try:
            status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text(encoding="ascii")
        except OSError:
            return True  # gone already
        handled = [int(line.split()[1], 16) for line in status.splitlines() if line.startswith(("SigBlk", "SigCgt"))]
        return not handled or any(mask >> (signal.SIGINT - 1) & 1 for mask in handled)

    def wait(self):
        code = self.process.wait()
        self.reader.join()
        return code


def wait_for(condition, process):
    while not condition() and process.process.poll() is None:
        time.sleep(0.002)


class Test:
    def __init__(self, tool, quick, folder):
        self.tool, self.quick, self.folder = tool, quick, pathlib.Path(folder)
        self.interrupts, self.slowest, self.slowest_where = 0, 0.0, ""
        self.failures = []

    def fail(self, text):
        print("FAILED:", text, flush=True)
        self.failures.append(text)

    def start(self, run):
        work = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        scratch = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        tool_runs.put_older_results(run, work)
        before = tool_runs.contents(work)
        return Process(self.tool, run, work, scratch), work, scratch, before

    def learn(self, run):
        """How long it takes, and when each step begins: (name, seconds), and the end."""
        process, _, _, _ = self.start(run)
        if process.wait() != 0:
            self.fail(f"{run.name}: does not work at all: {process.words}")
        end = time.monotonic() - process.began
        begins = [(name, at - process.began) for name, at in process.steps.items()]
        return begins, end

    def interrupt(self, run, where, condition, delay, number=signal.SIGINT, code=130):
        process, work, scratch, before = self.start(run)
        wait_for(lambda: condition(process), process)
        time.sleep(delay)
        wait_for(process.is_up, process)
        if process.process.poll() is not None:
            process.wait()
            return  # it was faster this time
        sent = time.monotonic()
        process.process.send_signal(number)
        found = process.wait()
        took = time.monotonic() - sent
        self.interrupts += 1
        after = tool_runs.contents(work)
        if found == 0 and after != before and not any("partial" in name or name.startswith(".") for name in after):
            return  # all was in its place already
        if found != code:
            self.fail(f"{run.name}, {where}: exit code {found}, expected {code}: {process.words}")
        if after != before:
            changed = [n for n in set(after) | set(before) if after.get(n, 0) != before.get(n, 0)]
            self.fail(f"{run.name}, {where}: left or changed {changed[:5]}")
        if list(scratch.iterdir()):
            self.fail(f"{run.name}, {where}: left {list(scratch.iterdir())} in TMPDIR")
        if took > self.slowest:
            self.slowest, self.slowest_where = took, f"{run.name}, {where}"

    def test(self, run):
        begins, end = self.learn(run)
        times = [at for _, at in begins] + [end]
        print(f"{run.name}: {end:.1f} s, steps: {', '.join(name for name, _ in begins) or 'none told'}", flush=True)
        for i, (name, at) in enumerate(begins):
            if self.quick and run.name not in ("fuse", "stereo"):
                break
            half = 0.5 * (times[i + 1] - at)
            self.interrupt(run, f"in '{name}'", lambda p, step=name: step in p.steps, half)
        count = 2 if self.quick else 4
        for i in range(count):
            share = (i + 0.5) / count
            self.interrupt(run, f"after {share:.0%} of the run", lambda p: True, 0.03 + share * (end - 0.03))

    def test_other_signals(self, run):
        _, end = self.learn(run)
        for number, code in ((signal.SIGTERM, 143), (signal.SIGHUP, 129)):
            self.interrupt(run, signal.Signals(number).name, lambda p: True, 0.4 * end, number, code)

    def test_second(self, run):
        """The second Ctrl-C does not wait for anything."""
        process, work, _, before = self.start(run)
        wait_for(lambda: len(process.steps) > 1, process)
        process.process.send_signal(signal.SIGINT)
        process.process.send_signal(signal.SIGINT)
        sent = time.monotonic()
        code = process.wait()
        if code != 130 or tool_runs.contents(work) != before or time.monotonic() - sent > LONGEST:
            self.fail(f"{run.name}: second Ctrl-C: exit code {code}")


def main():
    tool, quick = sys.argv[1], "--quick" in sys.argv
    tool = str(pathlib.Path(tool).resolve())
    with tempfile.TemporaryDirectory() as folder:
        test = Test(tool, quick, folder)
        inputs = pathlib.Path(folder) / "inputs"
        inputs.mkdir()
        tool_runs.make_inputs(tool, inputs)
        runs = tool_runs.runs(inputs)
        for run in runs:
            test.test(run)
        test.test_other_signals(runs[0])
        test.test_second(runs[0])
    if test.slowest > LONGEST:
        test.fail(f"{test.slowest:.2f} s until the end: {test.slowest_where}")
    print(f"{test.interrupts} interrupts, {len(test.failures)} failures; slowest end {test.slowest:.2f} s "
          f"({test.slowest_where})")
    sys.exit(1 if test.failures or test.interrupts == 0 else 0)


main()
