# Sourced by cases with big inputs: `fill TEXT` repeats a text until there are $big bytes, which is
# 20 MB, 100 MB with WRT_FULL set, and less where checks slow the program down.  The program gets
# 3 GB of memory.
if [ -z "$WRT_WRAPPER" ] && (ulimit -v 3000000 && ASAN_OPTIONS= "$WRT" --version; exit $?) >/dev/null 2>&1; then
    big=${WRT_FULL:+100000000}
    big=${big:-20000000}
    ulimit -v 3000000
else
    big=2000000
fi

fill()
{
    yes -- "$1" | tr -d '\n' | head -c $big
}
