"""What bounds the shear: laws of friction, where on the road they hold, and the heat that they make."""
