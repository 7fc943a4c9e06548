_paint_batch() {
  local word=${COMP_WORDS[COMP_CWORD]} words
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W "plan list shard merge slurm book --help --generate --version" -- "$word"))
    return
  fi
  case ${COMP_WORDS[1]} in
    plan)
      words="--help --out --env --env-size --mesh --view --size --basis --target-de00 --check --gloss --against --cores --shard-s --shard-paints --chapter --explain"
      case ${COMP_WORDS[COMP_CWORD-1]} in
        --out) COMPREPLY=($(compgen -f -- "$word")); return ;;
        --env) COMPREPLY=($(compgen -f -- "$word")); return ;;
        --env-size) COMPREPLY=($(compgen -f -- "$word")); return ;;
        --mesh) COMPREPLY=($(compgen -f -- "$word")); return ;;
        --view) COMPREPLY=($(compgen -f -- "$word")); return ;;
        --size) COMPREPLY=($(compgen -f -- "$word")); return ;;
        --basis) COMPREPLY=($(compgen -f -- "$word")); return ;;
        --target-de00) COMPREPLY=($(compgen -f -- "$word")); return ;;
        --check) COMPREPLY=($(compgen -f -- "$word")); return ;;
        --gloss) COMPREPLY=($(compgen -f -- "$word")); return ;;
        --against) COMPREPLY=($(compgen -f -- "$word")); return ;;
        --cores) COMPREPLY=($(compgen -f -- "$word")); return ;;
        --shard-s) COMPREPLY=($(compgen -f -- "$word")); return ;;
        --shard-paints) COMPREPLY=($(compgen -f -- "$word")); return ;;
        --chapter) COMPREPLY=($(compgen -f -- "$word")); return ;;
      esac
      ;;
    list)
      words="--help"
      ;;
    shard)
      words="--help"
      ;;
    merge)
      words="--help"
      ;;
    slurm)
      words="--help --task-s"
      case ${COMP_WORDS[COMP_CWORD-1]} in
        --task-s) COMPREPLY=($(compgen -f -- "$word")); return ;;
      esac
      ;;
    book)
      words="--help"
      ;;
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "$words" -- "$word")) ;;
    *) COMPREPLY=($(compgen -f -- "$word")) ;;
  esac
}
complete -o filenames -F _paint_batch paint-batch
