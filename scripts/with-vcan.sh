#!/usr/bin/env bash
# Runs a command beside a CAN bus: two virtual CAN interfaces, vcan0 and vcan1, up, for classic CAN.
#
#   scripts/with-vcan.sh [OPTION...] COMMAND [ARG...]
#   scripts/with-vcan.sh --check
#
#   --check            say which way would be taken, and why, and end
#   --way WAY          direct, kvm or tcg instead of the first of them that works; also KENAF_VCAN_WAY
#   --timeout SECONDS  stop the command after so long, default 600; also KENAF_VCAN_TIMEOUT
#   --camera           there is a camera too: a V4L2 device of the kernel's virtual driver vivid, a webcam with a test pattern
#   --writable DIR     the command may write below DIR, which must exist; any number of times
#
# direct: a network namespace of its own on this kernel. kvm, tcg: a small virtual machine with Debian's kernel, by the
# processor or emulated, that sees this machine's files under the same paths, read-only but for DIR and a copy of /tmp
# that is dropped at the end. Either way the command is root there, has the environment and the working directory of
# the caller, and no network but loopback and the bus. docs/can-tools.md tells more.
#
# Exit status: the command's; 124: stopped by --timeout; 125: the bus or the machine could not be made.
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/vcan
caller_path=$PATH
PATH=$PATH:/usr/sbin:/sbin   # ip and depmod, which the PATH of a normal user lacks

fail() { printf 'with-vcan: %s\n' "$*" >&2; exit 125; }
usage() { sed -n '2,/^set /{/^set /d;s/^# \{0,1\}//p}' "${BASH_SOURCE[0]}"; }

check='' camera='' way=${KENAF_VCAN_WAY:-auto} limit_s=${KENAF_VCAN_TIMEOUT:-600} writable=()
while [ $# -gt 0 ]; do
  case $1 in
    --check) check=1; shift ;;
    --camera) camera=1; shift ;;
    --help|-h) usage; exit 0 ;;
    --way|--timeout|--writable)
      [ $# -ge 2 ] || fail "$1 needs a value"
      case $1 in
        --way) way=$2 ;;
        --timeout) limit_s=$2 ;;
        --writable) writable+=("$(cd "$2" 2>/dev/null && pwd -P)") || fail "--writable $2: no such folder" ;;
      esac
      shift 2 ;;
    --) shift; break ;;
    -*) usage >&2; fail "there is no option $1" ;;
    *) break ;;
  esac
