#!/usr/bin/env python3
"""Completion of a program's command line, made of what its --help says.

    completion.py bash|zsh PROGRAM OUT_FILE

Options and commands are those of --help. The value of an option is completed by the words that --help lists in braces,
by the names of shipped robots, worlds and manoeuvres, or by files and folders; numbers and other text are not.
"""
import pathlib
import re
import subprocess
import sys
import textwrap
from dataclasses import dataclass, field, replace

# Which folder of share/kenaf has the names of an option's shipped files, and how they end.
SHIPPED = {"--robot": ("robots", "toml"), "--world": ("worlds", "sdf")}
# Which command of the program lists the names, in its first column: a file may hold several.
LISTED = {"--manoeuvre": "manoeuvres"}
# What follows an option's names: a type such as "FLOAT:0 to 1=1" or "TEXT ...", what else it needs, its words.
OPTION_REST = (r"(?: (?P<type>(?!Needs:|Excludes:)\S+(?: in \[[^\]]*\]\S*| to \S+)?(?: x \d+)?)(?P<many> \.\.\.)?)?"
               r"(?: (?:Needs|Excludes):(?: -\S+)+)*\s*(?P<words>.*)")
NUMBERS = ("UINT", "INT", "FLOAT", "SECONDS")


@dataclass
class Option:
    names: list[str]
    words: str  # what it is, one line
    value: str = ""  # "": a flag; "file", "folder", "number", "text", "shipped FOLDER EXTENSION",
    #                "listed COMMAND" or "of a b c"
    repeats: bool = False


@dataclass
class Command:
    name: str  # "": of the program itself
    words: str = ""
    options: list[Option] = field(default_factory=list)
    takes_files: bool = False  # positional arguments


def value_of(names, type_name, words):
    """How the value of an option is completed."""
    listed = re.search(r"\{([^}]*)\}", type_name)
    if listed:
        return "of " + listed[1].replace(",", " ")
    for name in names:
        if name in SHIPPED and re.search("shipped|embedded", words):
            return "shipped " + " ".join(SHIPPED[name])
        if name in LISTED and "shipped" in words:
            return "listed " + LISTED[name]
    kind = re.match(r"[\w.]*", type_name)[0]
    if kind in NUMBERS:
        return "number"
    if kind == "DIR":
        return "folder"
    if kind == "FILE" or kind.endswith(".csv") or re.search(r"\b(file|dataset)\b", words, re.I):
        return "file"
    return "text"


def read_command(name, text):
    """A command of its help, as CLI11 writes it: names, type and default in one column, words in the next."""
    command, section = Command(name), ""
    for line in text.splitlines():
        if re.fullmatch(r"\w[\w ]*:", line):
            section = line[:-1]
        elif section == "Positionals" and re.match(r"  \S", line):
            command.takes_files = True
        elif section not in ("", "Positionals", "Subcommands") and (match := re.match(r"  (-[-\w,]+)(.*)", line)):
            rest = re.fullmatch(OPTION_REST, match[2])
            command.options.append(Option(match[1].split(","), rest["words"], rest["type"] or "", bool(rest["many"])))
        elif section not in ("", "Positionals", "Subcommands") and command.options and re.match(r" {28,}\S", line):
            option = command.options[-1]
            option.words = (option.words + " " + line.strip()).strip()
    for option in command.options:
        option.repeats = option.repeats or "several times" in option.words or "any number of times" in option.words
        if option.value:
            option.value = value_of(option.names, option.value, option.words)
    return command


def read_program(program):
    """The program and its commands; the first is the program itself."""
    def help_of(*arguments):
        return subprocess.run([program, *arguments, "--help"], check=True, capture_output=True, text=True).stdout

    text = help_of()
    commands = [read_command("", text)]
    listed = text.partition("\nSubcommands:\n")[2]
    for name, words in re.findall(r"(?m)^  ([a-z][a-z-]*)\s+(.*)$", listed):
        command = read_command(name, help_of(name))
        command.words = words
        commands.append(command)
    if not commands[0].options:
        sys.exit(f"completion: the help of {program} lists no options")
    return commands


BASH = r"""# Completion of @program@ for bash, made of its --help.

# The shipped files of a kind, by name: those of KENAF_DATA_DIR and those that are installed with the program.
__@function@_shipped() {
  local root file program
  program=$(type -P "${COMP_WORDS[0]}")
  for root in "${KENAF_DATA_DIR:-/nonexistent}" "${program%/*}/../share/kenaf"; do
    for file in "$root/$1"/*."$2"; do
      [ ! -e "$file" ] || basename "$file" ".$2"
    done
  done
}

_@function@() {
  local command="" current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} word
  # readline parts --option=value at the sign
  if [ "$current" = = ]; then
    current=""
  elif [ "$previous" = = ]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    case $word in
      @commands@) command=$word; break ;;
    esac
  done
  COMPREPLY=()
  case "$command $previous" in
@values@
  esac
  case "$command" in
@options@
  esac
}
complete -F _@function@ @program@
"""


