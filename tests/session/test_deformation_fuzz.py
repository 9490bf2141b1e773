"""Random actions: the map is always certified, and undo is exact."""

from __future__ import annotations

import contextlib
from typing import Any

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import settings
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from glid_nb.certificate import certify
from glid_nb.energies import AMIPS, ARAP, SymmetricDirichlet
from glid_nb.harmonic import HarmonicMap
from glid_nb.session.deformation import Deformation
from glid_nb.session.edit_state import EditError

from ..support.domains import domain

TIMEOUT = 120.0

near = st.tuples(st.floats(-4, 4), st.floats(-4, 4))
anywhere = st.one_of(near, st.tuples(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3)))
index = st.integers(-1, 6)


class Hand(RuleBasedStateMachine):
    """All actions of a user, in any order, with and without waiting for the solver."""

    def __init__(self) -> None:
        super().__init__()
        self.model = Deformation(domain("ring"))

    def teardown(self) -> None:
        self.model.close()

    def act(self, method: str, *arguments: Any) -> None:
        """One action. Undo gives exactly the state before it, redo the state after it."""
        model = self.model
        assert model.solve(TIMEOUT)
        model.end_drag()
        before, steps = model.state, len(model.history.past)
        try:
            getattr(model, method)(*arguments)
        except EditError:
            assert model.state is before
            return
        if len(model.history.past) == steps:
            return
        model.undo()
        assert model.state is before
        model.redo()

    @rule(point=near)
    def add_handle(self, point: Any) -> None:
        self.act("add_handle", point)

    @rule(i=index)
    def remove_handle(self, i: int) -> None:
        self.act("remove_handles", i)

    @rule(i=index, to=anywhere)
    def drag(self, i: int, to: Any) -> None:
        self.act("drag", i, to)

    @rule(i=index, delta=near)
    def nudge(self, i: int, delta: Any) -> None:
        self.act("nudge", [i], delta)

    @rule(energy=st.sampled_from([SymmetricDirichlet(), AMIPS(0.5), ARAP()]))
    def set_energy(self, energy: Any) -> None:
        self.act("set_energy", energy)

    @rule(name=st.sampled_from(["newton", "mls", "mean-value"]))
    def set_method(self, name: str) -> None:
        self.act("set_method", name)

    @rule(name=st.sampled_from(["reset", "clear_handles", "save_pose"]))
    def simple(self, name: str) -> None:
        self.act(name)

    @rule(
        name=st.sampled_from(["duplicate_pose", "delete_pose", "go_to_pose"]), i=st.integers(0, 3)
    )
    def pose(self, name: str, i: int) -> None:
        self.act(name, i)

    @rule(i=st.integers(0, 3), time=st.floats(0, 4))
    def move_pose(self, i: int, time: float) -> None:
        self.act("move_pose", i, time)

    @rule(repeat=st.sampled_from(["once", "loop", "ping-pong"]))
    def set_repeat(self, repeat: Any) -> None:
        self.act("set_repeat", repeat)

    @rule()
    def drop_hole(self) -> None:
        self.act("drop_hole", 0)

    # Without waiting

    @rule(i=index)
    def begin_drag(self, i: int) -> None:
        with contextlib.suppress(EditError):
            self.model.begin_drag([i])

    @precondition(lambda self: self.model.dragged)
    @rule(to=anywhere)
    def drag_to(self, to: Any) -> None:
        held = len(self.model.dragged)
        self.model.drag_to(np.tile(to, (held, 1)))

    @precondition(lambda self: self.model.dragged)
    @rule(name=st.sampled_from(["end_drag", "cancel_drag"]))
    def let_go(self, name: str) -> None:
        getattr(self.model, name)()
        assert not self.model.dragged

    @rule(point=near)
    def add_while_busy(self, point: Any) -> None:
        with contextlib.suppress(EditError):
            self.model.add_handle(point)

    @rule(name=st.sampled_from(["undo", "redo", "reset", "stop"]))
    def at_any_time(self, name: str) -> None:
        getattr(self.model, name)()

    @invariant()
    def certified(self) -> None:
        model = self.model
        state = model.state
        assert certify(state.map).certified
        assert state.map.domain is state.domain
        assert isinstance(state.map, HarmonicMap)
        assert state.domain.cage.contains(state.pose.handles).all()
        assert model.status.level != "error", model.status.text
        assert all(0 <= i < len(state.pose) for i in model.selection)


Hand.TestCase.settings = settings(max_examples=8, stateful_step_count=20, deadline=None)
TestHand = pytest.mark.slow(Hand.TestCase)
