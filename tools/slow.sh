#!/usr/bin/env bash
# What takes too long for every change, or needs what a bare machine lacks: fuzzing, instruction counts, the WebAssembly module, licences by
# cargo-deny, slow checks on the whole test suite. For releases, and where a change may cost time. The tests of the feature `cad` are in .ci/run.
#
#   tools/slow.sh [--only STEP]… [--fuzz-seconds N] [--update-baseline]
#
#   --only STEP         licences, checks, web, instructions or fuzz; may be repeated; default: all
#   --fuzz-seconds N    seconds for each fuzz target, default 60
#   --update-baseline   writes the counts of this run to tools/slow/instructions.txt
#
# What cannot be done here is told as SKIPPED, with the way to get it. Exit 1 where anything failed, with a list at the end.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fuzz_seconds=60
update=no
steps=
usage() {
  sed -n '2,/^set /{/^#/s/^# \{0,1\}//p}' tools/slow.sh
  exit "$1"
}
while [ $# -gt 0 ]; do
  case $1 in
    --only | --fuzz-seconds)
      [ $# -gt 1 ] || { echo "$1 needs a value" >&2; exit 2; }
      if [ "$1" = --only ]; then steps="$steps $2"; else fuzz_seconds=$2; fi
      shift
      ;;
    --update-baseline) update=yes ;;
    -h | --help) usage 0 ;;
    *) echo "unknown option $1" >&2; usage 2 >&2 ;;
  esac
  shift
done
case $fuzz_seconds in '' | *[!0-9]*) echo "--fuzz-seconds takes a whole number, not '$fuzz_seconds'" >&2; exit 2 ;; esac
for step in ${steps:=licences checks web instructions fuzz}; do
  case $step in licences | checks | web | instructions | fuzz) ;; *) echo "--only: there is no step $step" >&2; exit 2 ;; esac
done

failed=()
skipped=()
skip() { # skip WHAT WHY HOW
  echo "SKIPPED: $1: $2. To get it: $3" >&2
  skipped+=("$1")
}
try() { # try WHAT COMMAND…
  local what=$1
  shift
  echo "== $what: $*"
  "$@" || { echo "FAILED: $what" >&2; failed+=("$what"); return 1; }
}
has() { command -v "$1" >/dev/null 2>&1; }

licences() {
  has cargo-deny || { skip licences "there is no cargo-deny" "cargo install --locked cargo-deny --version 0.20.2"; return; }
  try licences cargo deny check licenses
}

checks() {
  try "slow checks" cargo test --features slow-checks
}

web() {
  local wasm=tools/web/target/wasm32-unknown-unknown/release/squinch_web.wasm out=target/slow
  rustup target list --installed 2>/dev/null | grep -q wasm32-unknown-unknown ||
    { skip web "the target is not installed" "rustup target add wasm32-unknown-unknown"; return; }
  mkdir -p "$out"
  try "web: build" cargo build --manifest-path tools/web/Cargo.toml --target-dir tools/web/target --release --lib \
    --target wasm32-unknown-unknown || return
  has node || { skip "web: bytes" "there is no node" "install Node.js 20 or later"; return; }
  try "web: run" sh -c "node tools/web/mesh.mjs $wasm samples/bracket.dxf vtu > $out/wasm.vtu" || return
  try "web: native" sh -c "cargo run --manifest-path tools/web/Cargo.toml --target-dir tools/web/target --release -- \
    samples/bracket.dxf vtu > $out/native.vtu" || return
  try "web: the same bytes" cmp "$out/wasm.vtu" "$out/native.vtu"
}

