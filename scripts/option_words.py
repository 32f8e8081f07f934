"""The names of varied options in words, for pictures, pages and reports."""

WORDS = {
    "beam_EI": "bending stiffness EI", "beam_EA": "axial stiffness EA", "beam_GA": "shear stiffness GA",
    "beam_GJ": "torsional stiffness GJ",
    "beam_polar_inertia": "polar moment of inertia per length", "track_eccentricity": "eccentricity of the track",
    "beam_mass": "mass per length", "beam_spans": "span lengths", "beam_tension": "tension of the beam",
    "beam_temperature_uniform": "temperature change of the beam",
    "beam_damping_ratios": "damping ratio", "model_damping_ratios": "damping ratio",
    "foundation_vertical_k": "stiffness of the vertical springs",
    "foundation_vertical_c": "damping of the vertical springs",
    "foundation_rotational_k": "stiffness of the rotational springs",
    "foundation_longitudinal_k": "stiffness of the longitudinal springs",
    "support_stiffness": "stiffness of the supports", "support_settlement": "settlement of the supports",
    "track_pad_k": "stiffness of the rail pads", "track_ballast_k": "stiffness of the ballast",
    "track_spacing": "sleeper spacing"}


def option_in_words(name):
    """An option in words: of those without a row in WORDS the parts of the name, as in 'car box mass'."""
    if name in ("train_speed", "load_speed", "track_seed"):
        return name.split("_")[1]
    return WORDS.get(name, name.removeprefix("vehicle_").replace("_", " "))
