"""Return maps of plastic and viscoplastic laws: from a trial stress to the state that the yield surface allows."""
