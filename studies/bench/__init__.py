"""How fast the solver is on this machine."""

from studies.bench import batches, scaling, solving, starting
from studies.machine import machine, rates
from studies.study import Study, Task


def _machine_rows(found: list[dict]) -> list[dict]:
    return [
        {
            "processor": data["processor"],
            "cores": data["cores"],
            "products in double / single precision, Gflop/s": " / ".join(
                f"{data['rates'][kind] / 1e9:.0f}" for kind in ("float64", "float32")
            ),
            "reading, GB/s": f"{data['rates']['bytes'] / 1e9:.0f}",
            "Python": data["python"],
            "JAX": data["versions"]["jax"],
            "computes on": ", ".join(data["devices"]),
        }
        for data in found
    ]


MACHINE = Study(
    "machine",
    lambda _: [Task("here", "", lambda: {**machine(), "rates": rates()})],
    lambda found: {"machine": _machine_rows(found)},
)
STUDIES = (MACHINE, solving.STUDY, solving.DRAGS, starting.STUDY, scaling.STUDY, batches.STUDY)
