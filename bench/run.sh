#!/bin/bash
# Everything that is measured, with its limits: builds the programs of target `bench`, runs them, marks each figure PASS or MISS.
#   bench/run.sh [BUILD_DIRECTORY]      default: build/release
# CPU time unless it says wall. Exit 1 when a limit was missed.
cd "$(dirname "$0")/.." || exit 1
build=${1:-build/release}
(source scripts/common.sh && install_packages libembree-dev) || exit 1 # of box_bench
[ -f "$build/build.ninja" ] || { echo "bench/run.sh: $build has not been configured; ./check or ./render do that" >&2; exit 1; }
ninja -C "$build" alpenglow bench >/dev/null || { echo "bench/run.sh: the build failed" >&2; exit 1; }
program=$build/bin/alpenglow
export ALPENGLOW_SHADERS=$PWD/shaders
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
misses=0

# under LIMIT VALUE NAME: a figure that must stay below a limit.
under() {
    if awk -v v="$2" -v l="$1" 'BEGIN { exit !(v < l) }'; then mark=PASS; else mark=MISS; misses=$((misses + 1)); fi
    printf '%-64s %7.3f s < %-5s %s\n' "$3" "$2" "$1" "$mark"
}
# Seconds of CPU time (user and system) of a command, and its wall time, in $cpu and $wall; the best of five.
clock() {
    local before=$1 i line
    shift
    cpu=1000000 wall=1000000
    for i in 1 2 3 4 5; do
        eval "$before"
        line=$( { TIMEFORMAT='%U %S %R'; time "$@" >"$work/out" 2>&1 || echo failed >&2; } 2>&1 )
        case $line in *failed*) cat "$work/out"; echo "bench/run.sh: '$*' failed"; misses=$((misses + 1)); return ;; esac
        cpu=$(awk -v c="$cpu" '{ t = $1 + $2; print t < c ? t : c }' <<<"$line")
        wall=$(awk -v c="$wall" '{ print $3 < c ? $3 : c }' <<<"$line")
    done
}

echo "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1), $(nproc) processors, $(date -u +%F), load $(cut -d' ' -f1 /proc/loadavg)"
echo
echo "== Lookups in maps beside OpenImageIO's"
"$build/bin/texture_bench" || misses=$((misses + 1))
echo
echo "== Patterns: shade against hand-written code"
export ALPENGLOW_CACHE=$work/cache
patterns=(bench/shaders/*.sl)
[ -d ../shared/bench ] && patterns=(../shared/bench/*.sl "${patterns[@]}")
"$build/bin/pattern_bench" --program "$PWD/$program" "${patterns[@]}" || misses=$((misses + 1))
echo
echo "== Optimised IR of the patterns: no call, alloca, gather, scatter (ninja test_rsl_jit)"
if [ -x "$build/bin/test_rsl_jit" ]; then
    if "$build/bin/test_rsl_jit" --gtest_filter='*PatternsIr*' >"$work/out" 2>&1; then echo "PASS"; else cat "$work/out"; echo "MISS"; misses=$((misses + 1)); fi
else
    echo "not built"
fi
echo
echo "== RIB: ASCII floats, reader against fast_float"
"$build/bin/rib_bench" || misses=$((misses + 1))
echo
if [ -x "$build/bin/box_bench" ]; then
    echo "== The Muttenzer box against the oracle"
    timeout 600 "$build/bin/box_bench" | tee "$work/box" || misses=$((misses + 1))
    ratio=$(sed -n 's/^ *ours . oracle.*: \([0-9.]*\) on the same sequences.*/\1/p' "$work/box")
    if awk -v r="${ratio:-0}" 'BEGIN { exit !(r >= 0.6) }'; then mark=PASS; else mark=MISS; misses=$((misses + 1)); fi
    echo "  samples per second, ours / oracle on the same sequences: ${ratio:-none} >= 0.6 $mark"
    echo
fi
if [ -x "$build/bin/scene_bench" ]; then
    echo "== Scenes that look like production: where the time goes (no limits)"
    timeout 900 "$build/bin/scene_bench" --folder "$build/bench_scenes" || misses=$((misses + 1))
    echo
fi
echo "== Start and compilation (best of five)"
scene=bench/scenes/ten_shaders.rib
"$program" render $scene -q -o "$work/ten.exr" >"$work/out" 2>&1 || { cat "$work/out"; misses=$((misses + 1)); }
clock : "$program" render $scene -q -o "$work/ten.exr"
under 0.15 "$wall" "warm start, ten shaders, to a whole picture of 32 x 24 (wall)"
printf '%-64s %7.3f s\n' "  the same in CPU time" "$cpu"
if LD_DEBUG=files "$program" render $scene -q -o "$work/ten.exr" 2>&1 | grep -q 'libLLVM'; then
    echo "  LLVM was loaded on a warm start                                MISS"; misses=$((misses + 1))
else
    echo "  LLVM is not loaded on a warm start                             PASS"
fi
export ALPENGLOW_CACHE=$work/cold
lines() { cat "$@" | wc -l; }
surface=examples/shaders/ubersurface.sl light=examples/shaders/uberlight.sl
clock 'rm -rf "$work/cold"' "$program" compile $surface
under 1 "$cpu" "cold compile of a shader of $(lines $surface) lines"
clock 'rm -rf "$work/cold"' "$program" compile $light $surface
under 2 "$cpu" "cold compile of an uber-light and an uber-surface, $(lines $light $surface) lines"
clock 'rm -rf "$work/cold"' "$program" render bench/scenes/uber.rib -q -o "$work/uber.exr"
printf '%-64s %7.3f s\n' "  a cold picture with both (every build of both, 64 x 48, path)" "$cpu"
unset ALPENGLOW_CACHE
"$build/bin/compile_speed" || misses=$((misses + 1))
echo
if [ $misses = 0 ]; then echo "all limits met"; else echo "$misses of the parts above missed a limit"; exit 1; fi
