"""Read print files with the programs that print servers use; run by the Python they are in.

    python read_files.py FOLDER

prints as JSON what each of them says of each file in the folder.
"""

import json
import subprocess
import sys
from importlib.metadata import distribution
from pathlib import Path

from bambox.validate import validate_3mf
from gcode_metadata import get_metadata
from gcode_thumbnail_tool import extract_thumbnails_from_gcode_file
from octoprint.util.gcodeInterpreter import gcode


def moonraker(path):
    """Run Moonraker's reader of print files as Moonraker does, in a process of its own."""
    package = distribution("moonraker").locate_file("moonraker")
    script = Path(package) / "components" / "file_manager" / "metadata.py"
    command = [sys.executable, str(script), "-p", str(path.parent), "-f", path.name]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60)
    return json.loads(done.stdout)["metadata"]


def octoprint(path):
    """Analyse a file as OctoPrint does after an upload."""
    analysis = gcode()
    analysis.load(str(path))
    return analysis.get_result()


def prusa(path):
    """Read a file as PrusaLink and PrusaConnect do."""
    found = get_metadata(str(path), save_cache=False)
    return found.data | {"thumbnails": sorted(found.thumbnails)}


def thumbnails(path):
    """Return the sizes of the pictures that OctoPrint's plug-ins find, and who they take it for."""
    found = extract_thumbnails_from_gcode_file(str(path))
    return [list(image.size) for image in found.images] if found else []


def bambox_pack(path):
    """Pack a file for a Bambu printer with all safety checks, and validate the package."""
    package = path.with_suffix(".packed.gcode.3mf")
    program = Path(sys.executable).with_name("bambox")
    command = [str(program), "pack", str(path), "-o", str(package)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    if done.returncode:
        return {"valid": False, "output": done.stdout + done.stderr}
    return bambox_validate(package)


def bambox_validate(path):
    return validate_3mf(path).to_dict()


answers = {}
for path in sorted(Path(sys.argv[1]).iterdir()):
    if path.name.endswith(".gcode.3mf"):
        answers[path.name] = {"bambox": bambox_validate(path)}
    elif path.suffix == ".gcode":
        programs = [moonraker, octoprint, prusa, thumbnails]
        if path.name.startswith("bambu"):
            programs.append(bambox_pack)
        answers[path.name] = {program.__name__: program(path) for program in programs}
print(json.dumps(answers))
