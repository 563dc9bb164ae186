# To be sourced by scripts/fleet after fleet-system.sh: commands on many machines at once, and what
# must hold before anything is started. Installed in /usr/lib/visavis.
# shellcheck shell=bash
# shellcheck disable=SC2046,SC2086  # services and hosts are words: lists of them are to be split
# shellcheck disable=SC2154  # fleet-system.sh sets them

CONTROL=/usr/lib/visavis/fleet-control # root's part on each machine, see its --help
FLEET_FOLDER=/etc/visavis/fleet        # what `deploy` put on each machine
THERE=/usr/lib/visavis/services        # the services of the package there, one a line
MAX_FILE_BYTES=20000000                # as fleet-control's max_file_bytes

declare -A off=()       # why a host is left out
declare -A host_name=() # what a host calls itself
declare -A unit_property=() # [HOST SERVICE PROPERTY]
num_faults=0

# SetUpSsh: the way to the machines; scratch is a folder that ends with the script.
SetUpSsh() {
  local sockets=${XDG_RUNTIME_DIR:-/tmp}/visavis-fleet-$UID option
  scratch=$(mktemp -d)
  trap 'rm -rf "$scratch"' EXIT
  trap 'exit 130' INT TERM
  (umask 077 && mkdir -p "$sockets")
  [[ -O $sockets ]] || sockets=$scratch
  # One connection for all commands of a minute; a machine that lost its power is noticed in 4 s.
  ssh_command=(ssh -o BatchMode=yes -o ConnectTimeout=3 -o LogLevel=ERROR
    -o ServerAliveInterval=2 -o ServerAliveCountMax=2
    -o ControlMaster=auto -o ControlPersist=60 -o "ControlPath=$sockets/%C")
  for option in "${ssh_options[@]}"; do ssh_command+=(-o "$option"); done
}

# At HOST COMMAND: runs a shell's command there. ExecAt: in place of this process.
At() { (ExecAt "$@"); }
ExecAt() {
  local host=$1 command=$2
  if [[ ${address[$host]} == localhost ]]; then
    exec sh -c "$command"
  else
    exec "${ssh_command[@]}" "${operator:+$operator@}${address[$host]}" "$command"
  fi
}

# Root's part, in a command: run as root where we are not. ControlAs: its words, as $c.
# shellcheck disable=SC2016  # for the shell there
ControlAs() { printf 'c=%s; [ "$(id -u)" = 0 ] || c="sudo -n $c"; ' "$CONTROL"; }
# shellcheck disable=SC2016
Control() { ControlAs && printf '$c %s' "$*"; }

# OnHosts FUNCTION HOST...: runs FUNCTION HOST for all at once; HOST.out, HOST.err and HOST.code in
# scratch hold what came of it.
OnHosts() {
  local function=$1 host pids=()
  shift
  for host in "$@"; do
    {
      code=0
      "$function" "$host" </dev/null >"$scratch/$host.out" 2>"$scratch/$host.err" || code=$?
      echo "$code" >"$scratch/$host.code"
    } &
    pids+=($!)
  done
  ((${#pids[@]} == 0)) || wait "${pids[@]}"
}

Code() { cat "$scratch/$1.code"; }

# A fault that keeps everything from being started: HostFault HOST FIELD VALUE RULE.
HostFault() {
  printf '%s:%s: host %s: %s: "%s": %s\n' "$system_file" \
    "${given_at[host $1]:-${given_at[$(ServicesOn "$1" | head -1)]}}" "$1" "$2" "$3" "$4" >&2
  num_faults=$((num_faults + 1))
}

# What ssh said means that the machine is off: one of multicast DNS has no address then.
IsOff() { [[ $1 == *"resolve hostname"*.local:* || ! $1 =~ (resolve hostname|ermission denied|key verification failed|authentication failures|onfiguration option) ]]; }

# After OnHosts: takes out the hosts that could not be reached, with a line for each, and counts
# those that can be but let nobody in as faults.
SortOutOff() {
  local host reason
  for host in "$@"; do
    (($(Code "$host") == 255)) || continue
    reason=$(tail -1 "$scratch/$host.err" | tr -d '\r')
    off[$host]=${reason:-no answer}
    if IsOff "$reason"; then
      printf '%s:%s: host %s (%s): is off or cannot be reached: %s; left out: %s\n' "$system_file" \
        "${given_at[host $host]:-1}" "$host" "${address[$host]}" "${off[$host]}" \
        "$(List $(ServicesOn "$host"))" >&2
      continue
    fi
    case $reason in
      *"resolve hostname"*)
        HostFault "$host" address "${address[$host]}" "must be an address or a name that is known: $reason"
        ;;
      *"key verification failed"*)
        HostFault "$host" login "${operator:+$operator@}${address[$host]}" \
          "must be a machine that ssh knows, log in once by hand: ssh ${operator:+$operator@}${address[$host]}"
        ;;
      *)
        HostFault "$host" login "${operator:-$(id -un)}@${address[$host]}" \
          "must be possible with a key, without a password: $reason"
        ;;
    esac
  done
}

