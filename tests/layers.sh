#!/bin/sh
# The house's walls: each layer includes only itself and the layers before it, src/cmd alone prints
# and exits, and no two files share a name.  Every offence is printed as file:line.
set -u
cd "${srcdir:-$(dirname "$0")/..}" || exit 1

order='base diag math image ast schema syntax eval validate print scene lower convert accel render farm lint lsp cmd'
sources=$(find src grammar -type f \( -name '*.[chly]' -o -name '*.cc' -o -name '*.def' -o -name '*.inc' \) |
    grep -vE '\.(tab|lex)\.[ch]$' | sort)
if [ -z "$sources" ]; then
    echo "layers: no sources found in $(pwd)"
    exit 1
fi

# The program below reads every file once.  Comments and string literals are blanked before a line is
# searched for calls, so that text about printf() is not taken for one.
# shellcheck disable=SC2086 # one word per file: names hold no blanks
awk -v order="$order" '
    function layer_of(path)
    {
        if (path ~ /^grammar\//)
            return path ~ /\/wrl\./ ? "convert" : "syntax"
        sub(/^src\//, "", path)
        return path ~ /\// ? substr(path, 1, index(path, "/") - 1) : ""
    }
    function offence(text)
    {
        printf "%s:%d: %s\n", FILENAME, FNR, text
        bad++
    }
    function code_of(line,    out, at)
    {
        gsub(/\\["\\]|\047"\047/, "", line)
        gsub(/"[^"]*"/, "\"\"", line)
        out = ""
        while (line != "") {
            if (in_comment) {
                at = index(line, "*/")
                if (!at)
                    return out
                line = substr(line, at + 2)
                in_comment = 0
            } else {
                at = match(line, /\/\*|\/\//)
                if (!at)
                    return out line
                out = out substr(line, 1, at - 1)
                if (substr(line, at, 2) == "//")
                    return out
                line = substr(line, at + 2)
                in_comment = 1
            }
        }
        return out
    }
    BEGIN {
        n = split(order, name, " ")
        for (i = 1; i <= n; i++)
            rank[name[i]] = i
        call = "(^|[^a-zA-Z0-9_])(v?printf|puts|putchar|perror|psignal|_?exit|_Exit|quick_exit)[ \t]*[(]"
        stream = "[^a-zA-Z0-9_](v?fprintf|fputs|fputc|putc|fwrite)[ \t]*[(].*std(out|err)"
    }
    FNR == 1 {
        in_comment = 0
        mine = layer_of(FILENAME)
        if (!(mine in rank))
            offence("file is in no layer")
    }
    /^[ \t]*#[ \t]*include[ \t]*"/ {
        target = $0
        sub(/^[^"]*"/, "", target)
        sub(/".*/, "", target)
        if (target == "config.h")
            next
        theirs = layer_of(target ~ /^grammar\// ? target : "src/" target)
        if (!(theirs in rank))
            offence("include \"" target "\" names no layer (write \"layer/file.h\")")
        else if (mine in rank && rank[theirs] > rank[mine])
            offence("layer " mine " includes \"" target "\" of the later layer " theirs)
    }
    mine != "cmd" && FILENAME != "src/base/mem.c" {
        code = " " code_of($0)
        if (code ~ call || code ~ stream || code ~ /std::c(out|err|log)/)
            offence("only src/cmd prints and exits")
    }
    # the files of src/farm are named on the command line
    mine != "cmd" && mine != "base" && mine != "farm" && code_of($0) ~ /(^|[^a-zA-Z0-9_])(file_read|fopen|openat)[ \t]*[(]/ {
        offence("only src/cmd and src/farm read without a fence: file_read_within()")
    }
    END { exit bad > 0 }
' $sources
status=$?

twice=$(printf '%s\n' "$sources" | sed 's:.*/::' | sort | uniq -d)
for name in $twice; do
    printf '%s\n' "$sources" | sed -n "/\\/$name\$/s/\$/:1: file name is not unique/p"
    status=1
done
exit $status
