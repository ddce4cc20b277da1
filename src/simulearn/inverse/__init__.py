"""Inverse and hybrid design: from where corners are wanted to a grid that brings them there."""

from simulearn.inverse.changes import Change, changes
from simulearn.inverse.checking import Check, check
from simulearn.inverse.figures import search_figures
from simulearn.inverse.found import SearchResult
from simulearn.inverse.front import Answer
from simulearn.inverse.goals import Goals, Vertex
from simulearn.inverse.keeping import Past, Step
from simulearn.inverse.methods import METHODS
from simulearn.inverse.ranking import Ranking, Suggestion, rank
from simulearn.inverse.search import optimize
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
    "Answer",
    "Change",
    "Check",
    "Goals",
    "Past",
    "Ranking",
    "SearchResult",
    "Space",
    "Step",
    "Suggestion",
    "Task",
    "Vertex",
    "changes",
    "check",
    "optimize",
    "rank",
    "read_task",
    "search_figures",
    "task_from_dict",
    "task_to_dict",
    "write_task",
]