# The hosts that can be reached.
Reachable() {
  local host
  for host in "${hosts[@]}"; do [[ -n ${off[$host]:-} ]] || echo "$host"; done
}

# What a machine says of itself, a word and its value a line; "heard" if listen_s > 0: the services
# that it hears on the LCM network within so many seconds.
Inquire() {
  local command units=("${SERVICES[@]/#/visavis@}")
  command="echo name \$(uname -n)
    echo services \$(cat $THERE 2>/dev/null)
    v=\$($(Control version) 2>&1) && echo version \$v || echo no-version \$v
    systemctl show -p Id,ActiveState,SubState,MainPID,NRestarts,UnitFileState,ActiveEnterTimestamp ${units[*]} | sed 's/^/unit /'
    cd $FLEET_FOLDER 2>/dev/null && find . -type f -exec sha256sum {} + 2>/dev/null | sed 's/^/file /'"
  if [[ ${listen_s:-0} != 0 ]]; then
    command="exec 3>&1
      { h=\$(visavis-probe listen --lcm-url '$lcm_url' --prefix '$prefix' --seconds $listen_s 2>&1) &&
        echo \"\$h\" | sed -n 's/./heard &/p' || echo deaf \$h; } >&3 & $command
      wait"
  fi
  At "$1" "$command"
}

# Answer HOST WORD: the values that Inquire got for a word.
Answer() { sed -n "s/^$2 //p" "$scratch/$1.out"; }

# UnitOf HOST SERVICE PROPERTY: of systemctl show; sets value. Without a process, as it is much used.
UnitOf() { value=${unit_property[$1 $2 $3]:-}; }
ReadUnits() {
  local host=$1 line service key
  local -A block=()
  while IFS= read -r line; do
    if [[ -n $line ]]; then
      block[${line%%=*}]=${line#*=}
      continue
    fi
    service=${block[Id]:-}
    service=${service#visavis@}
    for key in "${!block[@]}"; do unit_property[$host ${service%.service} $key]=${block[$key]}; done
    block=()
  done < <(Answer "$host" unit; echo)
}

# Asks all hosts, then sorts out those that are off.
InquireAll() {
  OnHosts Inquire "${hosts[@]}"
  SortOutOff "${hosts[@]}"
  local host
  for host in $(Reachable); do
    host_name[$host]=$(Answer "$host" name)
    ReadUnits "$host"
  done
}

# No machine stands for two: services are told apart by the names that machines have for themselves,
# and each has one folder to deploy to.
CheckNames() {
  local host name
  local -A owner=()
  for host in $(Reachable); do
    name=${host_name[$host]:-unknown}
    [[ -z ${owner[$name]:-} ]] || HostFault "$host" "host name" "$name" \
      "is that of ${owner[$name]} too: one machine must be given once, two must differ: sudo hostnamectl hostname NAME"
    owner[$name]=$host
  done
}

# The package is installed everywhere, the same, with the services that are to run there, and this
# user may control it.
CheckVersions() {
  local host version first='' first_host='' there service
  for host in $(Reachable); do
    version=$(Answer "$host" version)
    if [[ -z $version ]]; then
      HostFault "$host" package "$(Answer "$host" no-version)" \
        "must be installed, and ${operator:-$(id -un)} a member of visavis-operators"
    elif [[ -n $first && $version != "$first" ]]; then
      HostFault "$host" version "$version" "must be $first as on $first_host: install the same package on both"
    else
      first=$version first_host=$host
    fi
    [[ -n $version ]] || continue
    there=$(Answer "$host" services)
    for service in $(ServicesOn "$host"); do
      IsOneOf "$service" $there ||
        HostFault "$host" service "$service" "must be one of the package's there ($(List $there))"
    done
  done
}

# What is deployed on each host is what the system file says. After SumConfigurations.
CheckDeployed() {
  local host
  for host in $(Reachable); do
    TellUnfit "$host"
    if [[ $(<"$scratch/$host.sums") != "$(Answer "$host" file | sort)" ]]; then
      HostFault "$host" "$FLEET_FOLDER" "" "must be what the system file says: visavis-fleet deploy"
    fi
  done
}

# Nothing that the system file does not place on a machine runs there.
CheckPlaces() {
  local host service
  for host in $(Reachable); do
    for service in "${SERVICES[@]}"; do
      UnitOf "$host" "$service" ActiveState
      [[ $value =~ ^(active|activating)$ ]] || continue
      IsOneOf "$service" $(ServicesOn "$host") ||
        HostFault "$host" "runs" "$service" "must not run there by the system file: visavis-fleet stop"
    done
  done
}

# Nobody else uses our group, port and prefix. After an Inquire that listened.
CheckNetwork() {
  local host service where pid version word known=("${!off[@]}") # those go by the name in the file
  for host in $(Reachable); do
    known+=("${host_name[$host]}")
    word=$(Answer "$host" deaf | head -1)
    [[ -z $word ]] || HostFault "$host" lcm_url "$lcm_url" "must be a network that it can open: $word"
  done
  while read -r service where pid version _; do
    [[ -n $service ]] || continue
    service=${service//_/-}
    if ! IsOneOf "$where" "${known[@]}"; then
      printf '%s:%s: lcm_url: "%s": must be of this robot alone, but %s of host %s (pid %s, version %s) is heard on %sSERVICE_STATUS: take another group, port or prefix\n' \
        "$system_file" "${given_at[lcm_url]:-1}" "$lcm_url" "$service" "$where" "$pid" "$version" "$prefix" >&2
      num_faults=$((num_faults + 1))
      continue
    fi
    for host in $(Reachable); do
      [[ ${host_name[$host]} == "$where" ]] || continue
      UnitOf "$host" "$service" MainPID
      [[ $value == "$pid" ]] ||
        HostFault "$host" "$service" "pid $pid" "must run as visavis@$service alone: end that process"
    done
  done < <(for host in $(Reachable); do Answer "$host" heard; done | sort -u)
}

SumConfigurations() {
  local host
  for host in "${hosts[@]}"; do
    MakeConfiguration "$host"
    (cd "$scratch/configuration/$host" && find . -type f -exec sha256sum {} + | sort) >"$scratch/$host.sums"
  done
}

# MakeConfiguration HOST: the files that `deploy` brings there, as a folder in scratch; HOST.unfit
# holds what is wrong with them, for TellUnfit.
MakeConfiguration() {
  local host=$1 service file folder=$scratch/configuration/$1
  rm -rf "$folder"
  mkdir -p "$folder"
  : >"$scratch/$host.unfit"
  printf 'LCM_DEFAULT_URL=%s\nVISAVIS_PREFIX=%s\n' "$lcm_url" "$prefix" >"$folder/environment"
  for service in $(ServicesOn "$host"); do
    file=$(FileOf "$service" "$host")
    [[ -n $file ]] || continue
    cp -- "$file" "$folder/$service.yaml"
    CopyNamed "$host" "$(dirname "$file")" "$file" >>"$scratch/$host.unfit"
  done
}

# Words of a YAML file that may name another file.
WordsOf() {
  sed 's/\(^\|[[:space:]]\)#.*//' "$1" | tr '][{}",'\''[:space:]' '[\n*]' |
    grep -vE '^([-+0-9.e]*|.*:)$' | sort -u
}

# CopyNamed HOST FOLDER FILE: the files that FILE, a configuration of FOLDER or a YAML file that it
# names, names in its turn, to the same place relative to FOLDER. What is no file here, or an absolute
# path, the machine itself must have. Prints a line for each that cannot be brought.
CopyNamed() {
  local host=$1 folder=$2 file=$3 word from name to
  while IFS= read -r word; do
    from=$(dirname "$file")/$word
    [[ $word != /* && -f $from && ! $from -ef $file ]] || continue
    name=$(realpath -ms --relative-to="$folder" "$from")
    to=$scratch/configuration/$host/$name
    if [[ ! $name =~ ^[A-Za-z0-9_][A-Za-z0-9._+-]*(/[A-Za-z0-9_][A-Za-z0-9._+-]*)*$ ]]; then
      echo "$file: names \"$word\": must lie in $folder or below, of letters, digits and ._+-, or be an absolute path there"
    elif [[ $name == environment ]] || IsOneOf "${name%.yaml}" "${SERVICES[@]}"; then
      echo "$file: names \"$word\": must have another name, as that is a service's there"
    elif [[ -e $to ]]; then
      cmp -s "$from" "$to" ||
        echo "$file: names \"$word\": must have another name, as another service of $host names another file so"
    elif [[ ! -r $from || $(stat -Lc %s "$from") -gt $MAX_FILE_BYTES ]]; then
      echo "$file: names \"$word\": must be readable, of at most $((MAX_FILE_BYTES / 1000000)) MB"
    else
      mkdir -p "$(dirname "$to")" && cp -- "$from" "$to"
      if [[ $word == *.y*ml ]]; then CopyNamed "$host" "$folder" "$from"; fi
    fi
  done < <(WordsOf "$file")
}

# TellUnfit HOST: what MakeConfiguration found, as faults.
TellUnfit() {
  local line
  while IFS= read -r line; do
    printf '%s\n' "$line" >&2
    num_faults=$((num_faults + 1))
  done <"$scratch/$1.unfit"
}
