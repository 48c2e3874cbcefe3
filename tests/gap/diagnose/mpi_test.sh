#!/bin/bash
# Two processes make the same diagnosis as one, bit for bit.
# usage: mpi_test.sh KENAF_GAP KENAF_GAP_MPI
set -euo pipefail
gap=$1 gap_mpi=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$gap" simulate --manoeuvre straight-fast --manoeuvre drop --repeats 2 --effect drive_lag:lag_s=0.05 --out "$folder/real" >/dev/null
# a part of the catalogue: what is shared out is the same, and less of it
few=(--no-next --without battery_sag,flipper_lag,flipper_backlash,flipper_compliance,flipper_torque_limit,roll_inertia,com_left,com_up)
few+=(--without slip_with_speed,rolling_resistance,lug_height,ground_slope,ground_bank,posture_bias,posture_scale,posture_mount)
# into folders of one name, as a report says how to play what is in it
mkdir "$folder/one" "$folder/two"
(cd "$folder/one" && "$gap" diagnose "$folder/real" --out report --jobs 1 "${few[@]}" >../one.txt)
# as root, in a container and on fewer cores than processes too
(cd "$folder/two" && OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
    mpirun --oversubscribe -n 2 "$gap_mpi" diagnose "$folder/real" --out report --jobs 1 "${few[@]}" >../two.txt)
cmp "$folder/one/report/report.json" "$folder/two/report/report.json"
cmp "$folder/one/report/report.html" "$folder/two/report/report.html"
head -n 1 "$folder/one.txt"
[ "$(head -n 1 "$folder/one.txt")" = "$(head -n 1 "$folder/two.txt")" ]
