"""Laws for treadload that live in a package of their own."""
