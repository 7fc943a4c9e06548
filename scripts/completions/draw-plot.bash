_draw_plot() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --series) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --x) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --y) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --style) COMPREPLY=($(compgen -W "line points both dashed rings" -- "$word")); return ;;
    --title) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --x-label) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --y-label) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --logarithmic) COMPREPLY=($(compgen -W "none x y both" -- "$word")); return ;;
    --width) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --height) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--series --x --y --style --title --x-label --y-label --logarithmic --width --height --output --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _draw_plot draw-plot
