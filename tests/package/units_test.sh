#!/usr/bin/env bash
# Usage: units_test.sh BUILD
# The units as systemd reads them: valid, supervised as promised, exposed at most 3.0 each.
# shellcheck source=tests/package/lib.sh
source "$(dirname "$0")/lib.sh"
command -v systemd-analyze >/dev/null || Skip "systemd-analyze is missing: sudo apt-get install systemd"
root=$folder/root units=$folder/root/lib/systemd/system
InstallPrograms "$1" "$root"
mapfile -t services <"$root/usr/lib/visavis/services"

# Exposure UNIT: tenths, as systemd-analyze prints them.
Exposure() {
  systemd-analyze security --root="$root" --offline=true --no-pager "$1" |
    sed -n 's/.*exposure level for .*: \([0-9]*\)\.\([0-9]\).*/\1\2/p'
}

for name in recogniser logger stereo-capture arm-state; do
  [[ " ${services[*]} " == *" $name "* ]] || Wrong "$name is not among the services"
done
for name in "${services[@]}"; do
  exposure=$(Exposure "visavis@$name.service")
  echo "visavis@$name: exposure $((10#$exposure / 10)).$((10#$exposure % 10))"
  ((10#$exposure <= 30)) || Wrong "visavis@$name: exposure $exposure tenths, must be at most 30"
  [[ -x $root/usr/bin/visavis-$name ]] || Wrong "visavis-$name is not installed"
  cmp -s "$root/etc/visavis/$name.yaml" "services/${name//-/_}/${name//-/_}.yaml" ||
    Wrong "/etc/visavis/$name.yaml is not the shipped default"
done
# The figure tells units apart: one without our directives is far above.
sed '/^\[Service\]/,/^\[Install\]/{/^\(Type\|ExecStart\|\[\)/!d}' "$units/visavis@.service" \
  >"$units/bare.service"
(($(Exposure bare.service) > 80)) || Wrong "a unit without hardening is not told apart"

# The examples keep it so, and systemd understands them.
for example in "$root"/usr/share/doc/visavis/examples/*.conf; do
  cp "$example" "$units/visavis@stereo-capture.service.d"
done
exposure=$(Exposure visavis@stereo-capture.service)
((10#$exposure <= 30)) || Wrong "with the examples: exposure $exposure tenths, must be at most 30"

# Units of the system that ours name, so that nothing is missing where they are looked for.
cp -n /lib/systemd/system/*.target /lib/systemd/system/*.{mount,slice,socket} "$units"
verified=$(systemd-analyze verify --man=no --recursive-errors=no --root="$root" \
  visavis@logger.service visavis@stereo-capture.service visavis.target 2>&1) ||
  Wrong "systemd-analyze verify: $verified"
Equal "what systemd-analyze verify says" "$verified" ""

# Setting NAME: as the file has it; a test of promises that the exposure does not count.
Setting() { sed -n "s/^$1=//p" "$units/visavis@.service" | paste -sd ' '; }
Equal Type "$(Setting Type)" notify
Equal WatchdogSec "$(Setting WatchdogSec)" 2s
Equal Restart "$(Setting Restart)" always
Equal RestartSec "$(Setting RestartSec)" 200ms
Equal StartLimitIntervalSec "$(Setting StartLimitIntervalSec)" 0
Equal User "$(Setting User)" visavis
Equal WantedBy "$(Setting WantedBy)" visavis.target
Equal RestrictAddressFamilies "$(Setting RestrictAddressFamilies)" "AF_UNIX AF_INET AF_NETLINK"
# The status asks the kernel whether the clock is synchronised.
[[ $(Setting SystemCallFilter) == *" clock_adjtime" ]] || Wrong "clock_adjtime is not allowed"
Equal ProtectClock "$(Setting ProtectClock)" ""
Equal "the target's WantedBy" \
  "$(sed -n 's/^WantedBy=//p' "$units/visavis.target")" multi-user.target

# The kernel grants what the default URL asks for.
asked=$(sed -n 's/.*recv_buf_size=\([0-9]*\).*/\1/p' common/bus/lcm_bus.h)
granted=$(sed -n 's/^net.core.rmem_max = //p' "$root/usr/lib/sysctl.d/60-visavis.conf")
((granted >= asked)) || Wrong "rmem_max $granted is below the URL's recv_buf_size $asked"

Equal "the sudo rule's mode" "$(stat -c %a "$root/etc/sudoers.d/visavis-fleet")" 440
if command -v visudo >/dev/null; then
  visudo -cqf "$root/etc/sudoers.d/visavis-fleet" || Wrong "visudo refuses the sudo rule"
  echo 'nonsense here' >>"$folder/rule"
  if visudo -cqf "$folder/rule" 2>/dev/null; then Wrong "visudo takes anything"; fi
else
  echo "no visudo here: the sudo rule's grammar was not checked"
fi
Finish
