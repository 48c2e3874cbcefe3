#!/usr/bin/env bash
# Tries the Debian packages where nothing else of Kenaf, and nothing of its build, is: installs them by apt in a fresh Debian
# 12, and does there what README.md shows, and what an administrator does with the services.
#
#   scripts/try-package.sh [BUILD_DIR]      default: build/install, which must be built
#
# Needs root, debootstrap, and a mirror (DEBIAN_MIRROR, default: debootstrap's). The Debian is made below CHROOTS
# (default /tmp/chroots), takes 2 GB and goes at the end. Processes and ports are in namespaces of their own. About five
# minutes. Exit status 0: all of it worked.
set -euo pipefail
say() { printf 'try-package: %s\n' "$*"; }
fail() { printf 'try-package: %s\n' "$*" >&2; exit 1; }
source=$(cd "$(dirname "$0")/.." && pwd)

# ---- Outside: a Debian, and the packages in it ----

if [ "${1:-}" != --inside ]; then
  build=$(cd "${1:-$source/build/install}" && pwd) || fail "build first: cmake --preset install && cmake --build --preset install"
  [ "$(id -u)" = 0 ] || fail "debootstrap needs root: sudo $0 $*"
  command -v debootstrap >/dev/null || fail "there is no debootstrap: apt-get install debootstrap"
  mkdir -p "${CHROOTS:-/tmp/chroots}"
  root=$(mktemp -d "${CHROOTS:-/tmp/chroots}/package.XXXXXX")
  trap 'umount "$root/proc" 2>/dev/null || true; rm -rf --one-file-system "$root"' EXIT
  log=$root.log

  say "a fresh Debian 12"
  debootstrap --variant=minbase bookworm "$root" ${DEBIAN_MIRROR:+"$DEBIAN_MIRROR"} >"$log" 2>&1 || { tail "$log"; fail debootstrap; }
  chmod 755 "$root"
  cp /etc/resolv.conf "$root/etc/resolv.conf"
  mkdir "$root/new" "$root/old"
  (cd "$root/new" && cpack --config "$build/CPackConfig.cmake" -B "$root/new") >"$log" 2>&1 || { tail "$log"; fail cpack; }
  rm -rf "$root/new/_CPack_Packages"

  # The same packages as of an earlier version, to upgrade from.
  for deb in "$root"/new/*.deb; do
    dpkg-deb -R "$deb" "$root/old/package"
    sed -i -E 's/(^Version: .*|\(= [^)]*)-1/\1-0/' "$root/old/package/DEBIAN/control"
    dpkg-deb --root-owner-group -Znone -b "$root/old/package" "$root/old/$(basename "$deb")" >/dev/null
    rm -rf "$root/old/package"
  done

  # No service is started by the installation of others, and none of systemd's is needed.
  printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d"
  chmod 755 "$root/usr/sbin/policy-rc.d"
  mount -t proc proc "$root/proc"
  apt() { chroot "$root" env DEBIAN_FRONTEND=noninteractive apt-get -qq --no-install-recommends "$@" >>"$log" 2>&1 || { tail -n 30 "$log"; fail "apt-get $*"; }; }
  apt update
  apt install systemd
  # shellcheck disable=SC2046  # a word for each package
  apt install $(cd "$root" && ls -d ./old/{libkenaf[0-9],libkenaf-dev,kenaf-data,kenaf}_*.deb ./old/kenaf-operator_*.deb)
  rm "$root/usr/sbin/policy-rc.d"
  say "installed: $(chroot "$root" dpkg-query -W -f '${Package} ${Version}, ' '*kenaf*')with $(chroot "$root" dpkg-query -W | wc -l) packages in all"
  apt install gcc libc6-dev pkg-config
  umount "$root/proc"
  unshare --mount --net --pid --fork --kill-child "$0" --inside "$root"
  rm "$log"
  say "all of it works"
  exit
fi

# ---- Inside: as a user, then as an administrator ----

root=$2
mount -t proc proc "$root/proc"
ip link set lo up
home=/home/user
mkdir -p "$root$home"
chown nobody "$root$home"
as_user() { chroot --userspec=nobody:nogroup "$root" /usr/bin/env -i PATH=/usr/bin:/bin HOME=$home sh -c "cd $home; $1"; }
fetch() { "$source/tests/package/fetch_page.py" "$@" >"$root/fetched" || fail "the page does not work"; wc -l <"$root/fetched"; }

# serve PATTERN COMMAND: starts a server and waits until it has written the pattern to server.log.
serve() {
  rm -f "$root$home/server.log"
  as_user "echo \$\$ >pid; exec $2 >server.log 2>&1" &
  until grep -qE "$1" "$root$home/server.log" 2>/dev/null; do
    kill -0 $! 2>/dev/null || { cat "$root$home/server.log"; fail "'$2' ended before it said '$1'"; }
    sleep 0.2
  done
}
end_server() {  # with 0, as it is asked to
  kill "$(cat "$root$home/pid")"
  wait $! || { cat "$root$home/server.log"; fail "the server did not end as asked"; }
}

serve 'listening on' 'kenaf-relayd --embedded --view 127.0.0.1:8080'
say "live view: $(fetch http://127.0.0.1:8080/ main.js three.module.js OrbitControls.js) files served"
as_user 'cp /usr/share/doc/kenaf/examples/square.c . && cc square.c -o square_sim $(pkg-config --cflags --libs kenaf-sim) &&
  KENAF_RECORD=square.csv ./square_sim >square.log && kenaf-draw square.csv --out square.png >drawn' || fail "the square"
say "$(cat "$root$home/drawn")"
end_server

as_user 'kenaf-gap simulate --manoeuvre straight --manoeuvre turn-in-place --repeats 2 --effect drive_lag:lag_s=0.05 \
  --physics time_step_s=0.0005 --out real >/dev/null && kenaf-gap diagnose real --out diagnosis >diagnosis.log' || fail "the diagnosis"
say "diagnosis: $(grep -m1 -oE '(NAMED|NONE|AMBIGUOUS|UNKNOWN).*' "$root$home/diagnosis.log")"
serve http:// 'kenaf-gap play real --report diagnosis'
say "playback: $(fetch http://127.0.0.1:8080/ playback.js three.module.js OrbitControls.js) files served"
end_server

if [ -x "$root/usr/bin/operator_console" ]; then
  as_user 'kenaf-relayd --embedded --view off --cameras off --world step-200 >relayd.log 2>&1 & relayd=$!
    until grep -qs "listening on" relayd.log; do sleep 0.2; done
    operator_control_sim >control.log 2>&1 & control=$!
    until grep -qs "listening on" control.log; do sleep 0.2; done
    operator_console --script /usr/share/doc/kenaf/teleop/step_200.script >console.log; status=$?
    kill $control $relayd; wait; exit $status' || { cat "$root$home/console.log"; fail "the operator's script"; }
  say "operator: $(tail -n 1 "$root$home/console.log")"
fi

# The services. A systemd that is not the machine's first process runs none, so one is played: enabling is that of the real
# systemctl, which needs no running one; starting, stopping and asking are done here, by the unit's own command.
mv "$root/usr/bin/systemctl" "$root/usr/bin/systemctl.real"
cat >"$root/usr/bin/systemctl" <<'SYSTEMCTL'
#!/bin/sh
echo "$*" >>/var/log/systemctl
action= units=
for word; do
  case $word in
    -*) ;;
    *) if [ -z "$action" ]; then action=$word; else units="$units $word"; fi ;;
  esac
done
status=0
for unit in $units; do
  pid=$(cat "/run/$unit.pid" 2>/dev/null)
  case $action in
    stop | restart | start)
      if [ "$action" != start ] && [ -n "$pid" ]; then
        kill "$pid"; while kill -0 "$pid" 2>/dev/null; do sleep 0.1; done
        rm "/run/$unit.pid"; pid=
      fi
      if [ "$action" != stop ] && [ -z "$pid" ]; then
        command=$(sed -n 's/^ExecStart=\([^ ]*\).*/\1/p' "/usr/lib/systemd/system/$unit")
        setsid setpriv --reuid=nobody --regid=nogroup --clear-groups "$command" >"/var/log/$unit" 2>&1 </dev/null & echo $! >"/run/$unit.pid"
      fi ;;
    is-active) [ -n "$pid" ] && kill -0 "$pid" 2>/dev/null || status=3 ;;
    *) exec systemctl.real "$@" ;;
  esac
