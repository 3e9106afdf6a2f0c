"""Packages of somebody else, as an installer leaves them."""

import sys
import textwrap

from treadload import registry
from treadload.case import Case


def build(folder, name, entry_points, version="1.2", **modules):
    """A package as an installer leaves it: its modules, and its metadata beside them."""
    package, info = folder / name, folder / f"{name}-{version}.dist-info"
    package.mkdir(parents=True)
    info.mkdir()
    (package / "__init__.py").write_text("")
    for module, text in modules.items():
        (package / f"{module}.py").write_text(textwrap.dedent(text), encoding="utf-8")
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name.replace('_', '-')}\nVersion: {version}\n")
    (info / "entry_points.txt").write_text(entry_points)


def forget(package):
    """Leave no module, registered thing or key of cases of a package to later tests of this process."""

    def belongs(target):
        return target.__module__.partition(".")[0] == package

    for table in (table for table in vars(registry).values() if isinstance(table, registry.Registry)):
        for name in [name for name, entry in table._built_in.items() if belongs(entry.target)]:
            del table._built_in[name]
    fields = Case.__pydantic_fields__
    kinds = {name: getattr(field.annotation, "__args__", (field.annotation,)) for name, field in fields.items()}
    strange = [name for name in fields if any(isinstance(kind, type) and belongs(kind) for kind in kinds[name])]
    for name in strange:
        del fields[name]
    if strange:
        Case.model_rebuild(force=True)
    for name in [name for name in sys.modules if name.partition(".")[0] == package]:
        del sys.modules[name]
