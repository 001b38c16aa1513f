# Shared by ./render and ./check: installs what is missing, configures, builds. Says each step in a line; does nothing twice.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf 'alpenglow: %s\n' "$*" >&2; }

install_packages() {
    local missing=()
    for p in $(cat scripts/packages.txt) "$@"; do
        [ "$(dpkg-query -W -f '${db:Status-Status}' "$p" 2>/dev/null)" = installed ] || missing+=("$p")
    done
    [ ${#missing[@]} -eq 0 ] && return 0
    local sudo=()
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null || { say "these packages are missing and need root to install: ${missing[*]}"; exit 3; }
        sudo=(sudo)
    fi
    say "installing ${#missing[@]} packages: ${missing[*]}"
    "${sudo[@]}" apt-get update -qq
    DEBIAN_FRONTEND=noninteractive "${sudo[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}" >/tmp/alpenglow-apt.$$ 2>&1 ||
        { cat "/tmp/alpenglow-apt.$$" >&2; say "apt-get failed"; exit 3; }
    rm -f "/tmp/alpenglow-apt.$$"
}

# Sources that have been edited are compiled alone from then on, the others in groups (cmake/quick.cmake).
note_edited() {
    local list=build/$1/edited.txt now
    now=$( { [ ! -f "$list" ] || cat "$list"; git ls-files -m -o --exclude-standard -- 'src/*.cpp' 'tests/*.cpp' 2>/dev/null || true; } | sort -u)
    if [ -f "$list" ] && [ "$now" = "$(cat "$list")" ]; then return 0; fi
    mkdir -p "build/$1"
    printf '%s\n' "$now" >"$list"
}

# build PRESET TARGET...: configures once; ninja decides what is stale.
build() {
    local preset=$1; shift
    note_edited "$preset"
    if [ ! -f "build/$preset/build.ninja" ]; then
        say "configuring build/$preset"
        cmake --preset "$preset" >"/tmp/alpenglow-cmake.$$" 2>&1 || { cat "/tmp/alpenglow-cmake.$$" >&2; exit 3; }
        rm -f "/tmp/alpenglow-cmake.$$"
    fi
    if ninja -C "build/$preset" -n "$@" | grep -q 'no work to do'; then return 0; fi
    say "building $* in build/$preset (the first time takes a while)"
    export GLIBC_TUNABLES=${GLIBC_TUNABLES:-glibc.malloc.hugetlb=1} # compilers take a tenth less time with large pages
    if [ -t 1 ]; then ninja -C "build/$preset" "$@" >&2
    else ninja -C "build/$preset" --quiet "$@" >&2; fi
}
