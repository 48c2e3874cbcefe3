#!/bin/bash
# Process 1 of the virtual machine, in the host's files: runs the command and leaves its output and exit status in the
# folder that the host shares with it. Usage, by init: session.sh BUS_UP DIRECTORY
bus_up=$1 directory=$2
vcan=/run/vcan
PATH=/usr/sbin:/usr/bin:/sbin:/bin
ln -s /proc/self/fd /dev/fd
ln -s fd/0 /dev/stdin; ln -s fd/1 /dev/stdout; ln -s fd/2 /dev/stderr

mapfile -d '' environment <"$vcan/control/environment"
mapfile -d '' arguments <"$vcan/control/arguments"
rm "$vcan/control/environment"   # nothing of it shall stay on the host's disk

# Pipes, so that a program may open /dev/stderr again as it may elsewhere; one cat each writes through to the host.
mkfifo "$vcan/out" "$vcan/err"
cat <"$vcan/out" >"$vcan/control/stdout" & copiers=($!)
cat <"$vcan/err" >"$vcan/control/stderr" & copiers+=($!)

# Not passed on: the way that led into this machine, which has ways of its own; a TMPDIR that is read-only here.
(
  cd "$directory" 2>/dev/null || { echo "with-vcan: the machine cannot see the working directory $directory" >&2; exit 125; }
  exec env -i "${environment[@]}" env -u KENAF_VCAN_WAY -u TMPDIR "$bus_up" "${arguments[@]}"
) </dev/null >"$vcan/out" 2>"$vcan/err"
status=$?

# What the command left running ends with it; it would keep the pipes open. Again and again, because it may fork.
while kill -0 "${copiers[@]}"; do
  for process in /proc/[0-9]*; do
    case " 1 ${copiers[*]} " in *" ${process#/proc/} "*) ;; *) kill -KILL "${process#/proc/}" ;; esac
  done
  sleep 0.02
done 2>/dev/null

echo "$status" >"$vcan/control/status"
"$vcan/busybox" reboot -f
