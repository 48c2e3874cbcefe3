#!/usr/bin/env bash
# The short tests on a bus, one after another, since a virtual machine takes longer to start than each of them:
# short_tests.sh BIN_DIR
set -eu
here=$(dirname "$(realpath "$0")")
bin=$1
"$here/bus_test.sh" "$bin/can_probe"
"$here/candrives_test.sh" "$bin/kenaf-candrives"
"$here/real_library_test.sh" "$bin/square_real"
"$here/operator_test.sh" "$bin"
"$here/camera_test.sh" "$bin" "$here/../../../share/robots/kenaf.toml"
