#!/usr/bin/env bash
# Usage: package_test.sh BUILD
# What the Debian packages hold and ask for.
# shellcheck source=tests/package/lib.sh
source "$(dirname "$0")/lib.sh"
command -v dpkg-shlibdeps >/dev/null || Skip "dpkg-shlibdeps is missing: sudo apt-get install dpkg-dev"
command -v file >/dev/null || Skip "file is missing: sudo apt-get install file"
cpack --config "$1/CPackConfig.cmake" -B "$folder/pack" -D CPACK_DEBIAN_COMPRESSION_TYPE=none \
  >"$folder/log" 2>&1 || {
  tail -20 "$folder/log"
  exit 1
}
for package in visavis visavis-lcmtypes visavis-dev; do
  deb=$(find "$folder/pack" -maxdepth 1 -name "${package}_*.deb")
  [[ -f $deb ]] || {
    echo "FAILED: not one package $package, but: $deb"
    exit 1
  }
  ln -s "$deb" "$folder/$package.deb"
  dpkg-deb -x "$deb" "$folder/$package"
  dpkg-deb -e "$deb" "$folder/$package.control"
  # Mode, owner, name of what is packed.
  dpkg-deb -c "$deb" | awk '{print $1, $2, $6}' >"$folder/$package.list"
done

# Field PACKAGE NAME
Field() { dpkg-deb -f "$folder/$1.deb" "$2"; }
# Packed PACKAGE MODE NAME
Packed() { grep -qxF -e "$2 root/root .$3" "$folder/$1.list" || Wrong "$1: no $2 $3"; }

if grep -vh ' root/root ' "$folder"/*.list; then Wrong "the above do not belong to root"; fi
if grep -E '^.{8}w| \./(home|tmp|usr/local|var|run)/' "$folder"/*.list; then
  Wrong "the above is packed where anybody may write, or where packages do not"
fi
if grep -rlF -e "$1" -e "$PWD" "$folder"/{visavis,visavis-dev,visavis-lcmtypes}{,.control}; then
  Wrong "the files above name the folder of the build"
fi
for control in "$folder"/*.control; do (cd "${control%.control}" && md5sum -c --quiet "$control/md5sums") ||
  Wrong "md5sums of $control"; done

mapfile -t services <"$folder/visavis/usr/lib/visavis/services"
for service in "${services[@]}"; do
  Packed visavis -rw-r--r-- "/etc/visavis/$service.yaml"
  Packed visavis -rwxr-xr-x "/usr/bin/visavis-$service"
  Packed visavis -rw-r--r-- "/usr/share/doc/visavis/$service.md"
done
for program in "$1"/bin/visavis-*; do
  Packed visavis -rwxr-xr-x "/usr/bin/$(basename "$program")"
  Packed visavis -rw-r--r-- "/usr/share/man/man1/$(basename "$program").1.gz"
done
if file "$folder"/visavis/usr/bin/* | grep 'not stripped'; then Wrong "the above are not stripped"; fi
# Not one file under /etc is lost by an upgrade.
Equal "configuration files" "$(sort "$folder/visavis.control/conffiles" | paste -sd ' ')" \
  "$(cd "$folder/visavis" && find etc -type f | sed 's|^|/|' | sort | paste -sd ' ')"
Packed visavis -r--r----- /etc/sudoers.d/visavis-fleet
Packed visavis -rwxr-xr-x /usr/lib/visavis/fleet-control
Packed visavis -rwxr-xr-x /usr/lib/visavis/run-service
Packed visavis-lcmtypes -rw-r--r-- /usr/include/visavis/head_pose_t.hpp
Packed visavis-lcmtypes -rw-r--r-- /usr/share/visavis/lcmtypes/head_pose_t.lcm
Packed visavis-lcmtypes -rwxr-xr-x /usr/bin/visavis-spy
Packed visavis-lcmtypes -rw-r--r-- /usr/share/man/man1/visavis-spy.1.gz
Packed visavis-dev -rw-r--r-- /usr/share/cmake/visavis/visavis-config.cmake

# Libraries by what the programs link, commands by their names.
for library in liblcm1 libaravis-0.8-0 libyaml-cpp0.7 libc6; do
  [[ $(Field visavis Depends) == *" $library"[\ ,]* ]] || Wrong "visavis does not depend on $library"
done
[[ $(Field visavis Depends) != *-dev* ]] || Wrong "visavis depends on development files"
[[ $(Field visavis Recommends) == *gnuplot-nox* ]] || Wrong "visavis does not recommend gnuplot-nox"
version=$(Field visavis Version)
Equal "the version that fleet-control tells" "$(cat "$folder/visavis/usr/lib/visavis/version")" "$version"
Equal "the types' version" "$(Field visavis-lcmtypes Version)" "$version"
[[ $(Field visavis-dev Depends) == "visavis-lcmtypes (= $version), "* ]] ||
  Wrong "visavis-dev depends on other types: $(Field visavis-dev Depends)"
for package in visavis-lcmtypes visavis-dev; do
  Equal "$package's architecture" "$(Field $package Architecture)" all
done
[[ $(dpkg-deb -f "$folder/visavis.deb" Description | head -1) == *"head pose"* ]] ||
  Wrong "the description is not ours"
Finish
