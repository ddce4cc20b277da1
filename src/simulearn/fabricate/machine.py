"""The state of a machine while a profile's code runs: modes, place, filament, heat.

Each command changes the state as the firmware would; what would break something is refused with
its line. What a macro does cannot be read: after one, what it may have changed is not known (None)
until the code sets it. Sources: Marlin 2.1 (gcode/*), Prusa-Firmware-Buddy, Klipper (gcode_move.py,
heaters.py), RepRapFirmware 3 (GCodes2.cpp), GPX 2.6 (gpx.c).
"""

from collections.abc import Callable
from math import hypot

from simulearn.errors import InputError
from simulearn.fabricate.command import Command, commands
from simulearn.fabricate.printer import Printer

AXES = "XYZ"
ROUNDING = 1e-6
CLEAR = 2.0  # mm above the bed at which a hot nozzle does no harm
LIFT = 10.0  # mm, how far it is lifted where it is not clear
MOST_DRAWN = 20.0  # mm of filament; who draws back more unloads it
MOST_FED = 250.0  # mm of filament in one move; a purge takes less
TOUCHES = ("prusa", "bambu")  # their nozzle is the probe
COLDEST_OOZE = 180.0  # C; a nozzle this hot smears where it touches the bed
# By these firmwares G90 and G91 set how E is counted too.
E_FOLLOWS = ("marlin", "prusa", "bambu")
ORIGIN = "moves the origin, and with it the print"
SAVES = "changes what the machine remembers"
FILES = "starts or changes another file"
FORBIDDEN = {
    "G20": "counts in inches, and files are in millimetres",
    "G52": ORIGIN,
    "M206": ORIGIN,
    "M428": ORIGIN,
    "SET_GCODE_OFFSET": ORIGIN,
    "M851": "moves the probe, and with it the height of the print",
    "M290": "moves the nozzle against the bed",
    "M92": "changes how far the machine moves",
    "M302": "lets filament be fed through a cold nozzle",
    "M303": "heats to find its own constants",
    "M500": SAVES,
    "M501": SAVES,
    "M502": SAVES,
    "SAVE_CONFIG": SAVES,
    "M600": "waits for other filament",
    "M702": "unloads the filament",
    "M112": "is an emergency stop",
    "M23": FILES,
    "M28": FILES,
    "M30": FILES,
    "M32": FILES,
}
# Coordinate systems G54 to G59.3, and what else of G92 there is.
SYSTEMS = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")
# Commands of Klipper that neither move nor heat.
STILL = ("SET_VELOCITY_LIMIT", "SET_PRESSURE_ADVANCE", "SET_PRINT_STATS_INFO", "SET_DISPLAY_TEXT")
# G-codes that stay where they are; all others that are not followed end somewhere.
STAYS = ("G4", "G11", "G17", "G21", "G53", "G94")
HOMES = ("G28", "G161", "G162")
OFF = ("M18", "M84")
MOTORS = "XYZE"


