_paint_book() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
    -o|--output) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --title) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --mesh) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --env) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --basis) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --gloss) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --size) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --page-paints) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --orbit) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --studio) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --pictures) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --jobs) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --bin) COMPREPLY=($(compgen -f -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--help --generate --version --output --variations --palette --title --mesh --chips --env --basis --fitted --gloss --size --beside --page-paints --orbit --studio --pictures --jobs --bin --quiet" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _paint_book paint-book
