# To be sourced by scripts/fleet and scripts/doctor: reads the system file, which says what runs
# where. Installed in /usr/lib/visavis.
# shellcheck shell=bash
# shellcheck disable=SC2034  # what is read here is used by those that source it

# Every service that a machine can run: the programs' names without visavis-.
SERVICES=(stereo-capture arm-state recogniser logger simulator)
SYSTEM_KEYS=(lcm_url prefix user ssh_option host)

# What ReadSystem finds. A host is its name in the file; a task is one service on one host.
system_file='' lcm_url='' prefix='' operator=''
ssh_options=()                   # NAME=VALUE each
hosts=()                         # in the order of the file; of those with tasks
declare -A address=()            # of each host; localhost: no ssh
declare -A given_at=()           # line of each key, host and task, e.g. [host camera]=4
task_services=() task_hosts=() task_files=() # equally long; a file may be empty

# Prints a refusal of a value of the system file: Refuse LINE FIELD VALUE RULE.
Refuse() {
  printf '%s:%s: %s: "%s": %s\n' "$system_file" "$1" "$2" "$3" "$4" >&2
  num_refused=$((num_refused + 1))
}

# List WORD...: "a, b, c".
List() {
  local text
  text=$(printf '%s, ' "$@")
  echo "${text%, }"
}

IsOneOf() {
  local word=$1 other
  shift
  for other in "$@"; do [[ $word != "$other" ]] || return 0; done
  return 1
}

# ReadSystem FILE: @return 1 after a line on stderr for each thing that is wrong.
ReadSystem() {
  system_file=$1
  local number=0 line word first second more declared=()
  num_refused=0
  if [[ ! -r $system_file || -d $system_file ]]; then
    printf '%s: must be a readable file that says which service runs where\n' "$system_file" >&2
    return 1
  fi
  address[localhost]=localhost
  while IFS= read -r line || [[ -n $line ]]; do
    number=$((number + 1))
    line=${line%%#*}
    read -r word first second more <<<"${line//$'\r'/}"
    [[ -n $word ]] || continue
    if [[ -z $first ]]; then
      Refuse "$number" "$word" "" "must have a value"
    elif [[ -n $more || (-n $second && $word =~ ^(lcm_url|prefix|user|ssh_option)$) ]]; then
      Refuse "$number" "$word" "${second:+$second }$more" "more words than the line may have"
    elif IsOneOf "$word" "${SERVICES[@]}"; then
      AddTask "$number" "$word" "$first" "$second"
    elif [[ $word == host ]]; then
      AddHost "$number" "$first" "${second:-$first}"
    elif [[ $word == ssh_option ]]; then
      [[ $first =~ ^[A-Za-z0-9]+=.+$ ]] || Refuse "$number" ssh_option "$first" "must be NAME=VALUE, as ssh -o takes it"
      ssh_options+=("$first")
    elif IsOneOf "$word" "${SYSTEM_KEYS[@]}"; then
      SetKey "$number" "$word" "$first"
    else
      Refuse "$number" "service or key" "$word" \
        "must be a service ($(List "${SERVICES[@]}")) or a key ($(List "${SYSTEM_KEYS[@]}"))"
    fi
  done <"$system_file"
  CheckTasks
  CheckUrl
  ((num_refused == 0))
}

SetKey() {
  local number=$1 key=$2 value=$3
  if [[ -n ${given_at[$key]:-} ]]; then
    Refuse "$number" "$key" "$value" "must be given once, and is in line ${given_at[$key]}"
    return
  fi
  given_at[$key]=$number
  case $key in
    lcm_url) lcm_url=$value ;;
    prefix)
      [[ $value =~ ^[A-Z0-9_]{1,31}$ ]] ||
        Refuse "$number" prefix "$value" "must be 1 to 31 of A-Z, 0-9 and _, e.g. ROBOT1_"
      prefix=$value
      ;;
    user)
      [[ $value =~ ^[a-z_][a-z0-9_-]*$ ]] || Refuse "$number" user "$value" "must be a user's name"
      operator=$value
      ;;
  esac
}

