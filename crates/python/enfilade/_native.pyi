"""The module in Rust. What of it is public is in `enfilade` and `enfilade.farm`, with its types."""

from typing import Any

def __getattr__(name: str) -> Any: ...
