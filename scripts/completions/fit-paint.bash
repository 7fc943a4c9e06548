_fit_paint() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --basis|-b) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --target|-t) COMPREPLY=($(compgen -W "measured curve" -- "$word")); return ;;
    --weights|-w) COMPREPLY=($(compgen -W "perceptual plain" -- "$word")); return ;;
    --illuminant) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --gloss|-g) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --coat) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --satin) COMPREPLY=($(compgen -W "several all none" -- "$word")); return ;;
    --steepest) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --method|-m) COMPREPLY=($(compgen -W "l1 l2 deltae" -- "$word")); return ;;
    --lobes|-n) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --prune) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --views) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --paint-time-limit) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --color-map) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --color-map-model) COMPREPLY=($(compgen -W "better isolines aspecular" -- "$word")); return ;;
    --tilts) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--basis --target --weights --illuminant --gloss --coat --satin --steepest --method --lobes --prune --views --paint-time-limit --output --color-map --color-map-model --tilts --explain --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _fit_paint fit-paint
