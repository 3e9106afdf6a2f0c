"""What is read of a response, and the place in the road where a law reads it."""
