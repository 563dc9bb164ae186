# shellcheck shell=bash
# scripts/figures samples: the sequences under tests/data.
# shellcheck disable=SC2154 # bin, tests, folder, seeds, settings and sequences are scripts/figures'

# SampleReplays: the recogniser's runs, each aligned by the other sequence.
SampleReplays() {
  # Replay NAME START SEED: the recogniser's run of a sequence in NAME.run.lcm.
  Replay() {
    local start=()
    [[ $2 == unknown ]] || start=(--set "start.phi_mm_deg=$(StartOf "tests/data/$1")")
    "$bin/visavis-recogniser" --replay "$folder/$1.lcm" --record "$folder/$1.run.lcm" \
      --set "seed=$3" "${start[@]}" "${settings[@]}" >/dev/null
  }
  # Figures NAME START: visavis-evaluate's JSON, a value a line: NAME START PATH VALUE. Aligned by
  # the other sequence's offset where that one was tracked enough to fit it.
  Figures() {
    local reference=man_static offset=()
    [[ $1 != man_static ]] || reference=man_shuttle
    rm -f "$folder/offset.json"
    if "$bin/visavis-evaluate" "$folder/$reference.run.lcm" --fit-head-offset "$folder/offset.json" \
      >/dev/null 2>&1 && [[ -s $folder/offset.json ]]; then
      offset=(--head-offset "$folder/offset.json")
    fi
    "$bin/visavis-evaluate" "$folder/$1.run.lcm" "${offset[@]}" --json - | awk -v row="$1 $2" '
      { gsub(/[",]/, "") }
      /\{$/ { sub(/:/, "", $1); path[++depth] = $1; next }
      /^ *\}/ { --depth; next }
      { name = ""; for (i = 2; i <= depth; ++i) name = name path[i] "."; sub(/:/, "", $1); print row, name $1, $2 }'
  }
  local name start seed
  for name in man_static man_shuttle; do
    "$bin/visavis-log" import "tests/data/$name" "$folder/$name.lcm" >/dev/null || exit 1
  done
  for start in known unknown; do
    for ((seed = 1; seed <= ${seeds:-3}; ++seed)); do
      for name in man_static man_shuttle; do Replay "$name" "$start" "$seed" || exit 1; done
      for name in man_static man_shuttle; do Figures "$name" "$start" || exit 1; done
    done
  done >"$folder/figures"
  awk '
    function Median(row, name,    i, k, n, v, rank) {
      n = count[row, name]
      for (i = 1; i <= n; ++i) {
        v = value[row, name, i]; rank = 0
        for (k = 1; k <= n; ++k) rank += value[row, name, k] < v || (value[row, name, k] == v && k < i)
        if (rank == int(n / 2)) return v
      }
      return "-"
    }
    function Cell(row, name, format, factor,    v) {
      v = Median(row, name)
      return v == "-" ? "-" : sprintf(format, factor * v)
    }
    { row = $1 ", start " $2; if (!(row in known)) { known[row] = 1; rows[++num_rows] = row } }
    $4 != "null" { value[row, $3, ++count[row, $3]] = $4 + 0 }
    END {
      print "| medians of the seeds | TRACKING % | first lock s | raw: rmse mm | deg | within 15 mm, 5 deg % | false % | aligned: rmse mm | deg | within % | false % |"
      print "|---|---|---|---|---|---|---|---|---|---|---|"
      for (i = 1; i <= num_rows; ++i) {
        row = rows[i]
        printf "| %s | %s | %s |", row, Cell(row, "share_tracking", "%.1f", 100), Cell(row, "first_lock_s", "%.2f", 1)
        for (k = 1; k <= 2; ++k) {
          kind = k == 1 ? "raw" : "aligned"
          printf " %s | %s | %s | %s |", Cell(row, kind ".position_mm.norm.rmse", "%.1f", 1),
            Cell(row, kind ".angle_deg.total.rmse", "%.1f", 1),
            Cell(row, kind ".share_within_15mm_5deg", "%.1f", 100), Cell(row, kind ".share_false_tracking", "%.1f", 100)
        }
        print ""
      }
    }' "$folder/figures"
}

# SampleReferences, after SampleReplays: the refined estimator, poses aligned by what it finds on
# the reference views (man_reference: five views, 20 deg apart); from the generic head, and enrolled
# on these views.
SampleReferences() {
  local name logs=(man_static.lcm) head seed
  for name in tests/data/man_reference "${sequences[@]}"; do
    "$bin/visavis-log" import "$name" "$folder/${name##*/}.lcm" >/dev/null || return 1
    [[ $name == tests/* ]] || logs+=("${name##*/}.lcm")
  done
  "$bin/visavis-enrol" "$folder/man_reference.lcm" -o "$folder/head.yaml" >&2 || return 1
  for head in generic enrolled; do
    for ((seed = 1; seed <= ${seeds:-3}; ++seed)); do
      (cd "$folder" && if [[ $head == enrolled ]]; then set -- --head head.yaml; else set --; fi &&
        "$OLDPWD/$tests/refined_runs" "$@" "${settings[@]}" "$seed" man_reference.lcm "${logs[@]}") |
        sed "s/[.]lcm//; s/^/$head /" || return 1
    done
  done >"$folder/runs"
  awk '
    { row = $2 ", " $1; if (!(row in n)) rows[++num_rows] = row
      ++n[row]; tracking[row] += $4; wrong[row] += $5
      if ($7 == "-") next  # shorter than 2 s, or not TRACKING
      ++measured[row]; mm[row] += $7; deg[row] += $8
      if ($7 > most_mm[row]) most_mm[row] = $7
      if ($8 > most_deg[row]) most_deg[row] = $8 }
    END {
      print "\n| means of the seeds (worst), after 2 s | TRACKING % | false % | aligned by the reference views: rmse mm | deg |"
      print "|---|---|---|---|---|"
      for (i = 1; i <= num_rows; ++i) {
        row = rows[i]
        m = measured[row]
        errors = !m ? "- | -" : sprintf("%.2f (%.2f) | %.2f (%.2f)", mm[row] / m, most_mm[row], deg[row] / m, most_deg[row])
        printf "| %s | %.1f | %.2f | %s |\n", row, tracking[row] / n[row], wrong[row] / n[row], errors
      }
    }' "$folder/runs"
}
