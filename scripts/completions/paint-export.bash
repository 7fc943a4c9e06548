_paint_export() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --to|-t) COMPREPLY=($(compgen -W "rgl rgl-spectral mdl mdl-acescg radiance openmaterial materialx standard-surface openpbr openpbr-usda gltf usda enterprise" -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--to --keep-going --output --explain --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _paint_export paint-export
