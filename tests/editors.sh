#!/usr/bin/env bash
# Vim's and TextMate's highlighting and the completion of the shells know what the program knows:
# keywords, kinds, properties, words and functions from the tables, commands and options from `wrt
# --help`.  Each file is made anew between its marks and must come out as it is; then bash completes,
# and Vim highlights.
#
#   editors.sh [--update]
set -u
export LC_ALL=C
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$here" || exit 1
WRT=${WRT:-build/wrt}
failed=0
complain()
{
    echo "editors: $1"
    failed=1
}

# ---- what there is, a word a line ---------------------------------------------------------------

keywords() { sed -n 's/^"\([a-z]*\)" .*return TOKEN_.*/\1/p' grammar/native.l | grep -vxE 'true|false'; }
kinds() { sed -n 's/^KIND([^"]*"\([^"]*\)".*/\1/p' src/schema/schema.def; }
kind_words() { kinds | tr ' ' '\n' | sort -u; }
properties() { sed -n 's/^PROP([^"]*"\([^"]*\)".*/\1/p' src/schema/schema.def | sort -u; }
functions() { sed -n 's/^FUNCTION(\([a-z0-9]*\),.*/\1/p' src/eval/functions.def; }
# the words that properties take, and the models; kinds stay kinds
words()
{
    {
        printf '%s\n' classic modern
        sed -n 's/.*\.words = "\([^"]*\)".*/\1/p' src/schema/schema.def | tr ' ' '\n' | sed 's/=.*//'
    } | sort -u | grep -vxF "$(kind_words)"
}
codes() { sed -n 's/^DIAG([^"]*"\([^"]*\)", "\([^"]*\)".*/\1\n\2/p' src/diag/diag.def; }
rules()
{
    local id name
    sed -n 's/^GROUP(\([A-Z]*\), "\([^"]\{1,\}\)".*/\1 \2/p' src/diag/groups.def |
        while read -r id name; do # a group without rules is not known yet
            grep -q "^DIAG(.*\", $id, " src/diag/diag.def && echo "$name"
        done
    sed -n '/DIAG_ERROR/!s/^DIAG([^"]*"[^"]*", "\([^"]*\)".*/\1/p' src/diag/diag.def
    echo all
}
# "name<tab>summary" of each command
commands() { "$WRT" --help | awk '/^commands:/ { on = 1; next } !NF { on = 0 } on { s = $0; sub(/^.*[^ ]  +/, "", s); print $1 "\t" s }'; }
# "letter<tab>name<tab>argument<tab>help" of each option of a command, `.` for what it does not have;
# an argument in brackets may be left out; formats that only some builds have are not told
options()
{
    "$WRT" "$1" --help | sed 's/, \.pfm and \.exr/ and .pfm/; s/, 32 or 16 in \.exr//' | awk '
        /^options:/ { on = 1; next }
        !NF { on = 0 }
        on {
            letter = substr($0, 3, 2) ~ /^-/ ? substr($0, 3, 2) : "."
            rest = substr($0, 7)
            at = match(rest, /  +/)
            left = substr(rest, 1, at - 1); help = substr(rest, at + RLENGTH)
            argument = "."
            if (at = match(left, /[ [].*/)) { argument = substr(left, at); left = substr(left, 1, at - 1); sub(/^ /, "", argument) }
            print letter "\t" left "\t" argument "\t" help
        }'
}
# what an option takes: words, FILE, DIR, RULES or ANY
values()
{
    case $1 in
    --output) echo FILE ;;
    --include) echo DIR ;;
    --show) echo normals depth ids samples ;;
    --accel) echo none ;;
    --isa) echo plain generic avx2 avx512 ;;
    --to) echo xml wrt json pov tachyon ;;
    --format) echo text json sarif ;;
    --warn | --no-warn) echo RULES ;;
    *) echo ANY ;;
    esac
}

line() { tr '\n' ' ' | sed 's/ *$//'; }
pattern() { tr '\n' '|' | sed 's/|$//'; }

# ---- what stands between the marks --------------------------------------------------------------

part_vim()
{
    case $1 in
    keywords) echo "syntax keyword wrtKeyword $(keywords | line)" ;;
    kinds) echo "syntax keyword wrtKind $(kind_words | line)" ;;
    functions) echo "syntax match wrtFunction /\\v<($(functions | pattern))>\\ze\\s*\\(/" ;;
    words) echo "syntax keyword wrtWord $(words | line)" ;;
    properties) echo "syntax match wrtProperty /\\v<($(properties | pattern))>\\ze\\s*:/" ;;
    esac
}

part_textmate()
{
    case $1 in
    functions) echo "      \"match\": \"\\\\b($(functions | pattern))(?=\\\\s*\\\\()\"," ;;
    properties) echo "      \"match\": \"\\\\b($(properties | pattern))(?=\\\\s*:)\"," ;;
    kinds) echo "      \"match\": \"\\\\b($(kind_words | pattern))\\\\b\"," ;;
    *) echo "      \"match\": \"\\\\b($($1 | pattern))\\\\b\"," ;;
    esac
}

