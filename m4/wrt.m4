dnl Checks that collect what is missing instead of stopping at the first gap, so that one run of
dnl configure names every package to install.

m4_ifndef([PKG_PROG_PKG_CONFIG],
  [m4_fatal([pkg.m4 was not found: install pkg-config, then run autoreconf again])])

dnl WRT_MISSING(NEED): remember that the row NEED of build-aux/packages.md is missing.
AC_DEFUN([WRT_MISSING], [wrt_missing="$wrt_missing $1"])

dnl WRT_PKG(VAR, NEED, MODULE, [IF-FOUND], [IF-NOT = WRT_MISSING(NEED)]): a library known to pkg-config.
AC_DEFUN([WRT_PKG],
  [PKG_CHECK_MODULES([$1], [$3], [$4], [m4_default([$5], [WRT_MISSING([$2])])])])

dnl WRT_TOOL(VAR, NEED, NAMES, PATTERN): the first of NAMES whose --version matches the extended regular
dnl expression PATTERN.  A value given by the user is checked like any other.
AC_DEFUN([WRT_TOOL],
  [AC_ARG_VAR([$1], [$2 command])
  AC_CACHE_CHECK([for a usable $2], [wrt_cv_prog_$1],
    [wrt_cv_prog_$1=no
    for wrt_try in ${$1-$3}; do
      AS_IF([$wrt_try --version 2>/dev/null | sed 1q | grep -E '$4' >/dev/null],
        [wrt_cv_prog_$1=$wrt_try; break])
    done])
  AS_IF([test "x$wrt_cv_prog_$1" = xno], [WRT_MISSING([$2]); $1=$2], [$1=$wrt_cv_prog_$1])])

dnl WRT_TRY_FLAG(VAR, FLAG): add FLAG to VAR when the current language's compiler takes it in silence.
AC_DEFUN([WRT_TRY_FLAG],
  [AS_VAR_PUSHDEF([wrt_ok], [wrt_cv_[]_AC_LANG_ABBREV[]_flag_$2])
  AC_CACHE_CHECK([whether the _AC_LANG compiler takes $2], [wrt_ok],
    [wrt_save=$_AC_LANG_PREFIX[]FLAGS
    _AC_LANG_PREFIX[]FLAGS="$_AC_LANG_PREFIX[]FLAGS -Werror $2"
    AC_COMPILE_IFELSE([AC_LANG_SOURCE([[extern int wrt_unit; int wrt_unit;]])],
      [AS_VAR_SET([wrt_ok], [yes])], [AS_VAR_SET([wrt_ok], [no])])
    _AC_LANG_PREFIX[]FLAGS=$wrt_save])
  AS_VAR_IF([wrt_ok], [yes], [AS_VAR_APPEND([$1], [" $2"])])
  AS_VAR_POPDEF([wrt_ok])])

dnl WRT_TRY_FLAGS(VAR, FLAGS)
AC_DEFUN([WRT_TRY_FLAGS], [m4_foreach_w([wrt_flag], [$2], [WRT_TRY_FLAG([$1], m4_dquote(wrt_flag))
])])

dnl WRT_REPORT_MISSING: stop with one table if anything was missing.
AC_DEFUN([WRT_REPORT_MISSING],
  [AS_IF([test -n "$wrt_missing"],
    [AS_ECHO(["configure: missing:
"]) >&2
    awk -F' *[[|]] *' -v missing="$wrt_missing" '
      BEGIN { n = split(missing, m, " "); for (i = 1; i <= n; i++) want[[m[i]]] = 1 }
      NR == 1 || $[2] in want { printf "  %-12s %-18s %-20s %s\n", $[2], $[4], $[5], $[6] }
    ' "$srcdir/build-aux/packages.md" >&2
    AC_MSG_ERROR([install these packages and run configure again])])])