done
[ "$action" != daemon-reload ] || exit 0
exit $status
SYSTEMCTL
chmod 755 "$root/usr/bin/systemctl"
mkdir -p "$root/run/systemd/system"
as_root() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "$@"; }
quietly() { as_root "$@" >"$root/said" 2>&1 || { cat "$root/said"; fail "$*"; }; }
is_running() { [ -e "$root/run/$1.service.pid" ] && kill -0 "$(cat "$root/run/$1.service.pid")" 2>/dev/null; }
kenaf_debs() { (cd "$root" && ls -d ./new/{libkenaf[0-9],libkenaf-dev,kenaf-data,kenaf,kenaf-operator}_*.deb); }

said=$(as_root systemd-analyze --man=no verify kenaf-world.service kenaf-relayd.service 2>&1 | grep kenaf || true)
[ -z "$said" ] || fail "systemd-analyze: $said"
! is_running kenaf-world || fail "the installation started a service that nobody enabled"
quietly systemctl enable kenaf-world.service kenaf-relayd.service
quietly systemctl start kenaf-world.service kenaf-relayd.service
for unit in kenaf-world kenaf-relayd; do is_running "$unit" || fail "$unit does not start"; done
before=$(cat "$root/run/kenaf-world.service.pid")
# shellcheck disable=SC2046  # a word for each package
quietly apt-get -qq install --no-install-recommends $(kenaf_debs)
is_running kenaf-world && [ "$(cat "$root/run/kenaf-world.service.pid")" != "$before" ] || fail "the upgrade did not restart kenaf-world"
say "services: enabled, started; restarted by the upgrade to $(as_root dpkg-query -W -f '${Version}' kenaf)"
quietly apt-get -qq remove kenaf
! is_running kenaf-world && ! is_running kenaf-relayd || fail "a service runs on after the removal of its package"
[ "$(readlink "$root/etc/systemd/system/kenaf-world.service")" = /dev/null ] || fail "the removed service is not masked"
quietly apt-get -qq install --no-install-recommends "$(kenaf_debs | grep /kenaf_)"
is_running kenaf-world && is_running kenaf-relayd || fail "installed again, what was enabled is not started"
say "services: stopped by the removal of the package, started by its return"
quietly apt-get -qq purge kenaf kenaf-data libkenaf-dev kenaf-operator 'libkenaf[0-9]'
left=$(cd "$root" && find etc var/lib usr -name '*kenaf*' -not -path 'var/lib/dpkg/*' -not -path 'var/lib/apt/*')
[ -z "$left" ] || fail "purging left $left"
say "purged: nothing is left"
