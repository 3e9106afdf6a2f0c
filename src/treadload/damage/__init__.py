"""What repeated strain does to the road."""

from treadload.damage.fatigue import FatigueLine
from treadload.damage.verdict import Verdict, assess

__all__ = ["FatigueLine", "Verdict", "assess"]
