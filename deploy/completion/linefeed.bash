# bash completion for linefeed, linefeedd and linefeed-sim. What there is to complete is read from --help of the program
# itself, so that it is always right for the version that is installed.

# What --help of a program or of one of its commands shows.
_linefeed_help() { # PROGRAM [COMMAND]
    "$@" --help 2> /dev/null < /dev/null
}

# Names of commands: two spaces, a name, its description, below the heading.
_linefeed_commands() {
    awk '/^Subcommands:/ { on = 1; next } /^[^ ]/ { on = 0 } on && /^  [a-z]/ { sub(/,$/, "", $1); print $1 }'
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

# The help of the command that the words so far have led to; names that are no command at their place are arguments, behind which there may
# be commands again: linefeed printer line1 nozzle.
_linefeed_help_of_line() { # PROGRAM
    local path=("$1") help i word
    help=$(_linefeed_help "${path[@]}")
    for ((i = 1; i < COMP_CWORD; ++i)); do
        word=${COMP_WORDS[i]}
        if [[ $word == -* ]]; then
            continue
        elif _linefeed_commands <<< "$help" | grep -qxF -- "$word"; then
            path+=("$word")
            help=$(_linefeed_help "${path[@]}")
        elif [[ ${path[-1]} == printer ]]; then
            path+=("$word")
        fi
    done
    printf '%s\n' "$help"
}

_linefeed() {
    local program=${COMP_WORDS[0]} word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} help commands values
    COMPREPLY=()
    type -P -- "${program/#\~/$HOME}" > /dev/null || return 0
    help=$(_linefeed_help_of_line "${program/#\~/$HOME}")
    commands=$(_linefeed_commands <<< "$help")
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
    if [[ -n $commands ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$word")
        return 0
    fi
    compopt -o filenames 2> /dev/null
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
}

complete -F _linefeed linefeed linefeedd linefeed-sim
