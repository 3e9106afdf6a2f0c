"""What the address of the project adds to its metadata: links, and whole links in place of those of the README.

The one setting is `address` of the metadata hook in pyproject.toml. While it is empty the distribution has no links,
and the build says so: none is invented.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

from hatchling.metadata.plugin.interface import MetadataHookInterface

_LINK = re.compile(r"(?P<picture>!?)\[(?P<words>[^\]]*)\]\((?!https?:|#|mailto:)(?P<path>[^)\s]+)\)")


def links(address: str) -> dict[str, str]:
    """Links of a project by their labels; none without an address."""
    base = address.rstrip("/")
    if not base:
        return {}
    return {
        "Source": base,
        "Documentation": f"{base}/blob/main/docs/index.md",
        "Changelog": f"{base}/blob/main/CHANGELOG.md",
        "Issues": f"{base}/issues",
    }


def with_whole_links(text: str, address: str) -> str:
    """A README whose links to files lead to the address; as it is without one."""
    base = address.rstrip("/")
    if not base:
        return text

    def whole(link: re.Match[str]) -> str:
        kind = "raw" if link["picture"] else "blob"
        return f"{link['picture']}[{link['words']}]({base}/{kind}/main/{link['path']})"

    return _LINK.sub(whole, text)


class CustomMetadataHook(MetadataHookInterface):
    """Fills `readme` and `urls`."""

    def update(self, metadata: dict[str, object]) -> None:
        """Called by hatchling with the table [project]."""
        address = str(self.config.get("address", ""))
        if not address:
            print("treadload: no address of the project is set; the metadata has no links", file=sys.stderr)
        text = (Path(self.root) / "README.md").read_text(encoding="utf-8")
        metadata["readme"] = {"content-type": "text/markdown", "text": with_whole_links(text, address)}
        metadata["urls"] = links(address)
