#!/bin/sh
# SPDX-FileCopyrightText: 2026 The lift monitor authors
# SPDX-License-Identifier: Apache-2.0
#
# Print the path of a Python 3.11, 3.12 or 3.13 that can make a virtual environment and compile
# extensions; PYTHON in the environment overrides the search. Every place in PATH is tried,
# as a version manager's launcher may come first and refuse to start.

probe='import sys
if not (3, 11) <= sys.version_info[:2] <= (3, 13): sys.exit(2)
import os, sysconfig
version = "%d.%d" % sys.version_info[:2]
missing = []
try:
    import ensurepip, venv
except ImportError:
    missing.append("python%s-venv" % version)
if not os.path.exists(os.path.join(sysconfig.get_path("include"), "Python.h")):
    missing.append("python%s-dev" % version)
if missing:
    print(" ".join(missing)); sys.exit(3)
print(os.path.realpath(sys.executable))'

if [ -n "$PYTHON" ]; then
    found=$("$PYTHON" -I -c "$probe" 2>/dev/null)
    case $? in
        0) echo "$found"; exit 0 ;;
        3) echo "PYTHON=$PYTHON lacks parts; install: apt install $found" >&2 ;;
        *) echo "PYTHON=$PYTHON is not a working Python 3.11, 3.12 or 3.13" >&2 ;;
    esac
    exit 1
fi

incomplete=
for name in python3.12 python3.11 python3.13 python3; do
    old_ifs=$IFS
    IFS=:
    for directory in $PATH; do
        IFS=$old_ifs
        [ -x "$directory/$name" ] || continue
        found=$("$directory/$name" -I -c "$probe" 2>/dev/null)
        case $? in
            0) echo "$found"; exit 0 ;;
            3) incomplete="${incomplete:-$directory/$name lacks parts; install: apt install $found}" ;;
        esac
    done
    IFS=$old_ifs
done
echo "${incomplete:-no Python 3.11, 3.12 or 3.13 found; install: apt install python3 python3-venv python3-dev}" >&2
exit 1
