"""The form that checks proofs in the reader's browser, as HTML.

It contains `checker/glid_check.py` as it is, the scripts of `check_here/`, and two examples.
Python and python-flint are fetched when somebody checks a proof.
"""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

import numpy as np

import glid_nb as glid
from glid_nb import course

HERE = Path(__file__).resolve().parent
CHECKER = HERE.parents[1] / "checker" / "glid_check.py"
PARTS = HERE / "check_here"

_FORM = """<div class="check-here">
<p class="start"><button type="button" data-example="right" disabled>Check an example</button>
<button type="button" data-example="forged" disabled>Check a forged proof</button>
<label>Your two files <input type="file" multiple accept=".json" disabled></label></p>
<p class="verdict" role="status">This page needs JavaScript.</p>
<pre hidden></pre>
</div>
"""


def bumped(size: float) -> glid.HarmonicMap:
    """The bar of chapter 09 with one coefficient of psi changed. It folds at 1.6, not at 0.4."""
    identity = glid.HarmonicMap.identity(course.bar())
    psi = np.zeros_like(identity.phi)
    psi[25] = size
    return glid.HarmonicMap(identity.domain, identity.phi, psi)


def examples() -> dict[str, list[str]]:
    """A map with its proof, and a folded map with the proof of the first: only psi was replaced."""
    right, folded = bumped(0.4), bumped(1.6)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "file.json")

        def saved(value: glid.HarmonicMap | glid.Certificate) -> str:
            value.save(file)
            return file.read_text(encoding="utf-8")

        maps = [saved(right), saved(folded)]
        proof = saved(glid.certify(right))
    forged = {
        **json.loads(proof),
        "psi": [[z.real.hex(), z.imag.hex()] for z in folded.psi.tolist()],
    }
    return {"right": [maps[0], proof], "forged": [maps[1], json.dumps(forged)]}


def markup() -> str:
    """The form with everything that it needs."""
    parts = {
        "checker": CHECKER.read_text(encoding="utf-8"),
        "worker": (PARTS / "worker.js").read_text(encoding="utf-8"),
        "examples": examples(),
    }
    data = json.dumps(parts).replace("<", "\\u003c")
    script = (PARTS / "form.js").read_text(encoding="utf-8")
    return (
        f'{_FORM}<script type="application/json" id="check-here-parts">{data}</script>\n'
        f'<script type="module">\n{script}</script>\n'
    )
