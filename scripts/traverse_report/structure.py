"""What a report says of the structure beside its model: its material, its drawings, and a picture of its cross-section."""

import functools
import pathlib

from PIL import Image

from .language import t
from .page import LEFT, RIGHT
from .source import ReportError

LARGEST_FILE = 10_000_000  # bytes
MOST_PIXELS = 2400  # of a drawn picture, in each direction
TALLEST = 2.3  # inches, of the cross-section
TEXTS = ("material", "drawings")


@functools.cache
def picture_of(path):
    """The picture of a PNG or JPEG file."""
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise ReportError(f"{path}: has more than {LARGEST_FILE // 1_000_000} MB; allowed: a smaller picture")
        with Image.open(path, formats=("PNG", "JPEG")) as picture:
            picture.thumbnail((MOST_PIXELS, MOST_PIXELS))
            return picture.convert("RGBA")
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError):
        raise ReportError(f"{path} is no PNG or JPEG picture that can be read") from None


def found(name, places):
    """The picture of a file in the first of these places that has it."""
    path = next((pathlib.Path(place, name) for place in places if pathlib.Path(place, name).is_file()), None)
    if path is None:
        raise ReportError(f"{name}: there is no such file")
    return picture_of(path)


def picture(option, given, own, sources, folder):
    """The picture given on the command line, or that which a scene names; None without one, and with a message if that of
    a scene is elsewhere now."""
    if not given and not own:
        return None
    try:
        return found(given, ["."]) if given else found(own, [folder or ".", *(source.path.parent for source in sources)])
    except ReportError as error:
        if given:
            raise ReportError(f"--{option} {error}") from None
        print(f"the report has no {option.replace('-', ' ')}: {error}; --{option} or --folder names it")
        return None


def read(sources, given, folder):
    """Gives each source its texts and its picture: those of the command line replace those of the scene."""
    for source in sources:
        source.replaced = {f"report_{name}": given[name] for name in ("structure", *TEXTS) if given.get(name)}
        source.cross_section = picture("cross-section", given.get("cross_section"),
                                       source.options.get("report_cross_section"), [source], folder)


def text_of(source, name):
    """One of the texts; empty if there is none. Drawings are a list."""
    text = source.replaced.get(name) or source.options.get(name, "")
    return ", ".join(filter(None, map(str.strip, text.split(",")))) if name == "report_drawings" else text


def draw_cross_section(page, picture):
    """Draws the picture as large as it fits."""
    inches = min((RIGHT - LEFT) / picture.width, TALLEST / picture.height)
    width, height = inches * picture.width, inches * picture.height
    page.text(LEFT, t("Cross-section"), size=8)
    ax = page.framed(LEFT, page.y - height, width, height)
    ax.imshow(picture, aspect="auto", interpolation="none")
    ax.axis("off")
    page.y -= height + 0.15
