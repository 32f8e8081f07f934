"""The annex: mesh and error estimates, the notes of the program and the options of the computation."""

from .language import capital, num, t
from .page import GREY, LEFT, table

ESTIMATED = {"deflection": "deflection", "acceleration": "deck acceleration, unfiltered",
             "acceleration_lowpass": "deck acceleration, low-pass filtered", "moment": "bending moment",
             "shear": "shear force",
             "wheel_force": "wheel force", "axial_displacement": "longitudinal displacement",
             "axial_force": "axial force",
             "frequency": "natural frequency"}


def estimates(source):
    """Rows (quantity, estimated relative error)."""
    rows = []
    for name, words in ESTIMATED.items():
        error = source.summary.get(f"expected_error_{name}")
        if error is not None:
            rows.append((t(words), num(error, ".1g")))
        elif name in ("deflection", "acceleration", "moment") or (name == "wheel_force" and len(source.model.train)):
            rows.append((t(words), t("not estimated")))
    return rows


def sheet(report, source):
    report.annex()
    page = report.page(t("Mesh, time step and error estimates"))
    if not source.is_rail:
        page.text(LEFT, t("The estimated errors are those of mesh, modes and time step only. They do not include the "
                          "error of the model, the material values and the loads."), size=8, colour=GREY)
        page.y -= 0.05
        columns = [(t("peak values of"), 2.6, "left"), (t("estimated relative error"), 4.2, "left")]
        page = table(report, page, columns, [(capital(words), error) for words, error in estimates(source)])
    if source.model.notes:
        page.text(LEFT, t("Notes of the program on its model (in English)"), size=10, weight="bold")
        page.y -= 0.05
        page = table(report, page, [("", 0.3, "left"), ("", 6.5, "left")],
                     [(str(i), note) for i, note in enumerate(source.model.notes, 1)])
    rows = [(name, value) for name, value in sorted(source.options.items())
            if not name.startswith(("vehicle_", "output_file", "report_"))]
    page = report.page(t("Options of the computation"))
    table(report, page, [(t("option"), 2.4, "left"), (t("value"), 4.4, "left")], rows, size=7)
