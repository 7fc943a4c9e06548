_paint_edit() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --hue) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --chroma) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --lightness) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --hue-shift) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --chroma-factor) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --lightness-shift) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --at) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --share) COMPREPLY=($(compgen -W "exact source" -- "$word")); return ;;
    --image) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --at-pixel) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --lighter) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --travel-to) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --gloss-to) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --face) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --face-shift) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --flop) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --flop-shift) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --travel) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --travel-shift) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --set) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --gloss) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --gloss-shift) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --gloss-angle) COMPREPLY=($(compgen -W "20 60 85" -- "$word")); return ;;
    --anisotropy) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --flakes) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --variations) COMPREPLY=($(compgen -W "face flop travel gloss" -- "$word")); return ;;
    --step) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --gradient) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --only) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --suffix) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --rename) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --code) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --class) COMPREPLY=($(compgen -W "solid metallic pearl interference unknown" -- "$word")); return ;;
    --new) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--hue --chroma --lightness --hue-shift --chroma-factor --lightness-shift --at --share --image --at-pixel --lighter --travel-to --gloss-to --face --face-shift --flop --flop-shift --travel --travel-shift --keep-residual --set --gloss --gloss-shift --gloss-angle --anisotropy --flakes --variations --step --gradient --only --suffix --rename --code --no-code --class --new --output --explain --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _paint_edit paint-edit
