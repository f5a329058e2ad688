#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/tool/manual_test.sh TOOL: every manual page renders by man and groff without a warning, mandoc's lint finds nothing,
# and each names its options.
set -euo pipefail
tool=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$tool" manual --folder "$work"
failed=0 pages=0
complain() { echo "FAILED: $1"; failed=$((failed + 1)); }
for page in "$work"/*.1; do
  name=$(basename "$page" .1)
  pages=$((pages + 1))
  warnings=$(groff -man -Tutf8 -ww "$page" 2>&1 >"$work/$name.txt")
  [ -z "$warnings" ] || complain "$name, groff: $warnings"
  warnings=$(mandoc -T lint -W warning "$page" 2>&1) || true
  [ -z "$warnings" ] || complain "$name, mandoc: $warnings"
  shown=$(MANWIDTH=100 man --warnings=all -P cat -l "$page" 2>"$work/errors")
  [ ! -s "$work/errors" ] || complain "$name, man: $(cat "$work/errors")"
  for section in NAME SYNOPSIS DESCRIPTION EXAMPLES OPTIONS 'EXIT STATUS' ENVIRONMENT 'SEE ALSO'; do
    grep -q "^$section" <<<"$shown" || complain "$name has no section $section"
  done
  command=${name#vdbfuse}
  # A man page shows every option that the help does.
  for option in $("$tool" ${command#-} --help | grep -oE '^  --[a-z-]+'); do
    grep -q -- "$option" <<<"$shown" || complain "$name does not name $option"
  done
done
echo "manual: $pages pages, $failed complaints"
[ "$failed" -eq 0 ] && [ "$pages" -gt 5 ]
