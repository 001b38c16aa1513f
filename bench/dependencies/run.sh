#!/bin/bash
# The trials behind docs/design/dependencies.md: libraries beside our own code. Needs a build, and installs what it compares with.
#   bench/dependencies/run.sh [BUILD_DIRECTORY]      default: build/release
cd "$(dirname "$0")/../.." || exit 1
build=${1:-build/release} here=bench/dependencies
packages="libgtest-dev libre2-dev libmicrohttpd-dev libtinyobjloader-dev libssl-dev nettle-dev"
(source scripts/common.sh && install_packages $packages) || exit 1
ninja -C "$build" ri >/dev/null || { echo "$0: the build failed; run ./check first" >&2; exit 1; }
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
flags=(-std=c++20 -O3 -march=x86-64-v2 -Isrc -Itests/view)
compiler=${CXX:-clang++-19}
link() { "$compiler" "${flags[@]}" "$@"; }

# compiled SOURCE NAME: prints its lines, the seconds to compile it and the size of its code.
compiled() {
    local seconds
    seconds=$( { TIMEFORMAT=%U; time link -c "$1" -o "$work/$2.o" >&2; } 2>&1 | tail -n1)
    echo "$2: $(wc -l <"$1") lines, $seconds s to compile, $(size "$work/$2.o" | awk 'END { print int($1 / 1024) }') KiB of code"
}

# tested SERVER: the tests of the server, one by one, so that one that hangs does not hide the others.
tested() {
    local t passed=0 failed=
    for t in $("$work/test_$1" --gtest_list_tests --gtest_filter='Http.*' | sed -n 's/^  //p'); do
        if timeout 60 "$work/test_$1" --gtest_filter="Http.$t" >/dev/null 2>&1; then passed=$((passed + 1))
        else failed+=" $t"; fi
    done
    echo "$1: $passed tests pass${failed:+, not$failed}"
}

name=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)
echo "$name, $(nproc) processors, $(date -u +%F), load $(cut -d' ' -f1 /proc/loadavg)"
echo "== Starting a program of nothing that links the library"
echo 'int main() {}' >"$work/empty.cpp"
link "$work/empty.cpp" -o "$work/nothing"
for l in re2 microhttpd tinyobjloader crypto nettle; do link -Wl,--no-as-needed "$work/empty.cpp" -l$l -o "$work/$l"; done
link $here/start.cpp -o "$work/start"
(cd "$work" && ./start ./nothing ./re2 ./microhttpd ./tinyobjloader ./crypto ./nettle)

echo "== match(): RE2"
link $here/pattern_re2.cpp src/base/pattern.cpp -lre2 -o "$work/pattern" && "$work/pattern"

echo "== The server of view: ours with the parser of Beast, all of Beast, libmicrohttpd"
compiled src/view/httpserver.cpp ours
compiled $here/http_beast.cpp beast
compiled $here/http_microhttpd.cpp microhttpd
for s in tests/view/http_test.cpp $here/http_crowd.cpp src/view/token.cpp; do link -c $s -o "$work/$(basename $s .cpp).o"; done
for s in ours beast microhttpd; do
    libraries=$([ $s = microhttpd ] && echo -lmicrohttpd)
    link "$work/$s.o" "$work/token.o" "$work/http_test.o" -lgtest -lgtest_main $libraries -o "$work/test_$s"
    link "$work/$s.o" "$work/token.o" "$work/http_crowd.o" $libraries -o "$work/crowd_$s"
    tested $s
    timeout 300 "$work/crowd_$s"
done

echo "== .obj: tinyobjloader"
link $here/obj_tiny.cpp "$build/libri.a" "$build/libscene.a" "$build/libbase.a" -lfmt -ltbb -lz -ldl -o "$work/obj"
"$work/obj"
"$work/obj" damaged 1 12000
awk 'BEGIN { n = 708; srand(1)
    for (j = 0; j < n; j++) for (i = 0; i < n; i++)
        printf "v %.6f %.6f %.6f\nvt %.5f %.5f\n", i / n, j / n, rand(), i / n, j / n
    for (j = 1; j < n; j++) for (i = 1; i < n; i++) { a = (j - 1) * n + i; b = a + 1; c = a + n; d = c + 1
        printf "f %d/%d %d/%d %d/%d\nf %d/%d %d/%d %d/%d\n", a, a, b, b, d, d, a, a, d, d, c, c } }' >"$work/big.obj"
for k in 1 2 3; do "$work/obj" ours "$work/big.obj"; "$work/obj" read "$work/big.obj"; done

echo "== Digests"
link $here/digests.cpp src/base/digest.cpp src/rsl/jit/sha256.cpp -lfmt -lcrypto -lnettle -o "$work/digests" && "$work/digests"
