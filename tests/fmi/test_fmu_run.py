"""A run of an FMU: outputs at every moment, reset, states, steps, and how it ends."""

from __future__ import annotations

import pytest
from pushed_cart import FATAL, OK, push, runs_of


def test_outputs_are_valid_after_initialization(cart):
    push(cart)
    assert cart.get("acceleration_mps2") == 2.0
    assert cart.get("engaged") == 1


def test_values_may_be_set_before_the_experiment_is_set_up_and_while_initializing(cart):
    cart.set(body__mass_kg=4.0, force_n=1.0)
    cart.fmu.setupExperiment(startTime=0.0)
    cart.fmu.enterInitializationMode()
    cart.set(force_n=8.0)
    cart.fmu.exitInitializationMode()
    assert cart.get("acceleration_mps2") == 2.0


def test_feedthrough_is_recomputed_in_initialization_mode_and_between_steps(cart):
    cart.fmu.setupExperiment(startTime=0.0)
    cart.fmu.enterInitializationMode()
    for force in (1.0, 5.0):
        cart.set(force_n=force)
        assert cart.get("acceleration_mps2") == force / 2.0
    cart.set(body__mass_kg=1.0)
    assert cart.get("acceleration_mps2") == 5.0
    cart.fmu.exitInitializationMode()
    cart.fmu.doStep(0.0, 0.01)
    before = cart.outputs()
    cart.set(force_n=-3.0, brake=True)
    assert cart.get("acceleration_mps2") == 0.0
    cart.set(brake=False)
    assert cart.outputs() == {**before, "acceleration_mps2": -3.0}


def test_reading_while_initializing_does_not_change_the_run(cart_host):
    runs = []
    for curious in (False, True):
        cart = cart_host.instantiate()
        cart.fmu.setupExperiment(startTime=0.0)
        cart.fmu.enterInitializationMode()
        if curious:
            cart.outputs()
        cart.set(force_n=3.0, memory_size=7)
        if curious:
            cart.outputs()
        cart.fmu.exitInitializationMode()
        runs.append(cart.run(0.0, 20))
        assert cart.texts("logStatusWarning") == ["memory of 7, 50%% used"]
        cart.free()
    assert runs[0] == runs[1]


def test_reset_starts_anew_and_runs_identically(cart):
    first = push(cart).run(0.0, 30)
    cart.fmu.reset()
    assert cart.get("force_n") == 0.0
    assert push(cart).run(0.0, 30) == first


@pytest.mark.parametrize("phase", ["stepping", "initializing", "instantiated"])
def test_state_continues_identically_in_another_instance(cart_host, phase):
    one, two = cart_host.instantiate(), cart_host.instantiate("two")
    two.start(force_n=-1.0, memory_size=50).run(0.0, 5)
    one.set(force_n=4.0, memory_size=2)
    if phase != "instantiated":
        one.fmu.setupExperiment(startTime=0.0)
        one.fmu.enterInitializationMode()
        assert one.get("acceleration_mps2") == 2.0
    steps = 10
    if phase == "stepping":
        one.fmu.exitInitializationMode()
        one.run(0.0, steps)
    state = one.state()
    ends = []
    for slave in (one, one, two):
        assert slave.restore(state) == OK
        if phase == "stepping":
            assert slave.state() == state
        if phase == "instantiated":
            slave.fmu.enterInitializationMode()
        if phase != "stepping":
            slave.fmu.exitInitializationMode()
        ends.append(slave.run(steps * 0.01, 10, gear=2))
    one.free()
    two.free()
    assert ends[0] == ends[1] == ends[2]


def test_restored_run_is_finished_with_its_own_parameters(cart_host, tmp_path):
    logs = [tmp_path / "one.txt", tmp_path / "two.txt"]
    one = push(cart_host.instantiate(), log_file=str(logs[0]))
    one.run(0.0, 3)
    state = one.state()
    two = push(cart_host.instantiate("two"), log_file=str(logs[1]))
    two.run(0.0, 1)
    fresh = cart_host.instantiate("fresh")
    for slave in (two, fresh):
        assert slave.restore(state) == OK
        slave.run(0.03, 2)
        slave.fmu.terminate()
    for slave in (one, two, fresh):
        slave.free()
    assert runs_of(logs[0]) == ["5 steps", "5 steps", "3 steps"]
    assert runs_of(logs[1]) == []


@pytest.mark.parametrize("damage", [lambda s: b"", lambda s: s[:-1], lambda s: b"x" + s[1:]])
def test_damaged_state_is_refused_and_changes_nothing(cart, damage):
    push(cart).run(0.0, 3)
    state = cart.state()
    assert cart.restore(damage(state)) == FATAL
    assert cart.texts()
    assert cart.state() == state
    cart.fmu.doStep(0.03, 0.01)


@pytest.mark.parametrize("step_s", [0.001, 0.01, 0.02, 0.1, 1.7e-13])
def test_communication_steps(cart, step_s):
    push(cart)
    time = 0.0
    for _ in range(20):
        cart.fmu.doStep(time, step_s)
        time += step_s + 1e-13
    assert cart.get("steps") == 20


# The end of a run


@pytest.mark.parametrize("ending", ["terminate", "reset", "free", "terminate reset", "reset reset"])
def test_a_run_is_finished_exactly_once(cart_host, tmp_path, ending):
    log = tmp_path / "log.txt"
    cart = push(cart_host.instantiate(), log_file=str(log))
    cart.run(0.0, 3)
    for call in ending.split():
        if call != "free":
            getattr(cart.fmu, call)()
    if "free" not in ending:
        assert runs_of(log) == ["3 steps"]
    cart.free()
    assert runs_of(log) == ["3 steps"]


def test_a_run_that_never_started_is_not_finished(cart_host, tmp_path):
    log = tmp_path / "log.txt"
    cart = cart_host.instantiate()
    cart.set(log_file=str(log))
    cart.fmu.setupExperiment(startTime=0.0)
    cart.fmu.enterInitializationMode()
    cart.outputs()
    cart.free()
    assert runs_of(log) == []


def test_failure_at_the_very_end_is_said_on_stderr(cart_host, tmp_path, capfd):
    folder = tmp_path / "gone"
    folder.mkdir()
    cart = push(cart_host.instantiate("last one"), log_file=str(folder / "log.txt"))
    folder.rmdir()
    cart.free()
    assert "PushedCart 'last one': FileNotFoundError" in capfd.readouterr().err