def bash_value(value):
    """The words that make COMPREPLY of a value."""
    kind, _, rest = value.partition(" ")
    files = 'COMPREPLY=($(compgen -f -- "$current")); compopt -o filenames 2>/dev/null'
    return {
        "number": ":", "text": ":",
        "file": files,
        "folder": files.replace("-f", "-d"),
        "of": f'COMPREPLY=($(compgen -W "{rest}" -- "$current"))',
        "shipped": f'COMPREPLY=($(compgen -W "$(__@function@_shipped {rest})" -f -- "$current"))',
        "listed": f'COMPREPLY=($(compgen -W "$("${{COMP_WORDS[0]}}" {rest} 2>/dev/null | sed -n "2,\$ s/ .*//p")" -f -- "$current"))',
    }[kind]


def bash(program, commands):
    values, options = [], []
    names = [command.name for command in commands if command.name]
    for command in commands:
        for option in command.options:
            if option.value:
                patterns = " | ".join(f'"{command.name} {name}"' for name in option.names)
                values.append(f"    {patterns}) {bash_value(option.value)}; return ;;")
        words = " ".join(name for option in command.options for name in option.names)
        if not command.name and names:
            words += " " + " ".join(names)
        files = ' [[ $current == -* ]] ||' if command.takes_files else ""
        action = f'COMPREPLY=($(compgen -W "{words}" -- "$current"))'
        if command.takes_files:
            also = f'-W "{" ".join(names)}" ' if not command.name and names else ""
            action += f';{files} {{ COMPREPLY=($(compgen {also}-f -- "$current")); compopt -o filenames 2>/dev/null; }}'
        options.append(f"    {command.name or chr(34) * 2}) {action} ;;")
    text = BASH.replace("@commands@", " | ".join(names) or "''")
    text = text.replace("@values@", "\n".join(values)).replace("@options@", "\n".join(options))
    return text.replace("@program@", program).replace("@function@", program.replace("-", "_"))


def short(text):
    return textwrap.shorten(text, 100, placeholder=" ...")


def zsh_word(text):
    return text.replace("\\", "\\\\").replace("'", "'\\''").replace("[", "\\[").replace("]", "\\]").replace(":", "\\:")


def zsh_value(value):
    kind, _, rest = value.partition(" ")
    return {
        "number": ":number: ", "text": ":value: ",
        "file": ":file:_files",
        "folder": ":folder:_files -/",
        "of": f":value:({rest})",
        "shipped": f":name:__@function@_shipped {rest}",
        "listed": f":name:__@function@_listed {rest}",
    }.get(kind, "")


def zsh_arguments(command, more=()):
    specs = []
    for option in command.options:
        names = option.names
        star = "*" if option.repeats else ""
        exclusion = "" if option.repeats else "(" + " ".join(names) + ")"
        value = zsh_value(option.value) if option.value else ""
        for name in names:
            equals = "=" if value and name.startswith("--") else ""
            specs.append(f"'{exclusion}{star}{name}{equals}[{zsh_word(short(option.words))}]{value}'")
    if command.takes_files:
        specs.append("'*:file:_files'")
    return " \\\n    ".join(["_arguments -s -S", *specs, *more])


def zsh(program, commands):
    text = f"""#compdef {program}
# Completion of {program} for zsh, made of its --help.

# The shipped files of a kind, by name: those of KENAF_DATA_DIR and those that are installed with the program; or a file.
__@function@_shipped() {{
  local -a names
  names=(${{KENAF_DATA_DIR:-/nonexistent}}/$1/*.$2(N:t:r) ${{commands[{program}]:h}}/../share/kenaf/$1/*.$2(N:t:r))
  _alternative 'names:shipped name:compadd -a names' 'files:file:_files'
}}
"""
    if any(option.value.startswith("listed ") for command in commands for option in command.options):
        text += f"""
# The names that a command of the program lists, in its first column below a title; or a file.
__@function@_listed() {{
  local -a names
  names=(${{${{${{(f)"$({program} $1 2>/dev/null)"}}[2,-1]}}%% *}})
  _alternative 'names:shipped name:compadd -a names' 'files:file:_files'
}}
"""
    text += "\n"
    named = [command for command in commands if command.name]
    text += "_@function@() {\n"
    if not named:
        text += "  " + zsh_arguments(commands[0]) + "\n"
    else:
        text += "  local state line\n  local -a commands_of\n"
        # a file may stand in a command's place
        files = "; _files" if commands[0].takes_files else ""
        whole = replace(commands[0], takes_files=False)
        text += "  " + zsh_arguments(whole, ["'1: :->command'", "'*:: :->arguments'"]) + "\n"
        text += "  case $state in\n  command)\n    commands_of=(\n"
        text += "".join(f"      '{command.name}:{zsh_word(short(command.words))}'\n" for command in named)
        text += "    )\n    _describe command commands_of" + files + " ;;\n  arguments)\n    case $line[1] in\n"
        for command in named:
            text += f"    {command.name})\n    {zsh_arguments(command)} ;;\n"
        text += "    esac ;;\n  esac\n"
    text += "}\n\n_@function@ \"$@\"\n"
    return text.replace("@function@", program.replace("-", "_"))


def main():
    shell, program, out_file = sys.argv[1:]
    commands = read_program(program)
    name = pathlib.Path(program).name
    pathlib.Path(out_file).write_text({"bash": bash, "zsh": zsh}[shell](name, commands), encoding="utf-8")


main()
