_paint_convert() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --from) COMPREPLY=($(compgen -W "auto measured workbook cxf xml jcamp cgats xtf mif qtx mtf csv" -- "$word")); return ;;
    --illuminant) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --observer) COMPREPLY=($(compgen -W "auto 2 10" -- "$word")); return ;;
    --scale) COMPREPLY=($(compgen -W "auto percent factor" -- "$word")); return ;;
    --viewing) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --aperture) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --geometry) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --average) COMPREPLY=($(compgen -W "none name code date" -- "$word")); return ;;
    --outliers) COMPREPLY=($(compgen -W "keep drop" -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --to) COMPREPLY=($(compgen -W "auto xml csv wide cxf cgats" -- "$word")); return ;;
    --columns) COMPREPLY=($(compgen -W "core all" -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--from --illuminant --observer --scale --viewing --aperture --keep-going --geometry --fit-appearance --average --outliers --output --to --columns --cxf-compat --explain --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _paint_convert paint-convert
