"""The manual of a script: its --help, its man page and its completion of bash are made of one parser of argparse."""

import argparse
import dataclasses
import os
import shutil
import subprocess
import sys
import textwrap

WIDTH = 100


@dataclasses.dataclass
class Manual:
    """What a manual has beside the options."""

    name: str
    summary: str  # one line, as a man page has it behind the name
    description: list[str]  # paragraphs
    exit_status: str
    examples: list[tuple[str, str]]  # what a command does, and the command
    see_also: list[str]  # such as fit-paint(1)


class Generate(argparse.Action):
    """Prints a text that is made of the parser, and exits."""

    def __call__(self, parser, namespace, values, option_string=None):
        print({"man": man_page, "completion": bash_completion}[values](parser, self.const), end="")
        parser.exit()


class Version(argparse.Action):
    """Prints the version, which is that of the tools beside the script or in PATH, and exits."""

    def __call__(self, parser, namespace, values, option_string=None):
        beside = os.path.dirname(os.path.realpath(sys.argv[0]))
        tool = shutil.which("fit-paint", path=f"{beside}:{os.environ.get('PATH', os.defpath)}")
        if tool is None:
            parser.exit(3, f"{parser.prog}: its version is that of the tools, of which none is in PATH: add their folder to it\n")
        said = subprocess.run([tool, "--version"], capture_output=True, text=True, check=True).stdout
        print(parser.prog, said.split()[-1])
        parser.exit()


def parser_of(manual):
    """A parser with the texts of the manual and the option --generate; the options of the script are then added to it."""
    examples = "\n".join(f"  {command}\n{textwrap.indent(textwrap.fill(sentence(effect), WIDTH - 6), ' ' * 6)}"
                         for effect, command in manual.examples)
    status = textwrap.fill(f"exit status: {manual.exit_status}", WIDTH)
    parser = argparse.ArgumentParser(
        prog=manual.name, formatter_class=argparse.RawDescriptionHelpFormatter,
        description="\n\n".join(textwrap.fill(text, WIDTH) for text in manual.description),
        epilog=f"examples:\n{examples}\n\n{status}\n\nThe whole story: man {manual.name}")
    parser.add_argument("--generate", action=Generate, const=manual, choices=("man", "completion"), metavar="TEXT",
                        help="print a text made from the options, which is one of man, completion")
    parser.add_argument("--version", action=Version, nargs=0, help="print the version")
    return parser


def sentence(text):
    """A line of help as a sentence."""
    return text[:1].upper() + text[1:] + ("" if text.endswith(".") else ".")


