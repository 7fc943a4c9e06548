_paint_compare() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --standard|-s) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --pair) COMPREPLY=($(compgen -W "auto name code nearest" -- "$word")); return ;;
    --formula) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --illuminant) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --limits|-l) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --make-limits) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --spread) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --share) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --show-limit) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --format|-f) COMPREPLY=($(compgen -W "auto tsv json paints" -- "$word")); return ;;
    --chart) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --mesh|-m) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --env|-e) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--standard --pair --keep-going --formula --illuminant --limits --make-limits --spread --share --show-limit --output --format --chart --mesh --env --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _paint_compare paint-compare
