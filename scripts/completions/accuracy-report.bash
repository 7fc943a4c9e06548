_accuracy_report() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
    -o|--output) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --bin) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --paints) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --probe) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --mesh) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --target-de00) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --scene) COMPREPLY=($(compgen -f -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--help --generate --version --output --quick --bin --paints --probe --mesh --target-de00 --scene" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _accuracy_report accuracy-report
