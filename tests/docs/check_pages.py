#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_pages.py ROOT: what a compiler cannot check about the pages of the documentation.

- Every relative link leads to a file, and its #anchor to a heading.
- A page that says <!-- options: A B --> names, in backquotes, every field of the structs A and B of the public headers.
Prints what is wrong, a line each; exit code 1 when there is anything.
"""
import pathlib
import re
import sys

SKIPPED = {"build", "node_modules", "_deps"}


def pages(root):
    for page in sorted(root.rglob("*.md")):
        parts = page.relative_to(root).parts
        if not any(part.startswith((".", "build")) or part in SKIPPED for part in parts):
            yield page


def without_code(text):
    return re.sub(r"```.*?```", "", text, flags=re.S)


def anchors(text):
    """Names of the headings, as the hosts of such pages make them."""
    names = set()
    for heading in re.findall(r"^#+ +(.+)$", without_code(text), flags=re.M):
        name = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        names.add(name)
    return names


def broken_links(page):
    text = re.sub(r"`[^`\n]*`", "", without_code(page.read_text(encoding="utf-8")))
    for link in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = (page.parent / path) if path else page
        if not target.exists():
            yield f"link to {link}: there is no such file"
        elif anchor and target.suffix == ".md" and anchor not in anchors(target.read_text(encoding="utf-8")):
            yield f"link to {link}: there is no such heading"


def without_comments(text):
    return re.sub(r"//[^\n]*", "", text)


def body_of(struct, header):
    """The text between the braces of a struct, or None."""
    start = re.search(rf"\bstruct {struct} {{", header)
    if not start:
        return None
    depth, at = 1, start.end()
    while depth:
        depth += {"{": 1, "}": -1}.get(header[at], 0)
        at += 1
    return header[start.end() : at - 1]


def without_functions(body):
    """Leaves out the bodies of functions and nested types, but keeps `enum class X {...} member`."""
    body = re.sub(r"\benum class \w+ (?:: [\w:]+ )?{[^}]*}", "enum", body)
    body = re.sub(r"\bstruct \w+ {[^{}]*};", "", body)
    body = re.sub(r"\)\s*(const)?\s*(noexcept)?\s*{[^{}]*}", ");", body)
    return re.sub(r"{[^{}]*}", "", body)


def fields(body):
    names = []
    for statement in without_functions(body).split(";"):
        statement = statement.split("=")[0].strip()
        if not statement or statement.startswith(("using ", "static ", "enum class")) or "(" in statement:
            continue
        words = re.findall(r"[A-Za-z_]\w*", re.sub(r"<[^;]*>", "", statement))
        commas = re.sub(r"<[^;]*>", "", statement).split(",")
        if statement == "enum" or "operator" in words or len(words) < 2:
            continue  # an enum without a member, or = default
        names.append(re.findall(r"[A-Za-z_]\w*", commas[0])[-1])
        names.extend(re.findall(r"[A-Za-z_]\w*", part)[0] for part in commas[1:])
    return names


def with_second_members(body):
    """`int width = 640, height = 480;` has two fields, which a split at the first `=` would lose."""
    return re.sub(r"=\s*[^,;{}()]+(?=[,;])", "", body)


def fields_of(struct, headers):
    for header in headers:
        body = body_of(struct, header)
        if body is not None:
            return fields(with_second_members(body))
    return None


def missing_options(page, headers):
    text = page.read_text(encoding="utf-8")
    for marker in re.findall(r"^<!-- options: ([\w ]+) -->", text, flags=re.M):
        for struct in marker.split():
            names = fields_of(struct, headers)
            if names is None:
                yield f"options of {struct}: no public header has such a struct"
            for name in names or []:
                if not re.search(rf"`[^`\n]*\b{name}\b[^`\n]*`", text):
                    yield f"{struct}::{name} is not on the page"


def problems(root):
    headers = [without_comments(h.read_text(encoding="utf-8")) for h in sorted((root / "include").rglob("*.h"))]
    for page in pages(root):
        for problem in [*broken_links(page), *missing_options(page, headers)]:
            yield f"{page.relative_to(root)}: {problem}"


def main():
    found = list(problems(pathlib.Path(sys.argv[1])))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
