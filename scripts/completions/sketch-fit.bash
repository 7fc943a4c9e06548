_sketch_fit() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --image|-i) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --buffers|-b) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --view) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --exposure) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --shift) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --register) COMPREPLY=($(compgen -W "auto always never" -- "$word")); return ;;
    --env|-e) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --basis) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --mask|-m) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --part) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --pixels) COMPREPLY=($(compgen -W "auto changed all" -- "$word")); return ;;
    --glare) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --max-de) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --start) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --name) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --residual) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--image --buffers --view --exposure --shift --register --env --basis --mask --part --pixels --glare --max-de --start --name --residual --output --explain --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _sketch_fit sketch-fit
