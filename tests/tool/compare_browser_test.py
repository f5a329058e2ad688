#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""compare_browser_test.py VDBFUSE FOLDER: the report of vdbfuse compare, opened in headless Chromium without a network.

The page must open without errors, say so by its attributes once the viewer has drawn every mesh, ask for no other file,
and make a screenshot in which the place of the viewer is not blank. Without WebGL it must say so and go on. Exit code 77:
there is no Chromium. The standard library only.
"""

import functools
import http.server
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import threading
import zlib

SKIPPED = 77
WIDTH, HEIGHT = 1280, 3000
SOFTWARE_WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")


def run(*command, **options):
    return subprocess.run(command, check=True, capture_output=True, timeout=600, **options)


def browse(browser, page, *options):
    """Output of one run of the browser, and the lines that pages wrote to its console."""
    with tempfile.TemporaryDirectory() as profile:
        done = run(browser, "--headless", "--no-sandbox", "--user-data-dir=" + profile, "--hide-scrollbars",
                   "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1", "--virtual-time-budget=30000",
                   f"--window-size={WIDTH},{HEIGHT}", "--enable-logging=stderr", "--v=0", *options, page)
    words = done.stderr.decode(errors="replace")
    # Chromium's own words about drawing without a graphics card are none of the page's.
    console = [line for line in words.splitlines() if "CONSOLE" in line and "GL Driver Message" not in line]
    return done.stdout.decode(errors="replace"), console


def png_rows(path):
    """Rows of an 8-bit RGB or RGBA picture as bytes, and bytes a pixel."""
    with open(path, "rb") as file:
        data = file.read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "not a PNG file"
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, _, bits, color, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            assert bits == 8 and color in (2, 6) and not interlaced, "unexpected kind of PNG"
            step = 3 if color == 2 else 4
        elif kind == b"IDAT":
            packed += body
        at += 12 + size
    raw, stride = zlib.decompress(packed), width * step
    rows, before = [], bytes(stride)
    for start in range(0, len(raw), stride + 1):
        before = unfiltered(raw[start], bytearray(raw[start + 1:start + 1 + stride]), before, step)
        rows.append(before)
    return rows, step


def unfiltered(kind, row, above, step):
    for i in range(len(row)):
        left = row[i - step] if i >= step else 0
        if kind == 1:
            row[i] = (row[i] + left) & 255
        elif kind == 2:
            row[i] = (row[i] + above[i]) & 255
        elif kind == 3:
            row[i] = (row[i] + (left + above[i]) // 2) & 255
        elif kind == 4:
            corner = above[i - step] if i >= step else 0
            guess = left + above[i] - corner
            row[i] = (row[i] + min((left, above[i], corner), key=lambda value: abs(guess - value))) & 255
    return bytes(row)


def variance(rows, step, top, bottom, left, right):
    values = [rows[y][x * step] for y in range(top, bottom, 4) for x in range(left, right, 4)]
    mean = sum(values) / len(values)
    return sum((value - mean) ** 2 for value in values) / len(values)


class Requests(http.server.SimpleHTTPRequestHandler):
    """Serves a folder and remembers what was asked for."""
    seen = []

    def log_message(self, *_):
        Requests.seen.append(self.path)


def requests_of(browser, folder):
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Requests, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    browse(browser, f"http://127.0.0.1:{server.server_port}/report.html", "--dump-dom", *SOFTWARE_WEBGL)
    server.shutdown()
    return sorted(set(Requests.seen))


def attribute(dom, name):
    found = re.search(rf'<html[^>]* data-{name}="([^"]*)"', dom)
    return found.group(1) if found else None


def check(good, words):
    print(("ok    " if good else "WRONG ") + words)
    return good


def check_page(browser, folder):
    page = "file://" + os.path.join(folder, "report.html")
    dom, console = browse(browser, page, "--dump-dom", *SOFTWARE_WEBGL)
    variances = [float(each) for each in (attribute(dom, "variance") or "").split(",") if each]
    good = [
        check(not console, f"no words on the console {console}"),
        check(attribute(dom, "errors") is None, f"no errors in scripts {attribute(dom, 'errors')}"),
        check(attribute(dom, "viewer") == "drawn", f"the viewer has drawn ({attribute(dom, 'viewer')})"),
        check(len(variances) == 2 and min(variances) > 20, f"every mesh is to be seen (variances {variances})"),
        check("Support</button>" in dom, "the viewer has its buttons"),
    ]
    picture = os.path.join(folder, "screenshot.png")
    browse(browser, page, "--screenshot=" + picture, *SOFTWARE_WEBGL)
    rows, step = png_rows(picture)
    whole = variance(rows, step, 0, len(rows), 0, WIDTH)
    good.append(check(len(rows) == HEIGHT and whole > 100, f"the screenshot is not blank (variance {whole:.0f})"))
    asked = requests_of(browser, folder)
    good.append(check(len(asked) == 1 and "report.html" in asked[0], f"the page asks for nothing else {asked}"))
    return all(good)


def check_without_webgl(browser, folder):
    page = "file://" + os.path.join(folder, "report.html")
    dom, console = browse(browser, page, "--dump-dom", "--disable-3d-apis")
    return all([
        check(attribute(dom, "viewer") == "failed", "without WebGL the viewer gives up"),
        check("This browser has no WebGL" in dom, "and says why"),
        check(attribute(dom, "errors") is None and not console, f"without errors {console}"),
    ])


def main():
    tool, folder = sys.argv[1], os.path.abspath(sys.argv[2])
    browser = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if not browser:
        print("skipped: no chromium")
        return SKIPPED
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    scan, out = os.path.join(folder, "scan"), os.path.join(folder, "out")
    run(tool, "synth", "figure", scan, "--arc", "ring", "--views", "12", "--size", "96x72", "--quiet")
    run(tool, "compare", scan, out, "--resolution", "40", "--triangles", "2000", "--quiet", "--reference",
        os.path.join(scan, "truth.ply"))
    with open(os.path.join(out, "report.html"), encoding="utf-8") as file:
        if "built without three.js" in file.read():
            print("skipped: vdbfuse was built without three.js")
            return SKIPPED
    results = [check_page(browser, out), check_without_webgl(browser, out)]
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main())
