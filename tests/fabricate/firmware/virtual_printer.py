"""A machine that reads a print file as its firmware does, and says what would go wrong.

Nothing here uses SimuLearn. Rules are those of the firmware sources: Marlin 2.1 (`gcode.h`,
`G28.cpp`, `G92.cpp`, `M104_M109.cpp`), Prusa Buddy (the same, with unified levelling), Klipper
(`extras/gcode_move.py`, `kinematics/extruder.py`), RepRapFirmware 3 (`GCodes2.cpp`), GPX and
Sailfish (`gpx.c`). Where they differ the firmware decides:

- G90 and G91 set E too in Marlin, not in RepRapFirmware; in Klipper and GPX E is relative where
  either says so.
- M109 S waits for a hot nozzle only; in Klipper also for one that cools.
- G28 drops levelling in Marlin; in the Buddy firmware G29 probes only with P1 and levels only
  after G29 A.
- On a Replicator, homing leaves the axes where the switches are: M132 recalls their places, and
  any G92 before all are known sets them to nought.
- A word that is no command is a macro in Klipper and nothing at all elsewhere; RepRapFirmware's
  macros are run by M98.
"""

import numpy as np
from command_words import LIKE_MARLIN, LONGEST, Command, commands
from virtual_limits import Limits
from virtual_moves import TINY, Mover
from virtual_state import AXES, HIDDEN, NEVER, State, known
from virtual_trace import Trace

NEAR = 1.0  # mm above the bed (or the print) within which a hot nozzle must not wait
OOZES = 175.0  # C above which a waiting nozzle oozes
OOZES_ON_BED = {"prusa": 175.0, "bambu": 150.0}  # those that touch the bed with the nozzle
STOPS = {"M112", "M81", "M997", "M999", "M524", "M23", "M24", "M28", "M32", "M37"}
STOPS_REPRAP = {"M0", "M1", "M2"}  # they end a print
ORIGIN = {"M206", "M428", "M851", "G52", "G54", "G55", "G56", "G57", "G58", "G59"}
ORIGIN |= {"G59.1", "G59.2", "G59.3", "G92.1", "G92.2", "G92.3", "SET_GCODE_OFFSET"}
SCALE = {"M92", "M350"}
OF_KLIPPER = {"M112", "M24", "SET_GCODE_OFFSET"}  # of these, what Klipper knows
WAITS = {"M190", "M116", "M191", "M0", "M1", "M600", "M25", "M226", "G4"}
MOVES_SOMEWHERE = {"G12", "G27", "G29", "G30", "G32", "G33", "G34", "G35", "G38", "G80", "M600"}
MOVES_SOMEWHERE |= {"M125", "M701", "M48"}
HARMLESS = ("EXCLUDE_OBJECT", "SET_PRINT_STATS_INFO", "RESPOND")  # macros that do not move
ARCS = {"G2", "G3", "G5"}


def simulate(text: str, limits: Limits, before: State | None = None) -> Trace:
    """Return what a machine does with a file.

    Args:
        text: the file.
        limits: of the machine.
        before: the state in which an earlier file left it, or None after switching it on.
    """
    return _Machine(limits, before).run(text)


