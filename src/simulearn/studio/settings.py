"""What the operator of a studio decides: who may ask, where documents lie, and limits."""

from dataclasses import dataclass, field
from pathlib import Path

from simulearn.files import cores


@dataclass(frozen=True)
class Settings:
    """The settings of a server.

    The limits keep one request from taking the machine for minutes: a learned answer takes 10 ms
    for 12 beams, .15 s for 100 and 7 s for 200.

    Attributes:
        hosts: names under which the server may be reached, besides those of this machine itself;
            "0.0.0.0" or "::" stands for any address that is written as numbers.
        data: the folder of the documents; None: they are kept in memory only.
        body_bytes: of a request.
        document_bytes: of one document.
        file_bytes: of a file that is opened.
        documents: how many are kept.
        grids: in one request.
        joints, beams: of one grid.
        beams_in_all: of all grids of one request.
        fea_beams: of the one grid that finite elements answer at once; larger ones are jobs.
        rank_beams: of a grid whose modifications are ranked.
        simulations: computed at the same time.
        simulation_seconds: longest time of one, also of the first, which compiles kernels.
        waiting: requests that may wait for one of them.
        job_workers: jobs computed at the same time; each may use more than one core.
        jobs_waiting: jobs that may wait.
        job_seconds: longest time of a job.
        export_seconds: longest time to write a file, for those that can be stopped.
    """

    hosts: tuple[str, ...] = ()
    data: Path | None = None
    body_bytes: int = 4 * 2**20
    document_bytes: int = 2**20
    file_bytes: int = 64 * 2**20
    documents: int = 10_000
    grids: int = 256
    joints: int = 300
    beams: int = 300
    beams_in_all: int = 5000
    fea_beams: int = 40
    rank_beams: int = 100
    simulations: int = 2
    simulation_seconds: float = 300.0
    waiting: int = 32
    job_workers: int = field(default_factory=lambda: max(1, cores() // 2))
    jobs_waiting: int = 20
    job_seconds: float = 600.0
    export_seconds: float = 120.0