AddHost() {
  local number=$1 name=$2 where=$3 other
  if [[ ! $name =~ ^[A-Za-z0-9][A-Za-z0-9.-]*$ || $name == localhost ]]; then
    Refuse "$number" host "$name" "must be a name of letters, digits, - and ., other than localhost"
  elif [[ ! $where =~ ^[A-Za-z0-9:][A-Za-z0-9.:_%-]*$ ]]; then
    Refuse "$number" "host $name" "$where" "must be an address or a name that ssh knows"
  elif [[ -n ${given_at[host $name]:-} ]]; then
    Refuse "$number" host "$name" "must be given once, and is in line ${given_at[host $name]}"
  else
    for other in "${!address[@]}"; do
      [[ ${address[$other]} != "$where" ]] ||
        Refuse "$number" "host $name" "$where" "is the address of $other already"
    done
    address[$name]=$where
    given_at[host $name]=$number
    declared+=("$name")
  fi
}

AddTask() {
  local number=$1 service=$2 host=$3 file=$4
  if [[ -n ${given_at[$service $host]:-} ]]; then
    Refuse "$number" "$service" "$host" "runs there already by line ${given_at[$service $host]}"
    return
  fi
  # Two loggers write two files; two of another kind would publish on one channel.
  if [[ $service != logger ]] && IsOneOf "$service" "${task_services[@]}"; then
    Refuse "$number" "$service" "$host" "must run on one machine alone, and is given by line ${given_at[$service]}"
    return
  fi
  given_at[$service]=$number
  given_at[$service $host]=$number
  if [[ -n $file && $file != /* ]]; then file=$(dirname "$system_file")/$file; fi
  if [[ -n $file && (! -r $file || -d $file) ]]; then
    Refuse "$number" "$service configuration" "$file" "must be a readable file"
  fi
  task_services+=("$service")
  task_hosts+=("$host")
  task_files+=("$file")
}

# Hosts may be declared after the services that use them.
CheckTasks() {
  local i host
  for i in "${!task_hosts[@]}"; do
    host=${task_hosts[i]}
    if [[ -z ${address[$host]:-} ]]; then
      Refuse "${given_at[${task_services[i]} $host]}" "${task_services[i]} host" "$host" \
        "must be a host of this file ($(List localhost "${declared[@]}"))"
    fi
    IsOneOf "$host" "${hosts[@]}" || hosts+=("$host")
  done
  if ((${#task_hosts[@]} == 0)); then
    Refuse "$number" service "" "must be given at least once, e.g. recogniser localhost"
  fi
}

CheckUrl() {
  local rule='' at=${given_at[lcm_url]:-}
  if [[ -z $lcm_url ]]; then
    lcm_url='udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304'
    ((${#hosts[@]} < 2)) || rule="must be given where several machines are meant, with ttl=1"
  elif [[ ! $lcm_url =~ ^udpm://(22[4-9]|23[0-9])(\.[0-9]{1,3}){3}:([0-9]{1,5})(\?[A-Za-z0-9_]+=[0-9]+(&[A-Za-z0-9_]+=[0-9]+)*)?$ ]] ||
    ((10#${BASH_REMATCH[3]} < 1 || 10#${BASH_REMATCH[3]} > 65535)); then
    rule="must be udpm://GROUP:PORT?ttl=N&recv_buf_size=BYTES, GROUP from 224.0.0.0 to 239.255.255.255, PORT from 1 to 65535"
  elif ((${#hosts[@]} > 1)) && [[ ! $lcm_url =~ [?\&]ttl=[1-9] ]]; then
    rule="must have ttl=1 or more, else nothing leaves a machine and there are ${#hosts[@]}"
  fi
  [[ -z $rule ]] || Refuse "${at:-1}" lcm_url "$lcm_url" "$rule"
}

# ServicesOn HOST SERVICE...: which of the services (none given: of all) the file places there.
ServicesOn() {
  local host=$1 i
  shift
  for i in "${!task_hosts[@]}"; do
    [[ ${task_hosts[i]} == "$host" ]] || continue
    if (($# == 0)) || IsOneOf "${task_services[i]}" "$@"; then echo "${task_services[i]}"; fi
  done
}

# FileOf SERVICE HOST: its configuration's file, or nothing.
FileOf() {
  local i
  for i in "${!task_hosts[@]}"; do
    if [[ ${task_services[i]} == "$1" && ${task_hosts[i]} == "$2" ]]; then echo "${task_files[i]}"; fi
  done
}
