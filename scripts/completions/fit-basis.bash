_fit_basis() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --lobes|-n) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --method|-m) COMPREPLY=($(compgen -W "power-mean lm" -- "$word")); return ;;
    --starts) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --representatives) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --visible) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --target|-t) COMPREPLY=($(compgen -W "measured curve" -- "$word")); return ;;
    --weights|-w) COMPREPLY=($(compgen -W "perceptual plain" -- "$word")); return ;;
    --mirror) COMPREPLY=($(compgen -W "auto yes no" -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --name) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --each) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --table) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --plot) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --time-limit) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --seed) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--lobes --method --starts --representatives --visible --target --weights --mirror --output --name --each --table --plot --explain --time-limit --seed --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _fit_basis fit-basis