done
case $way in auto|direct|kvm|tcg) ;; *) fail "the way '$way' is none of auto, direct, kvm, tcg" ;; esac
[[ $limit_s =~ ^[1-9][0-9]{0,5}$ ]] || fail "--timeout '$limit_s' is not a number of seconds from 1 to 999999"
[ -n "$check" ] || [ $# -gt 0 ] || { usage >&2; fail "no command"; }

# ---- direct ----

# The command that enters a network namespace of its own; who is not root becomes root in a user namespace for it.
own_network=(unshare --net)
[ "$(id -u)" = 0 ] || own_network+=(--map-root-user)

# Whether this kernel gives us virtual CAN interfaces and both kinds of CAN sockets; its words where it does not.
# 29 is AF_CAN; (3, 1) SOCK_RAW, CAN_RAW; (2, 2) SOCK_DGRAM, CAN_BCM: <linux/can.h>.
try_direct() {
  [ -z "$camera" ] || grep -qs '^vivid' /sys/class/video4linux/*/name ||
    modprobe vivid n_devs=1 node_types=1 num_inputs=1 input_types=0 2>/dev/null ||
    { echo "this kernel gives this user no vivid (a virtual camera)"; return 1; }
  command -v ip >/dev/null || { echo "there is no ip (package iproute2)"; return 1; }
  "${own_network[@]}" -- sh -c 'ip link add vcan0 type vcan && exec perl -e "$1"' sh '
    socket(my $raw, 29, 3, 1) or die "CAN_RAW sockets: $!\n";
    socket(my $bcm, 29, 2, 2) or die "CAN_BCM sockets: $!\n"' 2>&1
}

run_direct() {
  local status=0 started_s=$SECONDS
  PATH=$caller_path timeout --kill-after=10 "$limit_s" "${own_network[@]}" -- "$here/bus-up.sh" "$@" </dev/null || status=$?
  if [ "$status" -ge 124 ] && [ $((SECONDS - started_s)) -ge "$limit_s" ]; then
    printf 'with-vcan: the command did not end within %s s and was stopped\n' "$limit_s" >&2
    status=124
  fi
  exit "$status"
}

# ---- in a virtual machine ----

# The arguments of qemu that every start of the machine shares. A q35 has an HPET: without one the emulated machine's
# clock would count ticks of 4 ms. A reset ends it (-no-reboot), which is quicker than powering off.
#
# An emulated processor's clock counts its instructions, 1 ns each, and follows the clock on the wall only while it idles: inside,
# the machine is as quick as a real one, however slowly it is emulated and whatever else runs here.
machine_arguments() {
  local accelerator=$1 init=$2 processor=(-accel kvm -smp 2)
  [ "$accelerator" = kvm ] || processor=(-accel tcg,thread=single -smp 1 -icount shift=0,sleep=on -rtc clock=vm)
  machine=(qemu-system-x86_64 "${processor[@]}" -machine q35 -cpu max -m 1G
    -nodefaults -no-user-config -display none -no-reboot
    -kernel "$kernel/vmlinux" -initrd "$kernel/initramfs.cpio"
    -append "console=ttyS0 quiet panic=-1 reboot=t nokaslr mitigations=off audit=0 random.trust_cpu=on
             8250.nr_uarts=1 pci=lastbus=0 rdinit=$init${camera:+ kenaf.camera}")
}

# Whether the processor really runs the machine: /dev/kvm may be there, and yet a hypervisor below emulate too little.
# Tried once per boot of this machine; the answer is kept beside the kernel.
try_kvm() {
  [ -r /dev/kvm ] && [ -w /dev/kvm ] || { echo "/dev/kvm is not there, or not for this user"; return 1; }
  local answer log pid
  answer=$kernel/kvm-$(cat /proc/sys/kernel/random/boot_id)-$(id -u)
  if [ ! -e "$answer" ]; then
    log=$(mktemp "$kernel/kvm-log.XXXXXX")
    machine_arguments kvm /probe
    timeout --kill-after=1 5 "${machine[@]}" -serial stdio >"$log" 2>&1 </dev/null & pid=$!
    while kill -0 "$pid" 2>/dev/null && ! grep -q 'KVM internal error' "$log"; do sleep 0.05; done
    kill "$pid" 2>/dev/null
    wait "$pid" 2>/dev/null
    rm -f "$kernel"/kvm-*-"$(id -u)"
    if grep -q 'kvm works' "$log"; then echo yes >"$answer"; else echo no >"$answer"; fi
    rm -f "$log"
  fi
  [ "$(cat "$answer")" = yes ] || { echo "/dev/kvm is there, but the machine does not start with it"; return 1; }
}

stop_machine() {
  [ -z "${machine_pid:-}" ] || kill "$machine_pid" 2>/dev/null
  wait
  rm -rf "$control"
}

run_in_machine() {
  local accelerator=$1 directory index=0; shift
  local shares=() followers=()
  control=$(mktemp -d "${TMPDIR:-/tmp}/with-vcan.XXXXXX") || fail "cannot make a temporary folder"
  trap stop_machine EXIT
  trap 'exit 130' INT
  trap 'exit 143' TERM HUP

  # What the machine shall run, NUL-separated: any bytes pass.
  PATH=$caller_path env -0 >"$control/environment"
  printf '%s\0' "$@" >"$control/arguments"
  printf '%s\0' "$here/bus-up.sh" "$here/session.sh" "$PWD" >"$control/session"
  : >"$control/stdout"; : >"$control/stderr"; : >"$control/writable"
  share() {   # TAG FOLDER [OPTION]
    shares+=(-fsdev "local,id=$1,path=${2//,/,,},security_model=none,multidevs=remap${3:-}"
             -device "virtio-9p-pci,fsdev=$1,mount_tag=$1")
  }
  share root / ,readonly=on
  share control "$control"
  for directory in "${writable[@]}"; do
    share "writable$index" "$directory"
    printf 'writable%d %s\n' "$((index++))" "$directory" >>"$control/writable"
  done

  machine_arguments "$accelerator" /init
  # setpriv: the machine ends with this script, also where the script is killed.
  setpriv --pdeathsig TERM timeout --kill-after=10 "$limit_s" "${machine[@]}" "${shares[@]}" \
    -serial "file:$control/console" >"$control/qemu" 2>&1 </dev/null & machine_pid=$!
  tail --follow --bytes=+1 --sleep-interval=0.05 --pid="$machine_pid" "$control/stdout" & followers+=($!)
  tail --follow --bytes=+1 --sleep-interval=0.05 --pid="$machine_pid" "$control/stderr" >&2 & followers+=($!)
  local machine_status=0
  wait "$machine_pid" || machine_status=$?
  machine_pid=''
  wait "${followers[@]}"

  [ ! -s "$control/status" ] || exit "$(cat "$control/status")"
  if [ "$machine_status" = 124 ] || [ "$machine_status" = 137 ]; then
    printf 'with-vcan: the command did not end within %s s and was stopped\n' "$limit_s" >&2
    exit 124
  fi
  { cat "$control/qemu"; tail -n 30 "$control/console"; } >&2 2>/dev/null
  fail "the virtual machine ended (qemu: status $machine_status) before the command did; its last words are above"
}

# ---- the first way that works ----

refused=''
if [ "$way" = auto ] || [ "$way" = direct ]; then
  if words=$(try_direct); then
    [ -z "$check" ] || { echo "direct: this kernel makes virtual CAN interfaces"; exit 0; }
    run_direct "$@"
  fi
  refused="not direct: ${words//$'\n'/; }"
  [ "$way" = auto ] || fail "$refused"
fi

kernel=$("$here/machine.sh") || fail "${refused:+$refused; and }no virtual machine: the reason is above"
if [ "$way" != tcg ]; then
  if words=$(try_kvm); then
    way=kvm
  else
    refused+="${refused:+; }not kvm: $words"
    [ "$way" = auto ] || fail "$refused"
    way=tcg
  fi
fi
[ -z "$check" ] || { echo "$way: a virtual machine with $(basename "$kernel")${refused:+ ($refused)}"; exit 0; }
run_in_machine "$way" "$@"
