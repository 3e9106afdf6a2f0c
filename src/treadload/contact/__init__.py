"""Contact of tire and road: pressure, shear, stick and slip."""

from treadload.contact.solution import Contact
from treadload.contact.solve import solve_contact
from treadload.contact.wheel import Rolling

__all__ = ["Contact", "Rolling", "solve_contact"]
