"""Cracks in a plane section of layers: dislocations, what they do to the faces, stress intensity with closure."""
