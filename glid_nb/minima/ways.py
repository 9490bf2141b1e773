"""The other ways to a minimum, a table: when each is tried, what it solves and when it is given up.

The energy has many local minima. How a map turns the lines between handles
(:mod:`glid_nb.minima.handle_turns`) mostly decides which one it is near. Most ways therefore lead
the targets along chosen turns, over waypoints. The numbers were found on 323 poses
(docs/comparisons.md). A number without a comment was chosen there by hand, and no measurement of it
alone was kept.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from glid_nb.energies import MIPS, SymmetricDirichlet
from glid_nb.harmonic import as_complex
from glid_nb.minima.handle_turns import HandleTurns, handle_turns
from glid_nb.minima.known import (
    HIGH_ENERGY,
    HIGHEST_ENERGY,
    LEAST_ISOMETRY,
    SAME_ENERGY,
    Known,
    is_above,
)
from glid_nb.minima.reversals import reversals
from glid_nb.minima.waypoints import Waypoint, waypoints
from glid_nb.solvers.method import Inputs

# Excess energy grows faster than time ** GROWTH while lines turn. A waypoint above that, as a share
# of the best map's excess, would end above it.
GROWTH = 1.5
# A waypoint's iterations. With three instead of six the first one overshoots, so that ways are
# given up that would end lower: a star at 4.06 instead of 3.83.
_WAYPOINT_ITERATIONS = 6
_STAGE_TOLERANCE = 1e-3
# The waypoints' fractions of lambda. With the usual 1e5 the first Newton steps rush the handles to
# their targets, whatever that does to the shape.
_WEIGHTS = (1e-5, 1e-3, 1e-1)


class Problem(NamedTuple):
    """One of a way's problems, which starts from the result of the one before."""

    inputs: Inputs
    time: float = 1.0
    """How far it is on the way to the targets."""


@dataclass(frozen=True)
class Case:
    """One attempt of a way."""

    place: str = ""
    """For the name: at which handles."""
    turns: HandleTurns | None = None
    """The turns along which targets are led; None for the first map's."""
    lines: tuple[int, ...] = ()
    """Children whose lines are led in another manner."""
    ratio: float = 1.0
    """What it costs, predicted as a multiple of what the best map costs."""
    doubt: float = 1.0
    """The prediction may be too high by this factor."""

    def led_along(self, known: Known) -> HandleTurns:
        return known.turns if self.turns is None else self.turns


def _always(_: Known) -> bool:
    return True


def _once(_: Known) -> Iterable[Case]:
    return [Case()]


@dataclass(frozen=True)
class Way:
    """A way to another minimum."""

    name: str
    """As in :attr:`glid_nb.Result.attempts`; ``{}`` stands for the case's place."""
    problems: Callable[[Known, Case], list[Problem]]
    """What is solved, the problem that was asked for last."""
    when: Callable[[Known], bool] = _always
    """Whether it is tried at all."""
    cases: Callable[[Known], Iterable[Case]] = _once
    """Its attempts, the likeliest first. A generator may look at the best map between them."""
    cost: float | None = None
    """Try it only if it gains enough should it cost this share of the best map's excess energy, or
    this share of what the case predicts; None: always."""
    limit: float | None = None
    """Give it up at a waypoint that costs more than this times ``time ** GROWTH`` of the best map's
    excess energy; None: never."""
    enough: float | None = None
    """End the search after it if the best energy is at most this multiple of an isometry's."""

    def pays(self, known: Known, case: Case) -> bool:
        return self.cost is None or known.gains(self.cost * case.ratio / case.doubt)

    def limit_of(self, case: Case) -> float | None:
        """The limit, larger in proportion if the case is predicted to cost less than the best map:
        it may then cost more on the way."""
        return None if self.limit is None else self.limit / min(case.ratio, 1)


# From the symmetric Dirichlet minimum.


def _without_barrier(known: Known) -> bool:
    """Whether the energy may have run against the limit of local injectivity far from its targets:
    ARAP has no barrier, MIPS none against a shape that shrinks to nothing."""
    energy = known.inputs.energy
    return known.hopeless and (not energy.is_barrier or isinstance(energy, MIPS))


def _dirichlet_first(known: Known, _: Case) -> list[Problem]:
    return [
        Problem(replace(known.inputs, energy=SymmetricDirichlet())),
        Problem(known.inputs),
    ]