# Counts depend on the compiler and, a little, on the C library: a baseline says with which it was made.
instructions() {
  local baseline=tools/slow/instructions.txt counts=target/slow/instructions.txt compiler
  has valgrind || { skip instructions "there is no valgrind" "apt-get install valgrind, or the like"; return; }
  compiler=$(rustc --version)
  mkdir -p target/slow
  try "instructions: build" cargo build --locked --profile quick --bin squinch || return
  {
    echo "# Instructions of one thread, profile quick, by tools/slow.sh --update-baseline. $compiler"
    while read -r name arguments; do
      # shellcheck disable=SC2086 # arguments are words
      valgrind --tool=cachegrind --cache-sim=no --cachegrind-out-file=/dev/null target/quick/squinch mesh $arguments \
        --threads 1 --quiet -o target/slow/mesh.vtu </dev/null 2>target/slow/valgrind.txt ||
        { echo "FAILED: $name, see target/slow/valgrind.txt" >&2; echo "$name failed"; continue; }
      sed -n "s/,//g; s/.*I *refs: *\([0-9]*\).*/$name \1/p" target/slow/valgrind.txt
    done <<'SAMPLES'
tangent_lop samples/tangent_curves.json
tangent_gcdr samples/tangent_curves.json --engine gcdr
plate_order_2 samples/plate.json --order 2
airfoil samples/naca4412.dat
logo samples/logo.svg
bracket samples/bracket.dxf
fine_gear samples/gear.json --max-turning 0.1
SAMPLES
  } >"$counts"
  if grep -q ' failed$' "$counts"; then
    failed+=("instructions")
    return
  fi
  if [ "$update" = yes ]; then
    cp "$counts" "$baseline"
    echo "wrote $baseline"
    return
  fi
  try instructions awk '
    FNR == 1 { if (NR == 1) was = $0; else if ($0 != was) print "the baseline is of another compiler: " was }
    /^#/ { next }
    NR == FNR { base[$1] = $2; next }
    !($1 in base) { printf "%-16s %14d  not in the baseline\n", $1, $2; bad = 1; next }
    {
      change = 100 * ($2 / base[$1] - 1)
      far = change > 10 || change < -10
      printf "%-16s %14d %+7.1f %%%s\n", $1, $2, change, far ? "  more than 10 %: find out why, or --update-baseline" : ""
      if (far) bad = 1
      delete base[$1]
    }
    END { for (name in base) { print name " is in the baseline and was not counted"; bad = 1 } exit bad }
  ' "$baseline" "$counts"
}

fuzz() {
  local target folder
  has cargo-fuzz || { skip fuzz "there is no cargo-fuzz" "cargo install --locked cargo-fuzz --version 0.13.2"; return; }
  for target in $(sed -n 's/^name = "\(.*\)"/\1/p' tools/fuzz/Cargo.toml | grep -v '^squinch'); do
    # `step` needs the crates of the feature cad, which take minutes to build.
    local features=() seeds=(../../samples) options=(-max_len=4096 -timeout=10 -rss_limit_mb=2048 "-max_total_time=$fuzz_seconds")
    [ "$target" = step ] && features=(--features cad)
    # What a target is given is in the folder of its name; `file` takes all.
    for folder in tools/fuzz/seeds/*; do
      folder=${folder#tools/fuzz/}
      if [ "$target" = file ] || [ "$target" = "${folder#seeds/}" ]; then seeds+=("$folder"); fi
    done
    [ -f "tools/fuzz/dictionaries/$target.dict" ] && options+=("-dict=dictionaries/$target.dict")
    mkdir -p "tools/fuzz/corpus/$target" "tools/fuzz/artifacts/$target"
    (
      cd tools/fuzz &&
        RUSTC_BOOTSTRAP=1 cargo fuzz run --fuzz-dir . -s none "${features[@]}" "$target" "corpus/$target" "${seeds[@]}" -- "${options[@]}"
    ) >"target/slow/fuzz-$target.txt" 2>&1
    # shellcheck disable=SC2181 # the output went to a file
    if [ $? = 0 ]; then
      echo "fuzz $target: $(grep -a '^Done' "target/slow/fuzz-$target.txt" || echo done)"
    else
      tail -n 5 "target/slow/fuzz-$target.txt"
      echo "FAILED: fuzz $target: see target/slow/fuzz-$target.txt and tools/fuzz/artifacts/$target" >&2
      failed+=("fuzz $target")
    fi
  done
}

mkdir -p target/slow
for step in $steps; do "$step"; done

[ ${#skipped[@]} = 0 ] || printf 'SKIPPED: %s\n' "${skipped[@]}"
if [ ${#failed[@]} != 0 ]; then
  printf 'FAILED: %s\n' "${failed[@]}"
  exit 1
fi
echo "no step failed"