def roff(text):
    """Text for a man page: backslashes, hyphens that are typed, and a leading dot or quote are made safe."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return f"\\&{text}" if text[:1] in (".", "'") else text


def commands_of(parser):
    """The parsers of the commands of a script, by name, and the help of each; both are empty where it has none."""
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            return action.choices, {choice.dest: choice.help for choice in action._choices_actions}
    return {}, {}


def split_actions(parser):
    """(the inputs, the options) of a parser, without its commands."""
    plain = [action for action in parser._actions if not isinstance(action, argparse._SubParsersAction)]
    return ([action for action in plain if not action.option_strings], [action for action in plain if action.option_strings])


def value_of(action):
    """The name of the values that an option or input takes, and whether there may be several; empty if it takes none."""
    nargs = getattr(action, "save_nargs", action.nargs)  # parse_intermixed_args() puts it aside, up to Python 3.12
    if nargs == 0:
        return ""
    name = action.metavar or action.dest.upper()
    return {"*": f"[{name}...]", "+": f"{name}...", "?": f"[{name}]"}.get(nargs, name)


def paragraph(action):
    text = sentence(action.help % {**vars(action)})
    return text + (" Required." if action.option_strings and action.required else "")


def entries(parser):
    """The inputs and options of a parser, as paragraphs of a man page."""
    inputs, options = split_actions(parser)
    text = "".join(f".TP\n.I {roff(value_of(action))}\n{roff(paragraph(action))}\n" for action in inputs)
    for action in options:
        names = ", ".join(f"\\fB{roff(name)}\\fR" for name in action.option_strings)
        value = f" \\fI{roff(value_of(action))}\\fR" if value_of(action) else ""
        text += f".TP\n{names}{value}\n{roff(paragraph(action))}\n"
    return text


def synopsis(name, parser, has_options):
    inputs = "".join(f" {value_of(action)}" for action in split_actions(parser)[0])
    return f".B {roff(name)}\n{roff(('[options]' if has_options else '') + inputs)}\n".replace("\n ", "\n")


def man_page(parser, manual):
    commands, helps = commands_of(parser)
    text = (f'.TH {roff(manual.name.upper())} 1 2026-11-21 "Goniochrome" "Goniochrome"\n.SH NAME\n'
            f"{roff(manual.name)} \\- {roff(manual.summary)}\n.SH SYNOPSIS\n")
    lines = [synopsis(f"{manual.name} {name}", command, len(split_actions(command)[1]) > 1) for name, command in commands.items()]
    text += ".br\n".join(lines or [synopsis(manual.name, parser, True)])
    opening, *details = manual.description
    text += f".SH DESCRIPTION\n{roff(opening)}\n.SH EXAMPLES\n"
    text += ".PP\n".join(f"{roff(sentence(effect))}\n.PP\n.nf\n.RS\n{roff(command)}\n.RE\n.fi\n" for effect, command in manual.examples)
    text += (".SH DETAILS\n" if details else "") + ".PP\n".join(roff(paragraph) + "\n" for paragraph in details)
    for name, command in commands.items():
        text += f".SH COMMAND {roff(name.upper())}\n{roff(sentence(helps[name]))}\n{entries(command)}"
    text += f".SH OPTIONS\n{entries(parser)}.SH EXIT STATUS\n{roff(sentence(manual.exit_status))}\n"
    pages = [*manual.see_also, "goniochrome-paint(5)", "goniochrome(7)"]
    return text + ".SH SEE ALSO\n" + ",\n".join(f".BR {roff(page.partition('(')[0])} ({page.partition('(')[2]}" for page in pages) + "\n"


def cases_of(parser, indent):
    """The values that follow an option, as branches of a case of bash."""
    text = ""
    for action in split_actions(parser)[1]:
        if action.nargs == 0:
            continue
        reply = f'-W "{" ".join(action.choices)}"' if action.choices else "-f"
        text += f'{indent}{"|".join(action.option_strings)}) COMPREPLY=($(compgen {reply} -- "$word")); return ;;\n'
    return text


def words_of(parser):
    return " ".join(action.option_strings[-1] for action in split_actions(parser)[1])


def bash_completion(parser, manual):
    commands, _ = commands_of(parser)
    function = "_" + manual.name.replace("-", "_")
    head = f"{function}() {{\n  local word=${{COMP_WORDS[COMP_CWORD]}}"
    foot = f"}}\ncomplete -o filenames -F {function} {manual.name}\n"
    if not commands:
        return (f"{head}\n  case ${{COMP_WORDS[COMP_CWORD-1]}} in\n{cases_of(parser, '    ')}  esac\n  case $word in\n"
                f'    -*) COMPREPLY=($(compgen -W "{words_of(parser)}" -- "$word")) ;;\n'
                f'    *) COMPREPLY=($(compgen -f -- "$word")) ;;\n  esac\n{foot}')
    text = (f"{head} words\n  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
            f'    COMPREPLY=($(compgen -W "{" ".join([*commands, *words_of(parser).split()])}" -- "$word"))\n    return\n  fi\n'
            "  case ${COMP_WORDS[1]} in\n")
    for name, command in commands.items():
        cases = cases_of(command, "        ")
        choose = f"      case ${{COMP_WORDS[COMP_CWORD-1]}} in\n{cases}      esac\n" if cases else ""
        text += f'    {name})\n      words="{words_of(command)}"\n{choose}      ;;\n'
    return (f"{text}  esac\n  case $word in\n"
            '    -*) COMPREPLY=($(compgen -W "$words" -- "$word")) ;;\n'
            f'    *) COMPREPLY=($(compgen -f -- "$word")) ;;\n  esac\n{foot}')
