_paint_sbrdf() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --stripe) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --mask) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --decal) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --place) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --mosaic) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --mix) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --angle) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --size) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --crop) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --tile) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --turn) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --polish) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --wear) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --gloss) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --lobes) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --mirror) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--stripe --gradient --mask --decal --place --invert --mosaic --mix --angle --size --crop --tile --turn --polish --wear --gloss --lobes --mirror --output --explain --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _paint_sbrdf paint-sbrdf
