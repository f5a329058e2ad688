#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tests/tool/full_disk_test.py TOOL [--quick]: on a disk that gets full at several places of what every command writes,
each fails with exit code 1 and one clear line, leaves no half file, and older results as they were. As root the disk is a
small one in memory, otherwise a limit of the size of files."""

import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile

import tool_runs

PAGE = 4096
SHARES = (0.02, 0.3, 0.6, 0.97)  # of what the command writes


class Disk:
    """A folder that takes a number of bytes and no more."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.folder.mkdir()
        self.is_mounted = os.geteuid() == 0 and subprocess.run(
            ["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", str(self.folder)], stderr=subprocess.DEVNULL).returncode == 0
        self.limit = None

    def empty(self):
        for path in sorted(self.folder.rglob("*"), reverse=True):
            path.rmdir() if path.is_dir() else path.unlink()

    def take(self, size):
        """Makes room for `size` bytes beside what is there."""
        if not self.is_mounted:
            self.limit = size
            return
        used = sum((p.stat().st_size + PAGE - 1) // PAGE * PAGE for p in self.folder.rglob("*") if p.is_file())
        subprocess.run(["mount", "-o", f"remount,size={used + size}", str(self.folder)], check=True)

    def prepare(self):
        """In the new process."""
        if self.limit is not None:
            signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
            resource.setrlimit(resource.RLIMIT_FSIZE, (self.limit, self.limit))

    def close(self):
        if self.is_mounted:
            subprocess.run(["umount", str(self.folder)], check=True)


def written_by(tool, run, folder):
    """Bytes of all that the command writes, and of its largest file."""
    work = pathlib.Path(tempfile.mkdtemp(dir=folder))
    subprocess.run([tool, *run.arguments], cwd=work, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    sizes = [p.stat().st_size for p in work.rglob("*") if p.is_file()]
    return sum(sizes), max(sizes)


def check(tool, run, disk, size, scratch):
    """What is wrong when `size` bytes fit."""
    disk.empty()
    if disk.is_mounted:
        subprocess.run(["mount", "-o", "remount,size=16m", str(disk.folder)], check=True)
    tool_runs.put_older_results(run, disk.folder)
    before = tool_runs.contents(disk.folder)
    disk.take(size)
    done = subprocess.run(tool_runs.command(tool, run), cwd=disk.folder, capture_output=True, text=True,
                          env=tool_runs.environment(scratch), preexec_fn=disk.prepare)
    words = [line for line in done.stderr.splitlines() if line.startswith("vdbfuse: ")]
    if done.returncode != 1:
        return f"exit code {done.returncode}: {done.stderr[-300:]}"
    if len(words) != 1 or not any(w in words[0] for w in ("No space left on device", "File too large")):
        return f"says {words}"
    after = tool_runs.contents(disk.folder)
    if after != before:
        return f"left or changed {[n for n in set(after) | set(before) if after.get(n, 0) != before.get(n, 0)][:5]}"
    return None


def main():
    tool, quick = str(pathlib.Path(sys.argv[1]).resolve()), "--quick" in sys.argv
    tried, failed = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        inputs = pathlib.Path(folder) / "inputs"
        inputs.mkdir()
        tool_runs.make_inputs(tool, inputs)
        disk = Disk(pathlib.Path(folder) / "disk")
        try:
            for run in tool_runs.runs(inputs):
                all_bytes, largest = written_by(tool, run, folder)
                for share in SHARES[1:2] if quick else SHARES:
                    size = int(share * (all_bytes if disk.is_mounted else largest))
                    if size + 2 * PAGE > all_bytes and disk.is_mounted:
                        size = 0  # whole pages are given out: nothing fits
                    problem = check(tool, run, disk, size, folder)
                    tried += 1
                    if problem:
                        failed += 1
                        print(f"FAILED: {run.name}, {size} of {all_bytes} bytes fit: {problem}", flush=True)
        finally:
            disk.close()
    print(f"{tried} full disks ({'a small disk' if disk.is_mounted else 'a limit of files'}), {failed} failures")
    sys.exit(1 if failed or tried == 0 else 0)


main()