class Machine:
    """A machine that code is run on.

    Args:
        printer: what its reach, limits and firmware are.
        end: whether it is the code after a print, at whose beginning `place` is known.
        place: (3,) x, y, z of the nozzle, mm; None where it is not known.
        height: of the print below it, mm.
        drawn: mm of filament that are drawn back.
    """

    def __init__(
        self,
        printer: Printer,
        place: tuple[float, float, float] | None = None,
        height: float = 0.0,
        drawn: float = 0.0,
    ) -> None:
        self.printer = printer
        self.end = place is not None
        self.height = height
        self.at: dict[str, float | None] = dict.fromkeys(AXES)
        if place is not None:
            self.at = dict(zip(AXES, place, strict=True))
        # Whether an axis knows where it is; None after a macro, which may have homed it.
        self.homed: dict[str, bool | None] = dict.fromkeys(AXES, self.end)
        self.relative: bool | None = False
        self.relative_e: bool | None = printer.extruder.extrusion == "relative"
        self.e: float | None = 0.0
        self.drawn = drawn
        self.fed = 0.0
        self.target: float | None = 0.0
        self.hot: float | None = None if self.end else 0.0  # C for which the code has waited
        self.unknown = False  # whether a macro has run
        self.before_homing = ""  # where an axis was moved before it was homed
        bed, reach = printer.bed, printer.reach
        self.reach = {
            "X": _joined((bed.low[0], bed.high[0]), reach.x),
            "Y": _joined((bed.low[1], bed.high[1]), reach.y),
            "Z": _joined((0.0, bed.height), reach.z),
        }
        self.known: dict[str, Callable[[Command, str], None]] = {
            "G0": self._move,
            "G1": self._move,
            "G10": self._offset,
            "G90": self._mode,
            "G91": self._mode,
            "G92": self._set,
            "M82": self._count,
            "M83": self._count,
            "M104": self._heat,
            "M109": self._heat,
            "M140": self._heat_bed,
            "M190": self._heat_bed,
            "M200": self._volumetric,
            "M211": self._ends,
            "M221": self._ends,
            "G132": self._recall,
            "M132": self._recall,
            **dict.fromkeys(HOMES, self._home),
            **dict.fromkeys(OFF, self._off),
        }

    @property
    def clear(self) -> bool:
        """Whether the nozzle is known to be clear of the bed."""
        z = self.at["Z"]
        return z is not None and z >= CLEAR

    def run(self, line: str, where: str) -> list[str]:
        """Run a line of code, without its comment.

        Returns:
            Lines that must stand before it: the nozzle is lifted off the bed before it is heated.

        Raises:
            InputError: it would break something, or a number is none.
        """
        before: list[str] = []
        for command in commands(line, where):
            if command.head == "M109" and self._needs_lift(command, where):
                before += self._lifted()
            self._run(command, where)
        return before

    def finish(self, where: str) -> None:
        """Make sure that a print may begin after the start code.

        Raises:
            InputError: an axis was never homed.
        """
        lost = [axis for axis in AXES if self.homed[axis] is False]
        if lost:
            raise InputError(
                f"{where}: {', '.join(lost)} is not homed when the print begins; home it (G28), "
                f"and leave the motors on"
            )
        if self.before_homing:
            raise InputError(
                f"{self.before_homing}: moves before the axis is homed (G28), when nobody knows "
                f"where it is"
            )

    def _run(self, command: Command, where: str) -> None:
        head = command.head
        if head in FORBIDDEN:
            raise InputError(f"{where}: {head} {FORBIDDEN[head]}; leave it out")
        if head in SYSTEMS or head.startswith("G92."):
            raise InputError(f"{where}: {head} {ORIGIN}; leave it out")
        if head in ("G2", "G3"):
            raise InputError(f"{where}: an arc (G2, G3) cannot be checked; use straight moves")
        if head in self.known:
            self.known[head](command, where)
        elif head == "SET_HEATER_TEMPERATURE":
            self._heater(command, where)
        elif not command.numbered and head not in STILL:
            self._macro()
        elif head.startswith("G") and command.numbered and head not in STAYS:
            self._touches(command, where)
            self.at = dict.fromkeys(AXES)  # levelling, parking, wiping: it ends somewhere

    def _macro(self) -> None:
        self.unknown = True
        self.at = dict.fromkeys(AXES)
        self.homed = {axis: homed or None for axis, homed in self.homed.items()}
        self.relative = self.relative_e = self.e = self.target = self.hot = None

    def _move(self, command: Command, where: str) -> None:
        for letter, text in command.words:
            if letter in "XYZE" and not text:  # some firmwares take that for zero
                raise InputError(f"{where}: what follows {letter} is not a number")
        for axis in AXES:
            value = command.value(axis, where)
            if value is not None:
                self._travel(axis, value, where)
        command.value("F", where)
        x, y = self.at["X"], self.at["Y"]
        bed = self.printer.bed
        if (
            bed.shape == "round"
            and x is not None
            and y is not None
            and ("X" in command or "Y" in command)
        ):
            away, most = hypot(x - bed.middle[0], y - bed.middle[1]), bed.width / 2
            beyond = self.printer.reach.x is not None or self.printer.reach.y is not None
            if away > most + ROUNDING and not beyond:
                raise InputError(
                    f"{where}: leads {away:.4g} mm from the middle; {self.printer.name} reaches "
                    f"{most:g}"
                )
        if (feed := command.value("E", where)) is not None:
            self._feed(feed, where)

    def _travel(self, axis: str, value: float, where: str) -> None:
        if self.relative is None:
            raise InputError(
                f"{where}: whether {axis}{value:g} is absolute or relative is not known after a "
                f"macro; write G90 or G91 before it"
            )
        before = self.at[axis]
        if self.relative:
            if before is None and axis == "Z" and value >= 0:
                return  # up is safe from anywhere
            if before is None:
                raise InputError(
                    f"{where}: {axis}{value:g} is relative to a place that is not known here; "
                    f"move there in absolute numbers (G90) first"
                )
            value += before
        least, most = self.reach[axis]
        if not least - ROUNDING <= value <= most + ROUNDING:
            raise InputError(
                f"{where}: leads to {axis} {value:g} mm; {self.printer.name} reaches "
                f"{least:g} to {most:g}"
            )
        if self.end and axis == "Z" and value < self.height - ROUNDING:
            raise InputError(
                f"{where}: leads to Z {value:g} mm, into the print, which is {self.height:g} mm "
                f"high"
            )
        if self.homed[axis] is False and not self.before_homing:
            self.before_homing = where
        self.at[axis] = value

    def _feed(self, value: float, where: str) -> None:
        if self.relative_e is None or (not self.relative_e and self.e is None):
            change = min(value, 0.0)  # at worst it counts from here
            self.e = None
        elif self.relative_e:
            change = value
            self.e = None if self.e is None else self.e + value
        else:
            change, self.e = value - (self.e or 0.0), value
        if change and self.hot is not None and self.hot < self.printer.temperature.nozzle_least:
            raise InputError(
                f"{where}: moves filament before the nozzle is hot; wait with "
                f"M109 S{{temperature}} before it"
            )
        self.drawn = max(self.drawn - change, 0.0)
        self.fed += max(change, 0.0)
        if self.drawn > MOST_DRAWN + ROUNDING:
            raise InputError(
                f"{where}: {self.drawn:.4g} mm of filament are drawn back in all, which unloads "
                f"it; {MOST_DRAWN:g} mm are the most (is E absolute here, M82, or relative, M83?)"
            )
        if change > MOST_FED + ROUNDING:
            raise InputError(
                f"{where}: feeds {change:.4g} mm of filament at once; {MOST_FED:g} mm are the most "
                f"(is E absolute here, M82, or relative, M83?)"
            )

    def _mode(self, command: Command, where: str) -> None:
        self.relative = command.head == "G91"
        if self.printer.firmware in E_FOLLOWS:
            self.relative_e = self.relative

    def _count(self, command: Command, where: str) -> None:
        self.relative_e = command.head == "M83"

    def _set(self, command: Command, where: str) -> None:
        for letter, text in command.words:
            if letter in AXES:
                raise InputError(f"{where}: G92 {letter}{text} {ORIGIN}; only G92 E is allowed")
        if not command.words:
            raise InputError(f"{where}: G92 alone {ORIGIN}; only G92 E is allowed")
        if (value := command.value("E", where)) is not None:
            self.e = value

    def _offset(self, command: Command, where: str) -> None:
        for letter, text in command.words:  # G10 alone draws filament back
            if letter in "LXYZ":
                raise InputError(f"{where}: G10 {letter}{text} {ORIGIN}; leave it out")

    def _home(self, command: Command, where: str) -> None:
        axes = [axis for axis in AXES if axis in command] or list(AXES)
        if "Z" in axes:
            self._touches(command, where)
            if self.end and self.printer.bed.shape != "round":
                raise InputError(
                    f"{where}: {command.head} homes Z after the print, and would bring the nozzle "
                    f"down on it; home X and Y only"
                )
        for axis in axes:
            self.at[axis] = None
            self.homed[axis] = True

    def _recall(self, command: Command, where: str) -> None:
        """M132: where the axes are, as the machine remembers it."""
        for axis in AXES:
            if axis in command:
                self.at[axis] = None

    def _touches(self, command: Command, where: str) -> None:
        """Refuse a probe by a hot nozzle; Bambu's T says that it may be hot."""
        if self.printer.firmware not in TOUCHES or command.head not in ("G28", "G29"):
            return
        if "T" not in command and self.target is not None and self.target > COLDEST_OOZE:
            raise InputError(
                f"{where}: {command.head} touches the bed with a nozzle that is heated to "
                f"{self.target:g} C and oozes; heat to at most {COLDEST_OOZE:g} C before it"
            )

    def _off(self, command: Command, where: str) -> None:
        named = [axis for axis in MOTORS if axis in command]
        if "S" in command and not named:
            return  # after how long a time
        for axis in AXES:
            if axis in named or not named:
                self.homed[axis], self.at[axis] = False, None

    def _heat(self, command: Command, where: str) -> None:
        value = command.value("S", where)
        if value is None and command.head == "M109":
            value = command.value("R", where)
        if value is not None:
            self._nozzle(value, command.head == "M109", where)

    def _heater(self, command: Command, where: str) -> None:
        named = command.named
        heater = named.get("HEATER", "")
        try:
            value = float(named.get("TARGET", "0"))
        except ValueError as error:
            raise InputError(f"{where}: TARGET is not a number") from error
        if heater == "extruder":
            self._nozzle(value, False, where)
        elif heater == "heater_bed":
            self._bed(value, where)

    def _nozzle(self, value: float, waits: bool, where: str) -> None:
        most = self.printer.temperature.nozzle_most
        if not value <= most:
            raise InputError(
                f"{where}: heats the nozzle to {value:g} C; that of {self.printer.name} stands "
                f"{most:g}"
            )
        if self.end and value > 0:
            raise InputError(f"{where}: heats the nozzle after the print; leave it out")
        self.target = value
        if self.hot is not None:
            self.hot = value if waits else min(self.hot, value)
        elif waits:
            self.hot = value

    def _heat_bed(self, command: Command, where: str) -> None:
        value = command.value("S", where)
        if value is None:
            value = command.value("R", where)
        if value is not None:
            self._bed(value, where)

    def _bed(self, value: float, where: str) -> None:
        most = self.printer.temperature.bed_most
        if not value <= most:
            raise InputError(
                f"{where}: heats the bed to {value:g} C; that of {self.printer.name} reaches "
                f"{most:g}"
            )
        if self.end and value > 0:
            raise InputError(f"{where}: heats the bed after the print; leave it out")

    def _volumetric(self, command: Command, where: str) -> None:
        diameter = command.value("D", where)
        if diameter is None or diameter != 0:  # M200 D0 counts E as a length
            raise InputError(f"{where}: M200 counts E as a volume; leave it out, or write M200 D0")

    def _ends(self, command: Command, where: str) -> None:
        """M211 S0, and M221 with an axis on a Bambu, let the machine move beyond its ends."""
        off = command.head == "M211" and command.value("S", where) == 0
        if off or (command.head == "M221" and any(axis in command for axis in AXES)):
            raise InputError(
                f"{where}: {command.head} lets the machine move beyond its ends; leave it out"
            )

    def _needs_lift(self, command: Command, where: str) -> bool:
        value = command.value("S", where) or command.value("R", where) or 0.0
        hot = value >= self.printer.temperature.nozzle_least and not self.end
        return hot and not self.clear and self.homed["Z"] is True and self.relative is not None

    def _lifted(self) -> list[str]:
        """Return the lines that lift the nozzle, and leave the modes as they are."""
        lines = [f"{lift(self.printer)} ; SimuLearn: off the bed before the nozzle is hot"]
        self.at["Z"] = min(LIFT, self.printer.bed.height)
        if self.relative:
            lines = ["G90", *lines, "G91"]
            if self.printer.firmware in E_FOLLOWS and self.relative_e is False:
                lines.append("M82")
        return lines


def lift(printer: Printer) -> str:
    """Return the absolute move that takes the nozzle off the bed."""
    return f"G0 Z{min(LIFT, printer.bed.height):g} F{printer.motion.speed_z:g}"


def _joined(bed: tuple[float, float], reach: tuple[float, float] | None) -> tuple[float, float]:
    return bed if reach is None else (min(bed[0], reach[0]), max(bed[1], reach[1]))
