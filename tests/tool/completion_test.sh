#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# tests/tool/completion_test.sh TOOL [bash|zsh]...: what a real bash and a real zsh complete, with the scripts that the tool
# prints.
set -euo pipefail
tool=$(realpath "$1")
shift
shells=("$@")
[ ${#shells[@]} -gt 0 ] || shells=(bash zsh)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/inputs/scan folder"
touch "$work/inputs/mesh.ply"
failed=0 checks=0

# expect SHELL LINE WORD...: the line, completed, offers each of the words; a word with a ! before it is not offered.
expect() {
  local shell=$1 line=$2 offered word
  shift 2
  offered=$("offers_$shell" "$line")
  for word in "$@"; do
    checks=$((checks + 1))
    if [[ $word = !* ]]; then
      ! grep -qxF -- "${word#!}" <<<"$offered" && continue
    else
      grep -qxF -- "$word" <<<"$offered" && continue
    fi
    failed=$((failed + 1))
    printf 'FAILED: %s: "%s" should%s offer %s, it offers: %s\n' "$shell" "$line" "${word:0:1}" "$word" "$(tr '\n' ' ' <<<"$offered")"
  done
}

# As bash calls a completion function: words split at blanks and at =.
offers_bash() {
  (cd "$work/inputs" && bash --norc -c '
    source "$1"
    read -ra COMP_WORDS <<<"${2//=/ = }"
    [[ $2 != *" " ]] || COMP_WORDS+=("")
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
    COMP_LINE=$2 COMP_POINT=${#2}
    _vdbfuse 2>/dev/null
    printf "%s\n" "${COMPREPLY[@]}"' bash "$work/vdbfuse.bash" "$1")
}

# Types the line into an interactive zsh on a terminal of its own, lists what it offers, and ends it.
offers_zsh() {
  (cd "$work/inputs" && zsh -f "$work/ask.zsh" "$1" | tr -d '\r' | sed 's/\x1b\[[0-9;?]*[a-zA-Z]//g')
}
cat >"$work/ask.zsh" <<'ZSH'
zmodload zsh/zpty
zpty asked zsh -f -i
zpty -w asked "PROMPT=; fpath=($ZFUNCTIONS \$fpath); autoload -Uz compinit; compinit -u -D"
# What would be offered goes to a file in place of the screen.
zpty -w asked 'compadd() { local -a found; [[ ${@[(I)-[OAD]]} -gt 0 ]] && { builtin compadd "$@"; return }; builtin compadd -O found "$@"; print -rl -- $found >>'$ZOFFERS'; builtin compadd "$@" }'
zpty -w asked "print -r -- ready"
zpty -r -m asked ready '*ready*ready*'
: >$ZOFFERS
zpty -w -n asked "$1"$'\t'
sleep 0.7
zpty -d asked
cat $ZOFFERS
ZSH
mkdir -p "$work/functions"
export ZFUNCTIONS=$work/functions ZOFFERS=$work/offers

for shell in "${shells[@]}"; do
  if ! command -v "$shell" >/dev/null; then
    echo "FAILED: there is no $shell"
    failed=$((failed + 1))
    continue
  fi
  "$tool" completion bash >"$work/vdbfuse.bash"
  "$tool" completion zsh >"$work/functions/_vdbfuse"
  "$shell" -n "$([ "$shell" = bash ] && echo "$work/vdbfuse.bash" || echo "$work/functions/_vdbfuse")"
  expect "$shell" 'vdbfuse ' fuse stereo evaluate completion
  expect "$shell" 'vdbfuse fu' fuse '!stereo'
  expect "$shell" 'vdbfuse fuse --vox' --voxel '!--trim'
  expect "$shell" 'vdbfuse fuse --m' --method --mu --memory --masks
  expect "$shell" 'vdbfuse fuse --method ' visibility tsdf
  expect "$shell" 'vdbfuse fuse --method vis' visibility '!tsdf'
  expect "$shell" 'vdbfuse fuse --rule ' outside paper constant
  expect "$shell" 'vdbfuse convert scan out --to ' colmap rgbd '!stanford'
  expect "$shell" 'vdbfuse completion ' bash zsh
  expect "$shell" 'vdbfuse fuse --voxel ' '!mesh.ply'
  expect "$shell" 'vdbfuse evaluate me' mesh.ply
done
expect bash 'vdbfuse fuse --weights confidence,no' confidence,noise confidence,none
expect bash 'vdbfuse fuse --method=' visibility tsdf
expect bash 'vdbfuse fuse scan/ mesh.ply --masks ' 'scan folder' '!mesh.ply'
echo "completion: $checks checks in ${shells[*]}, $failed failed"
[ "$failed" -eq 0 ]
