_goniogeom_index() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --lights) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --views) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --out-of-plane) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --seam-axis) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threshold|-t) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --metric) COMPREPLY=($(compgen -W "de76 de00" -- "$word")); return ;;
    --target) COMPREPLY=($(compgen -W "curve measured" -- "$word")); return ;;
    --illuminant) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --tolerance-for) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --mesh) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --seam) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --unit) COMPREPLY=($(compgen -W "auto m in cm mm" -- "$word")); return ;;
    --max-gap) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --light-from) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --view-from) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --environment) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --only) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --curve) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --misalignments) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --picture) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--lights --views --out-of-plane --seam-axis --threshold --metric --target --illuminant --worst --tolerance-for --mesh --seam --unit --max-gap --light-from --view-from --environment --open --advise --only --output --curve --misalignments --picture --explain --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _goniogeom_index goniogeom-index