class _Machine:
    def __init__(self, limits: Limits, before: State | None) -> None:
        self.limits, self.firmware = limits, limits.firmware
        self.state = before or State()
        if self.firmware == "sailfish":
            self.state.flow = self.state.speed = 100.0  # GPX reckons with them, file by file
        self.trace = Trace()
        self.danger = self.trace.danger
        self.mover = Mover(limits, self.state, self.trace)
        self.parsed: dict[str, list[Command]] = {}

    def run(self, text: str) -> Trace:
        trace, mover, parsed = self.trace, self.mover, self.parsed
        longest = LONGEST.get(self.firmware)
        for trace.line, trace.text in enumerate(text.split("\n"), 1):
            line = trace.text
            if line.startswith(";"):
                mover.printing |= line.startswith(";LAYER:0")
                continue
            if line not in parsed:
                if longest and len(line.split(";")[0].strip()) > longest:
                    self.danger("long-line", f"the firmware reads {longest} characters")
                parsed[line] = commands(line, self.firmware)
            for command in parsed[line]:
                if command.name in ("G1", "G0"):
                    mover.move(command.words)
                else:
                    self.other(command)
        trace.text = "end of the file"
        self.end()
        trace.beads = np.array(mover.beads).reshape(-1, 6)
        trace.last = self.state
        return trace

    def other(self, command: Command) -> None:
        name, words = command.name, command.words
        s, firmware = self.state, self.firmware
        value = words.get("S")
        if name in ("M104", "M109"):
            self.heat(name == "M109", words)
        elif name in ("M140", "M190"):
            self.heat_bed(name == "M190", words)
        elif name == "SET_HEATER_TEMPERATURE":
            self.heat_named(command)
        elif name == "M106":
            s.fan = 255.0 if value is None else value
        elif name == "M107":
            s.fan = 0.0
        elif name == "M73":
            if words.get("P") is not None:
                self.trace.progress.append(words["P"])
        elif name in ("M82", "M83"):
            s.e_own, s.e_relative = True, name == "M83"
        elif name in ("G90", "G91"):
            s.relative = name == "G91"
            if firmware in LIKE_MARLIN:
                s.e_own, s.e_relative = False, name == "G91"
        elif name in ("G20", "G21"):
            s.inches = name == "G20"
            if s.inches and firmware == "klipper":
                self.danger("inches", "Klipper refuses inches")
        elif name == "G92":
            self.define(words)
        elif name == "G28" or (name in ("G161", "G162") and firmware == "sailfish"):
            self.home(words)
        elif name == "M132" and firmware == "sailfish":
            for axis in AXES:
                if axis in words and s.homed[axis] is NEVER:
                    s.homed[axis] = True
        elif name in ("M84", "M18"):
            if value is None:
                for axis in AXES:
                    if axis in words or not set(words) & set("XYZE"):
                        s.homed[axis] = False
        elif name == "M220":
            s.speed = value if value is not None else s.speed
        elif name == "M221":
            s.flow = value if value is not None else s.flow
        elif name == "M200":
            if words.get("D") or (value or 0) > 0:
                self.danger("scale", "E counts cubic millimetres")
        elif name == "M302":
            self.danger("cold", "cold extrusion is allowed")
        elif name == "M702":
            self.danger("unload", "the filament is unloaded")
            s.hide_place()
        elif name == "G10":
            if set(words) & {"L", "X", "Y", "Z"}:
                self.danger("origin", "the origin is moved")
            elif firmware == "reprap" and "S" in words:
                self.heat(False, words)
            elif not words:
                s.retracted = True
        elif name == "G11":
            s.retracted = False
        elif name in ("M420", "G29", "G29.1", "G29.2"):
            self.level(name, words)
        elif name in ("M204", "M201", "M205", "M566", "SET_VELOCITY_LIMIT"):
            for key, number in words.items():
                if number is not None:
                    s.limits[f"{name} {key}"] = number
        elif name in ARCS:
            self.danger("reach", "an arc; where it leads is not followed")
            s.hide_place()
        elif name in ORIGIN and (firmware != "klipper" or name in OF_KLIPPER):
            self.danger("origin", f"{name} moves the origin")
        elif name in SCALE and firmware != "klipper":
            self.danger("scale", f"{name} changes how far the machine moves")
        elif (name in STOPS and (firmware != "klipper" or name in OF_KLIPPER)) or (
            name in STOPS_REPRAP and firmware == "reprap"
        ):
            self.danger("stops", f"{name} ends the print or switches the machine off")
        elif name == "M98" and firmware == "reprap":
            s.hide()
        elif name in MOVES_SOMEWHERE:
            s.hide_place()
        elif firmware == "klipper" and name[1:2].isalpha() and not name.startswith(HARMLESS):
            s.hide()
        if name in WAITS:
            pause = (words.get("P") or 0) / 1000 + (value or 0)
            if name != "G4" or pause >= 2:
                self.wait()

    def degrees(self, wait: bool, words: dict[str, float | None]) -> float | None:
        """Return the temperature that a command names, as the firmware reads it."""
        if self.firmware == "klipper":
            return words.get("S") or 0.0
        if words.get("S") is None and (wait or self.firmware == "reprap"):
            return words.get("R")
        return words.get("S")

    def heat_named(self, command: Command) -> None:
        """SET_HEATER_TEMPERATURE of Klipper."""
        words = {"S": command.words.get("TARGET")}
        if "HEATER=HEATER_BED" in command.rest.upper():
            self.heat_bed(False, words)
        else:
            self.heat(False, words)

    def heat(self, wait: bool, words: dict[str, float | None]) -> None:
        s = self.state
        cooling = self.firmware == "klipper" or "R" in words
        value = self.degrees(wait, words)
        if value is None:
            return
        if value > self.limits.nozzle_most:
            self.danger("too-hot", f"{value:g} C; the nozzle bears {self.limits.nozzle_most:g}")
        s.target = value
        if s.coldest is not HIDDEN:
            s.coldest = min(s.coldest, value)
        if wait and (value > 0 or cooling):
            s.coldest = value
            self.trace.waits.append((self.trace.line, value))
            self.wait()

    def heat_bed(self, wait: bool, words: dict[str, float | None]) -> None:
        value = self.degrees(wait, words)
        if value is None:
            return
        if value > self.limits.bed_most:
            self.danger("too-hot", f"{value:g} C; the bed bears {self.limits.bed_most:g}")
        self.state.bed = value

    def wait(self) -> None:
        """Check that the nozzle does not ooze onto the bed or the print while the machine waits."""
        s = self.state
        if not known(s.target) or s.target <= OOZES or not known(s.place["Z"]):
            return
        if not self.mover.beads and s.place["Z"] < NEAR:
            self.danger("heats-on-bed", f"{s.target:g} C at {s.place['Z']:g} mm above the bed")

    def define(self, words: dict[str, float | None]) -> None:
        """G92: the file's coordinates of where the machine is."""
        s = self.state
        if self.firmware == "sailfish" and NEVER in s.place.values():
            self.danger("origin", "G92 sets all axes, and where they are is not known")
        given = {key: value for key, value in words.items() if key in "XYZE"}
        if self.firmware == "klipper" and not given:
            given = dict.fromkeys("XYZE", 0.0)
        if given.get("E") is not None:
            s.e = given["E"]
        for axis in AXES:
            if given.get(axis) is None:
                continue
            here = s.place[axis]
            self.danger("origin", f"G92 {axis} moves the origin")
            if known(here):
                s.shift[axis] = here - given[axis]

    def home(self, words: dict[str, float | None]) -> None:
        s = self.state
        axes = [axis for axis in AXES if axis in words] or list(AXES)
        if "Z" in axes:
            self.touch()
            if self.mover.beads and not self.limits.round_bed:  # a delta homes upwards
                self.danger("hits-print", "Z is homed, and the print is on the bed")
        for axis in axes:
            # A Replicator knows where its switches are only after M132.
            s.homed[axis] = NEVER if self.firmware == "sailfish" else True
            s.place[axis] = 0.0 if axis == "Z" and not self.limits.round_bed else NEVER
            s.shift[axis] = 0.0
        if self.firmware == "sailfish":
            s.place["Z"] = NEVER
        if self.firmware in ("marlin", "prusa"):
            s.levelled = False

    def touch(self) -> None:
        """Check that a nozzle that finds the bed by touching it does not ooze."""
        hot, target = OOZES_ON_BED.get(self.firmware), self.state.target
        if hot and known(target) and target > hot:
            self.danger("oozes", f"it touches the bed with a nozzle of {target:g} C")

    def level(self, name: str, words: dict[str, float | None]) -> None:
        s, firmware = self.state, self.firmware
        if name == "M420":
            if words.get("S") is not None:
                s.levelled = bool(words["S"])
            return
        if firmware == "prusa" and name == "G29":
            if "P" in words and words["P"] == 1:
                s.probed = True
                s.hide_place()
                self.touch()
            if "A" in words:
                s.levelled = True
            return
        if name == "G29.2" and firmware == "bambu":
            s.levelled = (words.get("S") or 0) > 0
        if name == "G29":
            s.probed, s.levelled = True, HIDDEN if firmware in ("bambu", "klipper") else True
            s.hide_place()

    def end(self) -> None:
        """Check the state at the end of the file."""
        s = self.state
        if not self.mover.beads:
            self.danger("nothing", "nothing is printed")
        if s.retracted is True:
            s.retracted = HIDDEN  # by how much is a setting of the machine, where it knows G10
        if (known(s.target) and s.target > 0) or (known(s.bed) and s.bed > 0):
            self.danger("heaters-on", f"nozzle {s.target} C, bed {s.bed} C")
        if self.mover.beads and all(known(s.place[axis]) for axis in AXES):
            x_low, y_low, x_high, y_high = self.mover.box
            x, y, z = (s.place[axis] for axis in AXES)
            inside = x_low - 2 <= x <= x_high + 2 and y_low - 2 <= y <= y_high + 2
            if inside and z < self.mover.top + NEAR - TINY:
                self.danger(
                    "rests", f"the hot nozzle stays {z - self.mover.top:g} mm above the print"
                )