# The other way round.

# Lines that turn by at least so much may turn the other way round; the second, if the first map's
# energy is high.
FAR = np.deg2rad(80), np.deg2rad(60)
# The predicted costs are as doubtful as the first map's energy is above this multiple of an
# isometry's.
_SURE = 1.1
# So many attempts without a gain end this way.
_MOST_MISSES = 3


def _other_turns(known: Known) -> Iterator[Case]:
    """Lines to turn the other way round, the cheapest first.

    After a gain the better map says which lines may turn on from there. What a choice of turns
    costs is the least that any map so far predicts.
    """
    now = known.turns
    least_costs = dict[tuple[float, ...], float]()
    seen = {now.key()}
    misses = 0
    isometry = max(known.isometry, LEAST_ISOMETRY)
    doubt = max(known.first.energy / isometry / _SURE, 1)

    def choices() -> list[tuple[tuple[int, ...], tuple[float, ...], float]]:
        excess = max(known.excess, SAME_ENERGY)
        ratios = reversals(now, FAR[int(known.high)]).items()
        found = [(lines, now.key(lines), ratio) for lines, ratio in ratios]
        for _, key, ratio in found:
            least_costs[key] = min(ratio * excess, least_costs.get(key, np.inf))
        return [(lines, key, least_costs[key] / excess) for lines, key, _ in found]

    left = choices()
    while left and misses < _MOST_MISSES:
        lines, key, ratio = left.pop(0)
        best, tried = known.best, len(known.tried)
        if key not in seen:
            place = ", ".join(map(str, lines))
            yield Case(place=place, turns=now, lines=lines, ratio=ratio, doubt=doubt)
        seen.add(key)
        if known.best is not best:
            now = known.better = handle_turns(known.best.map, known.inputs.pose)
            left = choices()
        elif len(known.tried) > tried:
            misses += 1


def _turned_back(known: Known, case: Case) -> list[Problem]:
    return _led(known, waypoints(case.led_along(known), case.lines))


# Along an arc.


def _curled(known: Known) -> list[Case]:
    """Free ends that curl. One that is wound up is led the other way round instead: arcs there
    were tried on 20 more poses, and none of them ended lower."""
    lines = [line for line in known.turns.lines if line.curled and not line.wound]
    return [Case(place=str(line.child), lines=(line.child,)) for line in lines]


def _arc(known: Known, case: Case) -> list[Problem]:
    return _led(known, waypoints(known.turns, arc=case.lines[0]))


# Without its angles first.


def _wants_angles(known: Known) -> bool:
    return not np.isnan(known.inputs.pose.angles).all()


def _angles_last(known: Known, _: Case) -> list[Problem]:
    """The best map without the wanted angles may come to them from the other side."""
    inputs = known.inputs
    free = replace(inputs, pose=replace(inputs.pose, angles=None, scales=None))
    return [Problem(with_options(free, tolerance=_STAGE_TOLERANCE)), Problem(inputs)]


# Ends the other way round, and staged targets.

# Targets staged as the first map turns its lines end where that map does, unless its energy is high
# and a line turns by more than this.
_HALF_CIRCLE = np.deg2rad(140)


def _wound_up(known: Known) -> list[Case]:
    """The first map, and the better one with other turns, if they wind ends up. The better map's
    led a giraffe to 2.296 instead of 2.358, and changed none of 482 other poses."""
    wound = [turns for turns in known.all_turns if any(line.wound for line in turns.lines)]
    return [Case(turns=turns) for turns in wound]


def _unwound(known: Known, case: Case) -> list[Problem]:
    return _led(known, waypoints(case.led_along(known), unwind=True))


def _turns_far(known: Known) -> bool:
    return max((abs(line.turn) for line in known.turns.lines), default=0) > _HALF_CIRCLE


def _may_be_staged(known: Known) -> bool:
    turns = known.hopeless or (known.high and _turns_far(known))
    return turns and not _wound_up(known)


def _staged(known: Known, _: Case) -> list[Problem]:
    return _led(known, waypoints(known.turns))


# From the identity.

# A rigid alignment misleads if it turns the shape by more, and if the targets follow it by less
# than the second number of their way. Of 26 poses from 5 on the identity improved four.
_ALIGNED, _FOLLOWED = np.deg2rad(60), 0.5


