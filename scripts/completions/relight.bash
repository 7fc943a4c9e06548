_relight() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --from) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --to) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --operator) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --transfer) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --estimate) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --primaries) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --negative) COMPREPLY=($(compgen -W "keep zero" -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--from --to --operator --transfer --estimate --primaries --negative --output --explain --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _relight relight
