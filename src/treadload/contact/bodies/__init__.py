"""What a surface does under pressure and shear."""
