"""The page of all commands with their arguments and options, from the program itself."""

from pathlib import Path
from typing import Any, Literal, get_args, get_origin

import typer.main

from simulearn.cli.program import app

GENERATED = "reference/commands.md"
NAMES = {Path: "PATH", int: "NUMBER", float: "NUMBER"}  # of values, where an option has none
HEAD = """# Commands

This page is made from the program, so it is what `simulearn COMMAND --help` says. `-o` may be
repeated where it says so; the ending of a file picks its format ([exports](../exports.md)).

| exit code | means |
| --- | --- |
| 0 | done |
| 1 | the input is wrong |
| 2 | the command is written wrongly: an unknown option, a missing argument |
| 3 | the computation failed, or one of several did |
| 130 | interrupted by Ctrl-C |

An error is one line on the standard error stream: what is wrong, where, and what would be right.
[Troubleshooting](../troubleshooting.md) lists them by code. With `--json` a command prints its
answer for programs on the standard output.
"""


def program() -> Any:
    """Return the whole command line as one command of the library behind typer."""
    return typer.main.get_command(app)


def commands(command: Any, name: str) -> list[tuple[str, Any]]:
    """Return all commands below a command, with their full names, sorted."""
    below = getattr(command, "commands", None)
    if below is None:
        return [(name, command)]
    return [found for key in sorted(below) for found in commands(below[key], f"{name} {key}")]


def text() -> str:
    """Return the page."""
    return HEAD + "".join(_section(*one) for one in commands(program(), "simulearn"))


def _section(name: str, command: Any) -> str:
    arguments = [one for one in command.params if one.param_type_name == "argument"]
    options = [one for one in command.params if one.param_type_name == "option"]
    usage = " ".join([name, "[OPTIONS]", *(_usage(one) for one in arguments)])
    parts = [f"\n## {name}\n\n{_escaped(command.help or '')}\n\n```text\n{usage}\n```\n"]
    if arguments:
        parts.append("\n| argument | what |\n| --- | --- |\n")
        parts += [f"| `{_usage(one)}` | {_escaped(one.help or '')} |\n" for one in arguments]
    parts.append("\n| option | value | what |\n| --- | --- | --- |\n")
    parts += [_option(one) for one in options if "--help" not in one.opts]
    return "".join(parts)


def _usage(argument: Any) -> str:
    name = (argument.metavar or argument.name).strip("[]{}.").upper()
    name += "..." if argument.nargs != 1 else ""
    return name if argument.required else f"[{name}]"


def _option(option: Any) -> str:
    names = ", ".join(f"`{name}`" for name in [*option.opts, *option.secondary_opts])
    value = "" if option.is_flag else f"`{_value(option)}`"
    remarks = ["Needed."] if option.required else []
    if not option.is_flag and not option.multiple and isinstance(option.default, str | int | float):
        remarks.append(f"If left out: `{option.default}`.")
    if option.multiple:
        remarks.append("May be repeated.")
    what = " ".join([_escaped(option.help or ""), *remarks])
    return f"| {names} | {value} | {what} |\n"


def _value(option: Any) -> str:
    if option.metavar:
        return str(option.metavar)
    kind = option.type_descriptor.annotation
    inner = get_args(kind)
    if get_origin(kind) is Literal:
        return " or ".join(inner)
    return NAMES.get(inner[0] if inner else kind, "TEXT")


def _escaped(words: str) -> str:
    """Return text whose characters a table or the markup would take for their own."""
    words = " ".join(words.split())
    return words.replace("|", "\\|").replace("*", "\\*").replace("<", "&lt;").replace("[", "\\[")
