_paint_pick() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --face) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --flop) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --gloss) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --travel) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --buffers) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --palette) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --board|-b) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --probe) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --mesh|-m) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --env|-e) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --basis) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --studio) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --name) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--face --flop --gloss --travel --retro --buffers --palette --board --probe --mesh --env --basis --studio --name --output --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _paint_pick paint-pick
