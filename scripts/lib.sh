# Shared by the scripts beside it; to be sourced. Sets repo (the checkout's root) and goes there.
# shellcheck shell=bash
set -euo pipefail
repo=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$repo"
script=scripts/$(basename "$0")
if [[ $script == scripts/visavis-* ]]; then script=${script#scripts/}; fi # installed
# No script ends in silence: what was not foreseen names its line.
trap 'printf "%s: line %s: \"%s\" failed\n" "$script" "$LINENO" "$BASH_COMMAND" >&2' ERR

# One line on stderr, exit 1 (or the given code).
Fail() {
  printf '%s: %s\n' "$script" "$1" >&2
  exit "${2:-1}"
}

# Bad flag: one line, exit 2.
BadFlag() { Fail "$1 (--help shows the flags)" 2; }

Say() { printf '== %s\n' "$1"; }

# Prints the comment block at the script's head: what it does and its flags.
ShowHelp() { sed -n '2,/^[^#]/{/^# shellcheck/d;s/^# \{0,1\}//p}' "$0" | sed "1s|^scripts/[a-z-]*:|$script:|"; }

# Bytes of memory that are free for us, in MB: the host's, or the container's limit if lower.
FreeMegabytes() {
  local free limit
  free=$(awk '/^MemAvailable:/ {print int($2 / 1024)}' /proc/meminfo)
  limit=$(cat /sys/fs/cgroup/memory.max 2>/dev/null || echo max)
  if [[ $limit =~ ^[0-9]+$ ]] && ((limit / 1048576 < free)); then free=$((limit / 1048576)); fi
  echo "$free"
}

# Compilers to run at once: one a core, each with 1 GB of memory (what our largest file takes).
NumJobs() {
  local cores memory
  cores=$(nproc)
  memory=$(($(FreeMegabytes) / 1024))
  ((memory >= 1)) || memory=1
  echo $((cores < memory ? cores : memory))
}

# Tick DONE TOTAL LABEL: progress on one line of a terminal, else a line at every tenth.
last_tenth=-1
Tick() {
  local done=$1 total=$2 label=$3
  ((total > 0)) || return 0
  local tenth=$((10 * done / total))
  if [[ -t 1 ]]; then
    printf '\r   %s: %d of %d ' "$label" "$done" "$total"
    if ((done >= total && last_tenth < 10)); then printf '\n'; fi
  elif ((tenth != last_tenth)); then
    printf '   %s: %d of %d\n' "$label" "$done" "$total"
  fi
  last_tenth=$tenth
}

# Runs cmake's configure and build of a preset: [target=X] Build PRESET [CMAKE ARGUMENTS...].
# The whole output goes to build/PRESET.log; what failed is shown.
Build() {
  local preset=$1 jobs log line
  shift
  mkdir -p build
  log=build/$preset.log
  jobs=${VISAVIS_JOBS:-$(NumJobs)}
  Say "configuring the $preset build"
  if ! cmake --preset "$preset" "$@" >"$log" 2>&1; then
    grep -A8 -m3 -E 'CMake Error|not found' "$log" >&2 || tail -20 "$log" >&2
    Fail "CMake could not configure, see $log"
  fi
  Say "building with $jobs at once, the output in $log"
  last_tenth=-1
  if ! cmake --build --preset "$preset" --parallel "$jobs" ${target:+--target "$target"} 2>&1 | tee -a "$log" |
    while IFS= read -r line; do
      if [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]]; then
        Tick "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}" built
      fi
    done; then
    sed -n '/^FAILED/,$p' "$log" | head -60 >&2
    Fail "the $preset build failed, see $log"
  fi
}

# Runs a preset's tests: RunTests PRESET [CTEST ARGUMENTS...]. No test reads from a terminal.
RunTests() {
  local preset=$1
  shift
  ctest --preset "$preset" --parallel "$(nproc)" --no-tests=error "$@" </dev/null
}
