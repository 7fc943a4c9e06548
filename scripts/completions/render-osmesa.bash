_render_osmesa() {
  local word=${COMP_WORDS[COMP_CWORD]}
  case ${COMP_WORDS[COMP_CWORD-1]} in
    --mesh|-m) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --gbuffer) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --paint|-p) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --basis) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --part) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --split) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --texture) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --texture-maps) COMPREPLY=($(compgen -W "cubes mip" -- "$word")); return ;;
    --env|-e) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --light) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --emit) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --spectral) COMPREPLY=($(compgen -W "auto on guess off" -- "$word")); return ;;
    --floor) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --operator) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --critical-angle) COMPREPLY=($(compgen -W "clip slide slide-map index" -- "$word")); return ;;
    --exposure) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --background) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --camera) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --size|-s) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --samples) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --turntable) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --light-sweep) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --effects) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --tolerance) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --tilts) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --bounces) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --engine) COMPREPLY=($(compgen -W "auto cpu gl integral path gpu" -- "$word")); return ;;
    --check) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --check-source) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --output|-o) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --sheet) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --to) COMPREPLY=($(compgen -W "y4m ppm exr" -- "$word")); return ;;
    --view) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --aov) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --time-limit) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --seed) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --report) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --threads) COMPREPLY=($(compgen -f -- "$word")); return ;;
    --generate) COMPREPLY=($(compgen -W "man completion" -- "$word")); return ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "--mesh --gbuffer --paint --basis --part --trim --split --texture --texture-maps --env --no-cache --light --emit --spectral --floor --operator --critical-angle --exposure --background --camera --size --samples --turntable --light-sweep --effects --tolerance --tilts --bounces --engine --print-shader --check --check-source --output --sheet --to --view --aov --explain --time-limit --seed --report --threads --quiet --help --version --generate" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _render_osmesa render-osmesa
