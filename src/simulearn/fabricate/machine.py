"""The state of a machine as its start and end code changes it, and what must not happen.

Modes, place, filament and heat are followed line by line, in the dialect of the printer's firmware.
A quantity of which nothing is known is None: after a macro that is all of them. What is refused
leaves the reach, moves the origin or an axis whose place the machine does not know, moves cold
filament or draws it out, heats beyond the limits, or ends the print.
"""

from dataclasses import dataclass, field

from simulearn.errors import InputError
from simulearn.fabricate import heat, motion, refused
from simulearn.fabricate.commands import Command
from simulearn.fabricate.firmware import DIALECTS
from simulearn.fabricate.printer import Printer
from simulearn.fabricate.state import State
from simulearn.grid import Message

SHOWN = ("M117", "M118")  # their text is shown, not done
# These move the nozzle to a place of their own choice.
WANDERS = {"G12", "G27", "G29", "G30", "G32", "G33", "G34", "G35", "G38", "G80", "G380"}
WANDERS |= {"M48", "M125", "M701"}
PROBES = WANDERS - {"G12", "G27", "M125", "M701"}
KLIPPER_WANDERS = {"BED_MESH_CALIBRATE", "QUAD_GANTRY_LEVEL", "Z_TILT_ADJUST", "PROBE"}
KLIPPER_WANDERS |= {"SCREWS_TILT_CALCULATE", "BED_TILT_CALIBRATE"}
# Commands of Klipper's own that change nothing of the state.
KLIPPER_STAYS = {"SET_VELOCITY_LIMIT", "SET_PRESSURE_ADVANCE", "SET_PRINT_STATS_INFO", "RESPOND"}
KLIPPER_STAYS |= {"EXCLUDE_OBJECT_DEFINE", "EXCLUDE_OBJECT_START", "EXCLUDE_OBJECT_END"}
KLIPPER_STAYS |= {"SET_FAN_SPEED", "SET_LED", "SET_PIN", "SET_DISPLAY_TEXT", "BED_MESH_PROFILE"}
KLIPPER_STAYS |= {"SAVE_GCODE_STATE", "TEMPERATURE_WAIT", "UPDATE_DELAYED_GCODE", "BED_MESH_CLEAR"}


