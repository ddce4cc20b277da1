"""Heating in start and end code: targets within the limits, and nothing that waits hot on the bed.

A nozzle that waits for its temperature while it touches the bed melts into the sheet or leaves a
blob there. A file may be sent to a machine whose nozzle stands anywhere; so it is clear of the bed
only where the code has moved it there.
"""

from simulearn.errors import InputError
from simulearn.fabricate.commands import Command
from simulearn.fabricate.firmware import DIALECTS
from simulearn.fabricate.printer import Printer
from simulearn.fabricate.state import State

COMMANDS = {"M104", "M109", "M140", "M190", "M116", "G4", "M302", "SET_HEATER_TEMPERATURE"}
COMMANDS |= {"G10", "M568"}  # of RepRapFirmware
PAUSES = {"M0", "M1", "M25", "M226", "PAUSE"}  # until somebody presses a button
COMMANDS |= PAUSES
NOZZLE = {"M104", "M109", "G10", "M568", "SET_HEATER_TEMPERATURE"}
OOZES = 175.0  # C, above which a nozzle oozes while it waits
BRIEF = 2.0  # s, a pause that harms nothing


def heat(command: Command, state: State, printer: Printer, where: str) -> str | None:
    """Follow a command that heats or waits, and return a warning or None.

    Raises:
        InputError: a target is beyond the machine's limits.
    """
    name = command.name
    if name == "M302":
        least = command.number("S", where)
        state.cold = least if least is not None else state.cold
        return None
    if name in ("M140", "M190") or "BED" in command.words.get("HEATER", "").upper():
        target = _target(command, printer, where)
        _limit(target, printer.temperature.bed_most, "bed", printer, where)
        state.bed = state.bed if target is None else target
        if name == "M190":
            state.time_passes()
    elif name in PAUSES or name == "M116" or (name == "G4" and _pause(command, where) >= BRIEF):
        state.time_passes()
    elif name in NOZZLE and not _other_tool(command, where):
        _nozzle(command, state, printer, where)
    return _unseen(state) if waits(command, state, printer, where) else None


def waits(command: Command, state: State, printer: Printer, where: str) -> bool:
    """Return whether a command lets a nozzle wait that oozes, after it or already before."""
    target = state.target or 0.0
    if command.name == "M109" and not _other_tool(command, where):
        target = _target(command, printer, where) or 0.0
    elif command.name == "M190":
        off = _target(command, printer, where) == 0 and command.words
        target = 0.0 if off else target
    elif command.name == "G4":
        target = target if _pause(command, where) >= BRIEF else 0.0
    elif command.name != "M116" and command.name not in PAUSES:
        return False
    return target > OOZES


def _nozzle(command: Command, state: State, printer: Printer, where: str) -> None:
    target = _target(command, printer, where)
    _limit(target, printer.temperature.nozzle_most, "nozzle", printer, where)
    if target is None:
        return
    state.target = target
    if command.name == "M109":
        cools = "R" in command.words or printer.firmware in ("klipper", "bambu")
        reached = state.hot is None or target > state.hot or cools
        state.hot = target if reached else state.hot


def _unseen(state: State) -> str | None:
    """Return a warning of a nozzle that waits at a height of which nothing is known."""
    if state.least_z is not None:
        return None
    if state.macro:
        return f"the nozzle waits hot at a height that is not known after {state.macro}"
    return "the nozzle waits hot before homing (G28); make sure that it does not touch the bed"


def _target(command: Command, printer: Printer, where: str) -> float | None:
    if command.name == "SET_HEATER_TEMPERATURE":
        return command.number("TARGET", where) or 0.0
    target = command.number("S", where)
    if printer.firmware == "klipper":  # it reads no R, and takes no number for zero
        if target is None:
            raise InputError(f"{where}: {command.name} has no S, which Klipper takes for 0 C")
        return target
    return target if target is not None else command.number("R", where)


def _pause(command: Command, where: str) -> float:
    """Return how long G4 waits, s."""
    return (command.number("P", where) or 0) / 1000 + (command.number("S", where) or 0)


def _other_tool(command: Command, where: str) -> bool:
    return bool(command.number("P" if command.name in ("G10", "M568") else "T", where))


def _limit(target: float | None, most: float, what: str, printer: Printer, where: str) -> None:
    if target is not None and target > most:
        raise InputError(
            f"{where}: heats the {what} to {target:g} C; that of {printer.name} reaches {most:g} C"
        )


def cold_limit(printer: Printer) -> float:
    """Return below which temperature the firmware moves no filament, C."""
    return DIALECTS[printer.firmware].cold
