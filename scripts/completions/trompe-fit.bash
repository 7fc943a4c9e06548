_trompe_fit() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --angle|-a) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --lights) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --views) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --out-of-plane) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --seam-axis) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --light-weights) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --view-weights) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --mode) COMPREPLY=($(compgen -W "all single rows" -- "$word")); return ;;
    --at) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --objective) COMPREPLY=($(compgen -W "rms max" -- "$word")); return ;;
    --vary) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --bounds) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --mesh) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --seam) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --unit) COMPREPLY=($(compgen -W "auto m in cm mm" -- "$word")); return ;;
    --max-gap) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --light-from) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --view-from) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --environment) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --only) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --suffix) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --picture) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --dark) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--angle --lights --views --out-of-plane --seam-axis --light-weights --view-weights --mode --at --objective --vary --bounds --mesh --seam --unit --max-gap --light-from --view-from --environment --open --only --suffix --output --picture --dark --explain --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _trompe_fit trompe-fit
