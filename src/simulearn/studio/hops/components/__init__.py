"""The components that Grasshopper can have of the studio."""

from simulearn.studio.hops.components import gcode, optimise, poll, rank, simulate, validate

COMPONENTS = {
    one.COMPONENT.path: one.COMPONENT for one in (validate, simulate, rank, optimise, poll, gcode)
}
