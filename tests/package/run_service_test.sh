#!/usr/bin/env bash
# Usage: run_service_test.sh BUILD
# Which configuration a unit's service is started with.
# shellcheck source=tests/package/lib.sh
source "$(dirname "$0")/lib.sh"
root=$folder/root
InstallPrograms "$1" "$root"
run=$root/usr/lib/visavis/run-service
cat >"$root/usr/bin/visavis-logger" <<'END'
#!/bin/sh
echo "$$ $*"
END

# Started SERVICE: what the program was given, and whether it is the process that systemd started.
Started() { bash -c "echo \$\$; exec $run $1" | paste -sd ' ' | sed 's/^\([0-9]*\) \1 */same process: /'; }
Equal "without a deployed configuration" "$(Started logger)" \
  "same process: --config $root/etc/visavis/logger.yaml"
mkdir "$root/etc/visavis/fleet"
echo "name: other" >"$root/etc/visavis/fleet/recogniser.yaml"
Equal "with another service's" "$(Started logger)" \
  "same process: --config $root/etc/visavis/logger.yaml"
echo "name: fleet" >"$root/etc/visavis/fleet/logger.yaml"
Equal "with a deployed one" "$(Started logger)" \
  "same process: --config $root/etc/visavis/fleet/logger.yaml"
rm -r "$root/etc/visavis"
[[ $(Started logger) == "same process: " ]] || Wrong "with none it is given: $(Started logger)"

Refused "'recognizer': unknown service, must be one of" "$run" recognizer
Refused "'': unknown service" "$run"
Refused "'../bin/sh': unknown service" "$run" ../bin/sh
Refused "'.*': unknown service" "$run" '.*'
Refused "'log': unknown service" "$run" log # a tool, not a service
Finish