@dataclass
class Machine:
    """A machine that reads the code of a profile.

    Attributes:
        printer: whose limits hold.
        state: as the lines so far have left it.
        messages: what is not refused, but may be wrong.
    """

    printer: Printer
    state: State
    messages: list[Message] = field(default_factory=list)

    def run(self, command: Command, where: str) -> None:
        """Change the state as a command does.

        Args:
            command: of a line of code.
            where: what to call the line in messages.

        Raises:
            InputError: the command must not stand there.
        """
        name = command.name
        if name in SHOWN:
            return
        refused.check(command, self.printer, where)
        if name in ("G0", "G1"):
            motion.move(command, self.state, self.printer, where)
        elif name in ("G90", "G91"):
            self.state.relative = self.state.e_last = name == "G91"
        elif name in ("M82", "M83"):
            self.state.e_own = self.state.e_last = name == "M83"
        elif name == "G92":
            self._define(command, where)
        elif name == "G28":
            self._home(command, where)
        elif name in ("M84", "M18"):
            self._release(command)
        elif name in ("M220", "M221"):
            self._factor(command, where)
        elif name in ("G10", "G11") and not command.words:
            self.state.retracted = name == "G10"
        elif name in heat.COMMANDS:
            self._message("oozes", where, heat.heat(command, self.state, self.printer, where))
        elif name == "M132" and self.printer.firmware == "sailfish":
            for axis in command.words.keys() & self.state.at_end:
                self.state.homed[axis] = True  # by its memory; the file learns it by a move
        elif name in WANDERS or (self._klipper and name in KLIPPER_WANDERS):
            if name in PROBES or self._klipper:
                self._over_print(command, where)
            self._touches(command, where)
            self.state.lose_place()
            self._level(command)
        elif name == "M420" and command.words.get("S"):
            self.state.levelled = command.words["S"] != "0"
        elif name.startswith("T") and command.is_code:
            self.state.target = self.state.hot = None
        elif name == "M98" or not command.is_code:
            self._macro(command, where)

    @property
    def _klipper(self) -> bool:
        return self.printer.firmware == "klipper"

    def _message(self, code: str, where: str, text: str | None) -> None:
        if text:
            self.messages.append(Message(code, where, f"{where}: {text}"))

    def _define(self, command: Command, where: str) -> None:
        """Follow G92 E; other axes are refused before."""
        if self.printer.firmware == "sailfish" and None in self.state.at.values():
            raise InputError(
                f"{where}: G92 sets all axes on this machine, and where they are is not known; "
                f"write M132 X Y Z A B after homing, and a move to X, Y and Z"
            )
        if self._klipper and "E" not in command.words:
            raise InputError(f"{where}: G92 {refused.ORIGIN}; only G92 E is allowed")
        value = command.number("E", where)
        self.state.e = value if value is not None else self.state.e

    def _home(self, command: Command, where: str) -> None:
        axes = [axis for axis in "XYZ" if axis in command.words] or list("XYZ")
        if "Z" in axes:
            self._over_print(command, where, "G28 X Y")
            self._touches(command, where)
            self.state.least_z = 0.0
            self.state.on_bed = True
        self.state.time_passes()
        for axis in axes:
            self.state.at[axis] = None
            # GPX does not know where the ends of the axes are.
            self.state.homed[axis] = self.printer.firmware != "sailfish"
        self.state.at_end |= set(axes)
        self.state.levelled = False  # so Marlin and Prusa's firmware have it

    def _over_print(self, command: Command, where: str, better: str = "") -> None:
        """Make sure that the nozzle does not come down where the print stands.

        A machine with a round bed is taken for a delta, which homes upwards.
        """
        if self.state.print is None or (self.printer.bed.round and command.name == "G28"):
            return
        raise InputError(
            f"{where}: {command.name} leads down to the bed, on which the print stands; "
            + (f"write {better}" if better else "leave it out")
        )

    def _touches(self, command: Command, where: str) -> None:
        """Warn of a nozzle that oozes onto the bed which it touches to find it."""
        self.state.time_passes()
        touches, target = DIALECTS[self.printer.firmware].touches, self.state.target
        if touches and target is not None and target > touches and "A" not in command.words:
            self._message(
                "oozes",
                where,
                f"{command.name} touches the bed with a nozzle that is heated to {target:g} C and "
                f"oozes; heat it to at most {touches:g} C before",
            )

    def _level(self, command: Command) -> None:
        """Follow G29: in Prusa's firmware P1 probes, and A makes use of it."""
        if command.name != "G29":
            return
        prusa = self.printer.firmware == "prusa"
        self.state.probed |= not prusa or command.words.get("P") == "1"
        self.state.levelled |= not prusa or "A" in command.words

    def _release(self, command: Command) -> None:
        """Follow the motors being switched off: the axes may then be pushed anywhere."""
        if "S" in command.words:  # after some time without a move
            return
        given = [key for key in command.words if key in "XYZE"]
        for axis in given or list("XYZ"):
            if axis in self.state.at:
                self.state.at[axis], self.state.homed[axis] = None, False
                self.state.least_z = None if axis == "Z" else self.state.least_z

    def _factor(self, command: Command, where: str) -> None:
        percent = command.number("S", where)
        if percent is None or percent == 100:
            return
        what = "speed" if command.name == "M220" else "flow"
        self._message(
            "override",
            where,
            f"{command.text} sets the {what} to {percent:g} %; the file sets it back to 100 % "
            f"before the print, as the curl was measured with",
        )

    def _macro(self, command: Command, where: str) -> None:
        dialect = DIALECTS[self.printer.firmware]
        if self._klipper and command.name in KLIPPER_STAYS:
            return
        if command.name != "M98" and not dialect.macros:
            raise InputError(
                f"{where}: {command.text.split()[0]} is no command of {dialect.title}; if the "
                f'machine runs Klipper, write firmware = "klipper" at the top of the profile'
            )
        self.state.forget(command.text.split()[0])
