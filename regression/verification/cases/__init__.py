"""The families of cases, in the order in which they run."""

FAMILIES = ["hertz", "friction", "press_fit", "punch", "patch", "beam", "estimate"]
