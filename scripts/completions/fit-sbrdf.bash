_fit_sbrdf() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --width) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --texels) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --mask) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --normals) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --lobes|-n) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --method|-m) COMPREPLY=($(compgen -W "best dictionary nonlinear" -- "$word")); return ;;
    --noise) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --saturated) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --tile) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --holdout|-k) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --tolerance) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --error-map) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--width --texels --mask --normals --lobes --method --noise --saturated --mend-exposures --tile --holdout --tolerance --error-map --output --explain --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _fit_sbrdf fit-sbrdf
