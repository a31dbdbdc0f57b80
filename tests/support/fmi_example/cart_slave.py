"""FMU of the cart."""

from cart.model import Cart
from pldf.fmi.slave import ModelSlave


class PushedCart(ModelSlave):
    """A cart for tests.

    It has every kind of variable.
    """

    about = "A cart pushed by a force"

    @staticmethod
    def create() -> Cart:
        """Return a cart."""
        return Cart()
