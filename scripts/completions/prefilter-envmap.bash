_prefilter_envmap() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --rotate|-r) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --ball) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --exposure|-x) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --horizon) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --bad-pixels) COMPREPLY=($(compgen -W "error zero" -- "$word")); return ;;
    --basis|-b) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --exponents|-e) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --for|-p) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --size|-s) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --spots) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --layout|-l) COMPREPLY=($(compgen -W "env latlong openexr mip ktx2 dds" -- "$word")); return ;;
    --tolerance) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --cache|-c) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --verify|-v) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --picture) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --seed) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--rotate --ball --exposure --horizon --bad-pixels --basis --exponents --for --no-mirror --size --spots --no-open-maps --sparkle --layout --tolerance --cache --verify --output --picture --explain --seed --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _prefilter_envmap prefilter-envmap
