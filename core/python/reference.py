"""The reference page, made of the docstrings: python reference.py [--check] [FILE].

Writes Markdown to the file, or to the terminal. With --check nothing is written, and a public name without a docstring is an
error.
"""

import inspect
import re
import sys

import liestep as ls

missing: list[str] = []


def described(name: str, thing: object) -> str:
    text = inspect.getdoc(thing)
    if not text or (inspect.isclass(thing) and thing.__doc__ is None):
        missing.append(name)
        return ""
    # numpy's headings as bold ones; examples as listings.
    text = re.sub(r"^(\w[\w ,]*)\n-+$", r"**\1**\n", text, flags=re.MULTILINE)
    lines, is_code = [], False
    for line in text.splitlines():
        if line.startswith(">>>") and not is_code:
            lines.append("```python")
            is_code = True
        elif is_code and not line.strip():
            lines.append("```")
            is_code = False
        lines.append(line)
    return "\n".join([*lines, "```"] if is_code else lines)


def signature(name: str, thing: object) -> str:
    try:
        return f"`{name}{inspect.signature(thing)}`"  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return f"`{name}`"


def section(name: str, thing: object) -> list[str]:
    parts = [f"## {name}", signature(name, thing) if callable(thing) else "", described(name, thing)]
    if inspect.isclass(thing) and not issubclass(thing, Exception):
        for own, member in sorted(vars(thing).items()):
            is_shown = inspect.isfunction(member) or isinstance(member, property)
            if is_shown and not own.startswith("_"):
                title = signature(own, member) if inspect.isfunction(member) else f"`{own}`"
                parts.append(f"### {title}\n\n{described(f'{name}.{own}', member)}")
    return parts


names = [name for name in ls.__all__ if name != "errors"]
page = ["# liestep", inspect.getdoc(ls) or "", *(part for name in names for part in section(name, getattr(ls, name)))]
if missing:
    sys.exit(f"no docstring: {', '.join(missing)}")
text = "\n\n".join(part for part in page if part) + "\n"
given = [argument for argument in sys.argv[1:] if argument != "--check"]
if given:
    with open(given[0], "w", encoding="utf-8") as file:
        file.write(text)
elif "--check" not in sys.argv:
    sys.stdout.write(text)
