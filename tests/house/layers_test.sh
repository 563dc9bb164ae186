#!/usr/bin/env bash
# Who may include what: each folder names the folders of common that it may use.
# shellcheck source=tests/house/files.sh
source "$(dirname "$0")/files.sh"
declare -A may_use=(
  [core]=""
  [config]="core"
  [eventlog]="core"
  [image]="core"
  [geometry]="core"
  [kinematics]="core geometry"
  [rigs]="core geometry config"
  [bus]="core eventlog"
  [convert]="core geometry image kinematics rigs"
  [service]="core config bus eventlog"
)
# Those that know the messages' types; and lcm itself is bus's alone.
knows_messages=" convert service "
failed=0

Complain() {
  echo "$1"
  failed=1
}

# Included LINE-WISE: "FILE:INCLUDED"
Includes() { Files "$@" | xargs -r grep -oHE '^#include [<"][^">]+' | sed -E 's/#include [<"]//'; }

while IFS=: read -r file included; do
  folder=$(cut -d/ -f2 <<<"$file")
  [[ -v may_use[$folder] ]] || Complain "$file: common/$folder is not in the table of $0"
  case $included in
    common/service/version.h) ;;
    common/*)
      used=$(cut -d/ -f2 <<<"$included")
      [[ $used == "$folder" || " ${may_use[$folder]:-} " == *" $used "* ]] ||
        Complain "$file: common/$folder must not include $included"
      ;;
    visavis/*)
      [[ $knows_messages == *" $folder "* ]] ||
        Complain "$file: common/$folder must not know the message $included"
      ;;
    lcm/*) [[ $folder == bus ]] || Complain "$file: only common/bus may include $included" ;;
    services/* | tests/*) Complain "$file: common must not include $included" ;;
  esac
done < <(Includes 'common/*.h' 'common/*.cc')

while IFS=: read -r file included; do
  service=$(cut -d/ -f2 <<<"$file")
  case $included in
    services/"$service"/*) ;;
    services/*) Complain "$file: a service must not include another's $included" ;;
    tests/*) Complain "$file: a product must not include $included" ;;
    lcm/*) Complain "$file: only common/bus may include $included" ;;
  esac
done < <(Includes 'services/*.h' 'services/*.cc')

exit "$failed"
