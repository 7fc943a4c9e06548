_paint_studio() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --mesh|-m) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --env|-e) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --transport) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --basis|-b) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --print-profile) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --title) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--mesh --env --transport --basis --empty --print-profile --title --output --explain --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _paint_studio paint-studio
