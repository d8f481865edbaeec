"""Options that belong together are one dataclass, which commands share."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from copy import copy
from dataclasses import fields, is_dataclass
from inspect import Parameter, Signature, signature
from typing import Annotated, Any, get_args, get_origin

Command = Callable[..., None]


def grouped(command: Command) -> Command:
    """The command with its groups laid out as options, as typer wants them.

    typer makes an option of each parameter in a function's signature. A group is a dataclass whose fields are written
    like such parameters. The function that is returned has a signature in which each group is replaced by its fields;
    called with their values, it makes the groups and calls the command.

    A text beside the group, `cup: Annotated[CupOptions, "fem"]`, is put before the help of each of its options.
    """
    parameters = signature(command, eval_str=True).parameters.values()
    groups = {each.name: _group(each)[0] for each in parameters if is_dataclass(_group(each)[0])}

    def laid_out(**words: Any) -> None:
        made = {
            name: group(**{field.name: words.pop(field.name) for field in fields(group)})
            for name, group in groups.items()
        }
        command(**words, **made)

    laid_out.__name__, laid_out.__doc__ = command.__name__, command.__doc__
    options = [option for each in parameters for option in (_options(each) if each.name in groups else (each,))]
    laid_out.__signature__ = Signature(options)  # type: ignore[attr-defined]
    return laid_out


def _group(parameter: Parameter) -> tuple[Any, str]:
    """A parameter's type, and the text beside it."""
    if get_origin(parameter.annotation) is not Annotated:
        return parameter.annotation, ""
    kind, about = get_args(parameter.annotation)
    return kind, about


def _options(parameter: Parameter) -> Iterator[Parameter]:
    """The fields of a group as parameters of their own."""
    group, about = _group(parameter)
    for field in signature(group, eval_str=True).parameters.values():
        kind, option = get_args(field.annotation)
        if about:
            option = copy(option)
            option.help = f"{about}: {option.help[0].lower()}{option.help[1:]}"
        yield field.replace(annotation=Annotated[kind, option])