part_bash()
{
    local command letter name
    case $1 in
    commands) echo "_wrt_commands='$(commands | cut -f 1 | line)'" ;;
    options)
        commands | cut -f 1 | while read -r command; do
            echo "    $command) echo '$(options "$command" | awk -F '\t' '{ print $1 != "." ? $1 " " $2 : $2 }' | line)' ;;"
        done
        ;;
    values)
        commands | cut -f 1 | while read -r command; do options "$command"; done | sort -u |
            awk -F '\t' '$3 != "." && $3 !~ /^\[/ { print $1 "\t" $2 }' | sort -u |
            while IFS=$'\t' read -r letter name; do
                [ "$letter" = . ] && letter= || letter="$letter | "
                echo "    $letter$name) echo '$(values "$name")' ;;"
            done
        ;;
    names)
        echo "_wrt_kinds='$(kind_words | line)'"
        echo "_wrt_codes='$(codes | line)'"
        echo "_wrt_rules='error $(rules | line)'"
        ;;
    esac
}

# An option as _arguments takes it.
spec_zsh()
{
    awk -F '\t' -v quote="'" '{
        help = $4
        gsub(/[][]/, "\\\\&", help); gsub(quote, quote "\\" quote quote, help)
        takes = $3 == "." ? "" : $3 ~ /^\[/ ? "=-" : "="
        if ($3 ~ /^\[/) { value = $3; gsub(/[]=[]/, "", value); action = "::" value ":(" value ")" }
        else if ($3 == ".") action = ""
        else action = ":" $3 ":" ($5 == "FILE" ? "_files" : $5 == "DIR" ? "_files -/" : $5 == "ANY" ? "" : $5 == "RULES" ? "($rules)" : "(" $5 ")")
        tail = quote "[" help "]" action quote
        if ($1 == ".") printf "        %s%s%s%s\n", quote, $2, takes, substr(tail, 2)
        else printf "        %s(%s %s)%s{%s%s,%s%s}%s\n", quote, $1, $2, quote, $1, takes == "=" ? "+" : "", $2, takes, tail
    }'
}

part_zsh()
{
    local command name row
    case $1 in
    commands)
        echo "commands=("
        commands | awk -F '\t' -v quote="'" '{ gsub(/:/, "\\:", $2); gsub(quote, quote "\\" quote quote, $2); print "    " quote $1 ":" $2 quote }'
        echo ")"
        ;;
    names)
        echo "kinds=($(kind_words | line))"
        echo "codes=($(codes | line))"
        echo "rules=(error $(rules | line))"
        ;;
    options)
        commands | cut -f 1 | while read -r command; do
            echo "    $command) options=("
            options "$command" | while IFS= read -r row; do
                name=${row#*$'\t'}
                printf '%s\t%s\n' "$row" "$(values "${name%%$'\t'*}")"
            done | spec_zsh
            echo "    ) ;;"
        done
        ;;
    esac
}

# ---- the files ----------------------------------------------------------------------------------

