#!/bin/sh
# The manual pages are clean mdoc.
cd "${srcdir:-$(dirname "$0")/..}" || exit 1
if ! command -v mandoc >/dev/null 2>&1; then
    echo "SKIP man: mandoc is not installed"
    exit 77
fi
mandoc -T lint -W warning man/*.[1-9]
