_colorsnap() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --library|-l) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --filter) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --count|-k) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --formula|-m) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --geometry|-g) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --weight|-w) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --illuminant) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --method) COMPREPLY=($(compgen -W "auto tree scan" -- "$word")); return ;;
    --threshold) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --off-radial) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --hue-travel) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --format|-f) COMPREPLY=($(compgen -W "auto tsv json paints" -- "$word")); return ;;
    --cloud) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--library --filter --count --formula --geometry --weight --illuminant --mix-observers --method --threshold --off-radial --hue-travel --output --format --cloud --assign --keep-going --explain --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _colorsnap colorsnap
