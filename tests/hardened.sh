#!/bin/sh
# The program is built as SECURITY.md says: where it lies is chosen when it starts, its relocations
# are done and read-only by then, stacks and buffers are checked.
set -u
WRT=${WRT:-build/wrt}
if ! grep -q '^WRT_HARDEN_LDFLAGS = -pie' "$(dirname "$WRT")/Makefile" 2>/dev/null; then
    echo "hardened: built without: skipped"
    exit 77
fi
if ! command -v readelf >/dev/null 2>&1; then
    echo "hardened: no readelf: skipped"
    exit 77
fi
failed=0
# holds OPTION PATTERN WHAT
holds()
{
    readelf -W "$1" "$WRT" 2>/dev/null | grep -qE "$2" || { echo "$WRT: $3"; failed=1; }
}
holds -h 'Type:.*DYN' 'is not position-independent'
holds -l 'GNU_RELRO' 'has relocations that stay writable'
holds -d 'BIND_NOW|FLAGS_1.*NOW' 'binds functions late'
holds --dyn-syms '__stack_chk_fail' 'does not check its stack'
holds --dyn-syms '_chk@' 'does not check buffers'
readelf -W -l "$WRT" | grep -E 'GNU_STACK' | grep -q 'RWE' && { echo "$WRT: has a stack that can be run"; failed=1; }
exit $failed
