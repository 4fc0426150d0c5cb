"""Parameters that each keyword may have: those that the other files read or list themselves, and those that leave the answer as it is.

What is not here changes what a card means in a way that nobody has thought of, so that it is listed as left out.
"""

LOADS = {"OP", "AMPLITUDE", "USER", "SUBMODEL", "SECTOR", "LOADCASE", "REGION", "TIMEDELAY", "FILE", "MASSFLOW", "BCASE", "FIXEDDOF"}
SETS = {"NSET", "ELSET", "GENERATE", "INSTANCE", "INTERNAL", "UNSORTED"}
DATA = {"INPUT"}
DEFAULTS = {("DISTRIBUTING", "WEIGHTINGMETHOD"): "UNIFORM", ("DLOAD", "CONSTANTRESULTANT"): "NO", ("DSLOAD", "CONSTANTRESULTANT"): "NO"}
KNOWN = {
    "NODE": {"NSET", "SYSTEM"},
    "ELEMENT": {"TYPE", "ELSET"},
    "NSET": SETS,
    "ELSET": SETS,
    "SURFACE": {"NAME", "TYPE", "INTERNAL", "COMBINE", "INSTANCE"},
    "PART": {"NAME"},
    "ASSEMBLY": {"NAME"},
    "INSTANCE": {"NAME", "PART"},
    "MATERIAL": {"NAME", "DESCRIPTION", "RTOL"},
    "ELASTIC": {"TYPE"},
    "EXPANSION": {"TYPE", "ZERO"},
    "DENSITY": set(),
    "SOLIDSECTION": {"ELSET", "MATERIAL", "ORIENTATION", "CONTROLS", "OFFSET"},
    "ORIENTATION": {"NAME", "SYSTEM", "DEFINITION"},
    "TRANSFORM": {"NSET", "TYPE"},
    "SPRING": {"ELSET", "NONLINEAR"},
    "SURFACEINTERACTION": {"NAME", "UNSYMM"},
    "SURFACEBEHAVIOR": {"PRESSURE-OVERCLOSURE", "NOSEPARATION", "AUGMENTEDLAGRANGE", "DIRECT", "PENALTY"},
    "FRICTION": {"ROUGH", "TAUMAX", "ANISOTROPIC", "USER", "EXPONENTIALDECAY", "SLIPTOLERANCE", "ELASTICSLIP", "LAGRANGE"},
    "CONTACTPAIR": {
        "INTERACTION", "TYPE", "ADJUST", "TIED", "SMALLSLIDING", "CPSET", "MECHANICALCONSTRAINT", "SUPPLEMENTARYCONSTRAINTS", "TRACKING",
        "EXTENSIONZONE", "NOTHICKNESS", "SLIDINGTRANSITION", "SMOOTH", "OP",
    },
    "CLEARANCE": {"SLAVE", "MASTER", "VALUE", "CPSET"},
    "TIE": {
        "NAME", "POSITIONTOLERANCE", "ADJUST", "TYPE", "NOROTATION", "NOTHICKNESS", "CYCLICSYMMETRY", "MULTISTAGE", "FLUIDPERIODIC",
    },
    "CYCLICSYMMETRYMODEL": {"N", "TIE", "NGRAPH", "ELSET"},
    "CONTACT": {"OP"},
    "CONTACTINCLUSIONS": {"ALLEXTERIOR"},
    "CONTACTPROPERTYASSIGNMENT": set(),
    "COUPLING": {"REFNODE", "SURFACE", "CONSTRAINTNAME"},
    "KINEMATIC": set(),
    "DISTRIBUTING": {"COUPLING"},
    "RIGIDBODY": {"REFNODE", "ROTNODE", "NSET", "ELSET", "POSITION"},
    "PRE-TENSIONSECTION": {"SURFACE", "NODE", "ELEMENT"},
    "AMPLITUDE": {"NAME", "DEFINITION", "VALUE", "TIME", "SHIFTX", "SHIFTY", "SMOOTH"},
    "INITIALCONDITIONS": {"TYPE"},
    "BOUNDARY": LOADS | {"TYPE", "FIXED"},
    "CLOAD": LOADS | {"FOLLOWER"},
    "DLOAD": LOADS,
    "DSLOAD": LOADS | {"FOLLOWER"},
    "TEMPERATURE": LOADS,
    "STEP": {"NAME", "NLGEOM", "PERTURBATION", "INC", "INCF", "UNSYMM", "CONVERTSDI", "EXTRAPOLATION", "AMPLITUDE"},
    "STATIC": {"DIRECT", "SOLVER", "EXPLICIT", "RIKS", "STABILIZE", "ALLSDTOL", "CONTINUE", "FACTOR", "LONGTERM"},
    "RESTART": {"WRITE", "FREQUENCY", "OVERLAY", "OVERWRITE", "NUMBERINTERVAL", "TIMEMARKS"},
}  # fmt: skip


def report(cards, model, kept):
    """Lists what is unknown; `kept`: the *STEP cards of steps that are translated, for of the others all is left out."""
    in_kept = True
    for card in cards:
        if card.name == "STEP":
            in_kept = any(card is k for k in kept)
        if in_kept:
            for unknown in sorted(card.parameters.keys() - KNOWN.get(card.name, card.parameters.keys()) - DATA):
                if card.get(unknown).upper() != DEFAULTS.get((card.name, unknown)):
                    model.leave_out(card, f"{unknown} is not understood")
        if card.name == "ENDSTEP":
            in_kept = True
