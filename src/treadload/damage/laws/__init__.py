"""How many passes a strain, a stress or a bond bears."""
