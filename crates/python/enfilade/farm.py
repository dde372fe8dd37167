"""One dataset on many machines: the verbs of `enfilade farm` as functions.

    from enfilade import Config, farm

    farm.plan("/shared/job", Config.read("dataset.toml"))
    farm.submit("/shared/job", "slurm", collect="/shared/rooms")
    farm.status("/shared/job")["missing"]
    farm.collect("/shared/job", "/shared/rooms")
"""

from ._declared import explained as _explained
from ._native import farm as _farm

collect = _farm.collect
plan = _explained("PlanOptions", module="enfilade.farm")(_farm.plan)
statistics = _farm.statistics
status = _farm.status
submit = _explained("SubmitOptions", module="enfilade.farm")(_farm.submit)
work = _farm.work

__all__ = ["collect", "plan", "statistics", "status", "submit", "work"]