def _misled(known: Known) -> bool:
    """Whether the rigid start turned the shape far, though its targets hardly follow that."""
    pose = known.inputs.pose
    z, w = (as_complex(p - p.mean(axis=0)) for p in (pose.handles, pose.targets))
    along = np.vdot(z, w)
    hardly = abs(along) < _FOLLOWED * np.vdot(z, z).real
    return bool(known.high and abs(np.angle(along)) > _ALIGNED and hardly)


def _frees(known: Known) -> bool:
    """Whether the identity may be a better start: it frees a line that is squeezed though it could
    bend."""
    if not known.inputs.options.align:
        return False
    squeezed = any(line.squeezed for line in known.turns.lines)
    return squeezed or known.hopeless or (not _turns_far(known) and _misled(known))


def _still(known: Known) -> Inputs:
    return with_options(known.inputs, align=False)


def _identity(known: Known, _: Case) -> list[Problem]:
    return [Problem(_still(known))]


# Staged weights.


def _still_hopeless(known: Known) -> bool:
    return known.hopeless and is_above(known.best, HIGHEST_ENERGY)


def _hopeless_when_aligned(known: Known) -> bool:
    return known.inputs.options.align and _still_hopeless(known)


def _raised(inputs: Inputs) -> list[Problem]:
    """Lambda raised step by step."""
    weights = [inputs.options.p2p_weight * fraction for fraction in _WEIGHTS]
    loose = [_loosened(inputs, p2p_weight=weight) for weight in weights]
    return [Problem(each) for each in (*loose, inputs)]


WAYS = (
    Way(
        name="from the symmetric Dirichlet minimum",
        when=_without_barrier,
        problems=_dirichlet_first,
        enough=HIGH_ENERGY,
    ),
    Way(
        name="the other way round at {}",
        cases=_other_turns,
        problems=_turned_back,
        # The prediction may err by a tenth. Then it names all but one of 57 poses that another turn
        # improves by over 2%, and of 256 good poses 84 are tried in vain.
        cost=0.9,
        limit=1.0,
    ),
    Way(
        name="along an arc at {}",
        cases=_curled,
        problems=_arc,
        # Without any arc one of 18 poses drawn for it ends at 5.10 instead of 3.97.
        cost=0.6,
        limit=1.0,
    ),
    Way(
        name="without its angles first",
        when=_wants_angles,
        problems=_angles_last,
        # Two stars end at 2.31 and 4.15 instead of 2.71 and 4.98; of 57 new poses all end within 2%
        # of the best minimum known, 55 before.
        cost=0.8,
        limit=0.8,
    ),
    Way(
        name="ends the other way round",
        cases=_wound_up,
        problems=_unwound,
        cost=0.8,
        # The held ends may add to what a waypoint costs. With the ends free, the first map came
        # back: a frog ends at 8.69 instead of 9.45, a deer at 2.40 instead of 2.46.
        limit=2.0,
    ),
    Way(
        name="staged targets",
        when=_may_be_staged,
        problems=_staged,
        cost=0.8,
        limit=1.0,
    ),
    Way(
        name="from the identity",
        when=_frees,
        problems=_identity,
        cost=0.4,
    ),
    Way(
        name="staged weights from the identity",
        when=_hopeless_when_aligned,
        problems=lambda known, _: _raised(_still(known)),
    ),
    Way(
        name="staged weights",
        when=_still_hopeless,
        problems=lambda known, _: _raised(known.inputs),
    ),
)
"""In the order in which they are tried."""


def _led(known: Known, along: list[Waypoint]) -> list[Problem]:
    """The pose's waypoints, each solved loosely, then the pose itself."""
    loose = _loosened(known.inputs, align=True)
    led = [Problem(replace(loose, pose=waypoint.pose), waypoint.time) for waypoint in along]
    return [*led, Problem(known.inputs)]


def _loosened(inputs: Inputs, **changes: Any) -> Inputs:
    """A problem of a waypoint, which need not be solved to its minimum."""
    most = inputs.options.max_iterations
    few = _WAYPOINT_ITERATIONS if most is None else min(_WAYPOINT_ITERATIONS, most)
    return with_options(inputs, max_iterations=few, tolerance=_STAGE_TOLERANCE, **changes)


def with_options(inputs: Inputs, **changes: Any) -> Inputs:
    return replace(inputs, options=replace(inputs.options, **changes))
