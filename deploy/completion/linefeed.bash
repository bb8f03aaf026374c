# bash completion for linefeed, linefeedd and linefeed-sim. What there is to complete is read from --help of the program
# itself, so that it is always right for the version that is installed.

# The part of --help in front of which all words of the command line so far have led.
_linefeed_help() { # PROGRAM [COMMAND]
    "$@" --help 2> /dev/null < /dev/null
}

# Names of commands: two spaces, a name, its description, below the heading.
_linefeed_commands() {
    awk '/^Subcommands:/ { on = 1; next } /^[^ ]/ { on = 0 } on && /^  [a-z]/ { print $1 }'
}

_linefeed_options() {
    awk '/^  -/ { sub(/ .*/, "", $1); n = split($1, names, ","); for (i = 1; i <= n; ++i) print names[i] }'
}

# Values of an option of which --help says ":{one,another}".
_linefeed_values() { # OPTION
    awk -v option="$1" '
        /^  -/ { n = split($1, names, ","); on = 0; for (i = 1; i <= n; ++i) if (names[i] == option) on = 1 }
        on && match($0, /:\{[^}]*\}/) { values = substr($0, RSTART + 2, RLENGTH - 3); gsub(",", "\n", values); print values; exit }'
}

# Whether an option stands alone: --help shows nothing between it and its description.
_linefeed_takes_value() { # OPTION
    awk -v option="$1" '
        /^  -/ { n = split($1, names, ","); for (i = 1; i <= n; ++i) if (names[i] == option && $2 ~ /^(TEXT|INT|UINT|FLOAT|BOOLEAN|ENUM)/) found = 1 }
        END { exit !found }'
}

_linefeed() {
    local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command="" help i values
    COMPREPLY=()
    type -P -- "${program/#\~/$HOME}" > /dev/null || return 0
    program=${program/#\~/$HOME}
    help=$(_linefeed_help "$program")
    if [[ ${program##*/} == linefeed ]]; then
        for ((i = 1; i < COMP_CWORD; ++i)); do
            if [[ ${COMP_WORDS[i]} != -* ]]; then
                command=${COMP_WORDS[i]}
                break
            fi
        done
        if [[ -z $command ]]; then
            mapfile -t COMPREPLY < <(compgen -W "$(_linefeed_commands <<< "$help"; _linefeed_options <<< "$help")" -- "$word")
            return 0
        fi
        help=$(_linefeed_help "$program" "$command")
    fi
    if [[ $before == -* ]] && _linefeed_takes_value "$before" <<< "$help"; then
        values=$(_linefeed_values "$before" <<< "$help")
        if [[ -n $values ]]; then
            mapfile -t COMPREPLY < <(compgen -W "$values" -- "$word")
            return 0
        fi
    elif [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_linefeed_options <<< "$help")" -- "$word")
        return 0
    fi
    compopt -o filenames 2> /dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
}

complete -F _linefeed linefeed linefeedd linefeed-sim