work=$(mktemp -d "${TMPDIR:-/tmp}/wrt-editors.XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT

# make FILE FUNCTION: the file as it should be
make_file()
{
    local text skip=
    while IFS= read -r text; do
        [[ ! $text =~ ^[[:blank:]]*[\"#]' @end'$ ]] || skip=
        case $skip in
        "") printf '%s\n' "$text" ;;
        line) skip= ;;
        esac
        if [[ $text =~ ^[[:blank:]]*[\"#]' @begin '([a-z]+)$ ]]; then
            "$2" "${BASH_REMATCH[1]}"
            skip=all
        elif [[ $text =~ '"comment": "@line '([a-z]+) ]]; then
            "$2" "${BASH_REMATCH[1]}"
            skip=line
        fi
    done <"$1"
}

while read -r file function; do
    make_file "$file" "$function" >"$work/wanted"
    if [ "${1-}" = --update ]; then
        cmp -s "$file" "$work/wanted" || cat "$work/wanted" >"$file"
    elif ! diff -u "$file" "$work/wanted"; then
        complain "$file is older than the tables: run 'make update-docs'"
    fi
done <<'EOF'
share/vim/syntax/wrt.vim part_vim
share/vscode/syntaxes/wrt.tmLanguage.json part_textmate
share/bash-completion/wrt part_bash
share/zsh/_wrt part_zsh
EOF
[ "${1-}" != --update ] || exit 0

# Nothing is missing, however the lists above came about.
while read -r what file; do
    $what >"$work/words"
    [ "$(wc -l <"$work/words")" -ge 5 ] || complain "no $what found"
    while read -r word; do
        grep -qwF -e "$word" "$file" || complain "$file lacks '$word' of the $what"
    done <"$work/words"
done <<'EOF'
keywords share/vim/syntax/wrt.vim
kind_words share/vim/syntax/wrt.vim
properties share/vim/syntax/wrt.vim
functions share/vim/syntax/wrt.vim
keywords share/vscode/syntaxes/wrt.tmLanguage.json
kind_words share/vscode/syntaxes/wrt.tmLanguage.json
properties share/vscode/syntaxes/wrt.tmLanguage.json
functions share/vscode/syntaxes/wrt.tmLanguage.json
EOF
while IFS= read -r name; do
    for file in share/bash-completion/wrt share/zsh/_wrt; do
        grep -qF -e "--$name" $file || complain "$file lacks --$name"
    done
done < <(sed -n 's/^OPT([^"]*"\([^"]*\)".*/\1/p' src/cmd/opts.def)

# The program takes every value that is offered.
while read -r command option list; do
    for value in $(${list:-values "$option"}); do
        "$WRT" "$command" "$option" "$value" --help >/dev/null 2>&1 || complain "wrt $command does not take $option $value"
    done
done <<'EOF'
render --show
render --accel
render --format
render --warn rules
render --no-warn rules
EOF

# ---- bash ---------------------------------------------------------------------------------------

bash -n share/bash-completion/wrt || failed=1
mkdir "$work/files" "$work/files/folder"
touch "$work/files/"{a.xml,b.wrt,c.png,d.wrl}

# completes TEXT WORDS: what bash offers behind the text, in any order
completes()
{
    local got wanted
    got=$(
        cd "$work/files" && . "$here/share/bash-completion/wrt" || exit
        COMP_LINE=$1 COMP_POINT=${#1}
        read -ra COMP_WORDS <<<"${1//=/ = }"
        [[ $1 != *[\ =] ]] || COMP_WORDS+=("")
        COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
        _wrt
        printf '%s\n' "${COMPREPLY[@]}" | sort -u | line
    )
    wanted=$(printf '%s\n' $2 | sort | line)
    [ "$got" = "$wanted" ] || complain "bash: '$1' offers '$got', not '$wanted'"
}
completes 'wrt ' "a.xml b.wrt folder $(commands | cut -f 1 | line)"
completes 'wrt li' 'lint'
completes 'wrt render ' 'a.xml b.wrt folder'
completes 'wrt b' 'b.wrt'
completes 'wrt --sh' '--show'
completes 'wrt render --show ' 'normals depth ids samples'
completes 'wrt render --show=' 'normals depth ids samples'
completes 'wrt render --show=no' 'normals'
completes 'wrt --format=json check ' 'a.xml b.wrt folder'
completes 'wrt -o lint' ''
completes 'wrt -o c' 'c.png'
completes 'wrt render -I ' 'folder'
completes 'wrt render -s ' ''
completes 'wrt lint --fi' '--fix'
completes 'wrt check --fi' ''
completes 'wrt lint -W geo' 'geometry'
completes 'wrt doc cyl' 'cylinder'
completes 'wrt explain E10' "$(codes | grep '^E10' | line)"
completes 'wrt uv ' 'd.wrl folder'
completes 'wrt lsp ' ''
completes 'wrt lsp --' '--warn --no-warn --include --max-objects --max-memory --restrict --help --version'

# ---- the others, where they are installed -------------------------------------------------------

# JSON is read by whatever reads it.
if command -v python3 >/dev/null 2>&1; then
    for file in share/vscode/*.json share/vscode/syntaxes/*.json; do
        python3 -m json.tool "$file" >/dev/null || complain "$file is no JSON"
    done
fi

# highlights PATTERN GROUP: the first place of the pattern in the scene below
if command -v vim >/dev/null 2>&1 && vim --version | grep -q '+syntax'; then
    cat >"$work/scene.wrt" <<'EOF'
wrt 1
// a comment; wrt: allow(all)
let turn = sin(30deg) + 0.5e-3
sphere ball { radius: turn  material: gold }
light area { falloff: inverse_square }
let name = "it's \u{41}"
EOF
    cat >"$work/ask.vim" <<'EOF'
set nocompatible
syntax on
redir! > colours
for [line, column] in [[1, 1], [2, 5], [2, 20], [3, 12], [3, 16], [3, 25], [4, 1], [4, 15], [4, 23], [5, 7], [5, 25], [6, 14], [6, 19]]
  echo synIDattr(synID(line, column, 1), "name")
endfor
redir END
qall!
EOF
    (cd "$work" && timeout 20 vim -es -u NONE --cmd "set runtimepath^=$here/share/vim" --cmd 'filetype plugin on' \
        scene.wrt -S ask.vim </dev/null >/dev/null 2>&1)
    got=$(line <"$work/colours" | tr -s ' ' | sed 's/^ //')
    wanted='wrtKeyword wrtComment wrtAllow wrtFunction wrtNumber wrtNumber wrtKind wrtProperty wrtKind wrtWord wrtString wrtEscape'
    [ "$got" = "$wanted" ] || complain "vim: the colours are '$got', not '$wanted'"
else
    echo "editors: Vim is not installed, so its colours are not tried"
fi
if command -v zsh >/dev/null 2>&1; then
    zsh -n share/zsh/_wrt || complain "share/zsh/_wrt does not parse"
else
    echo "editors: zsh is not installed, so its completion is not parsed"
fi
exit $failed
