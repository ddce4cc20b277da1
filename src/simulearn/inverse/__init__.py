"""Inverse and hybrid design: from where corners are wanted to a grid that brings them there."""

from simulearn.inverse.changes import Change, changes
from simulearn.inverse.checking import Check, check
from simulearn.inverse.goals import Goals, Vertex
from simulearn.inverse.ranking import Ranking, Suggestion, explore, rank
from simulearn.inverse.search import METHODS, Outcome, optimize
from simulearn.inverse.space import Space
from simulearn.inverse.task import (
    Task,
    read_task,
    task_from_dict,
    task_to_dict,
    write_task,
)

__all__ = [
    "METHODS",
    "Change",
    "Check",
    "Goals",
    "Outcome",
    "Ranking",
    "Space",
    "Suggestion",
    "Task",
    "Vertex",
    "changes",
    "check",
    "explore",
    "optimize",
    "rank",
    "read_task",
    "task_from_dict",
    "task_to_dict",
    "write_task",
]
