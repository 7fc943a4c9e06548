_paint_stats() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --where|-w) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --score) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --illuminant) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --standard) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --formula) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --format|-f) COMPREPLY=($(compgen -W "auto tsv json paints" -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--where --classify --score --illuminant --standard --formula --keep-going --output --format --explain --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _paint_stats paint-stats
