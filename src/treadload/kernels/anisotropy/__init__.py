"""Half-spaces whose stiffness depends on direction: their surface, and the stress below it."""
