#!/bin/sh
# Every mistake is told near its place, and once: scenes with one token changed.
#
#   mutants.sh [--full]      --full: more of them
set -u
cd "${srcdir:-$(dirname "$0")/..}" || exit 1
mutants=${MUTANTS:-$(dirname "${WRT:-build/wrt}")/tests/property/mutants}
count=5000
[ "${1-}" = --full ] && count=50000
for format in xml wrt; do
    case $format in xml) scenes=scenes/*.xml ;; wrt) scenes=examples/*.wrt ;; esac
    # shellcheck disable=SC2086 # a list of files
    "$mutants" $count $scenes || exit 1
done
