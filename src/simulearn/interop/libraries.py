"""Where the page's libraries lie: three.js and Vue, as the package NiceGUI brings them."""

from importlib.util import find_spec
from pathlib import Path

from simulearn.errors import InputError
from simulearn.extras import missing

FILES = {  # name in the page -> place in the package
    "vue.js": "static/vue.esm-browser.prod.js",
    "three.js": "elements/scene/dist/index.js",
}


def libraries() -> dict[str, Path]:
    """Return the file of each library of the page.

    Raises:
        InputError: the package is not installed, or is of a version that does not have them.
    """
    spec = find_spec("nicegui")  # found without being imported, which would take a second
    if spec is None or spec.origin is None:
        raise missing("interactive pages need", "nicegui")
    folder = Path(spec.origin).parent
    found = {name: folder / place for name, place in FILES.items()}
    for path in found.values():
        if not path.is_file():
            raise InputError(
                f"{path} is missing: this version of NiceGUI is not one that SimuLearn knows; "
                "pip install 'simulearn[studio]' installs the right one",
                "package-missing",
            )
    return found
