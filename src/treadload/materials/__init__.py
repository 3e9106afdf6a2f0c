"""Materials: what deforms, and how."""

from treadload.materials.elastic import Elastic

__all__ = ["Elastic"]
