"""Wrong use of an FMU: an error status, a message, no crash, and the instance goes on."""

from __future__ import annotations

import math
import os

import pytest
from pushed_cart import DISCARD, FATAL, push, runs_of


def test_wrong_call_order(cart):
    assert cart.status("doStep", 0.0, 0.01) == DISCARD
    for call in ("exitInitializationMode", "terminate"):
        assert cart.status(call) == FATAL
    push(cart)
    for call in ("setupExperiment", "enterInitializationMode", "exitInitializationMode"):
        assert cart.status(call) == FATAL
    cart.run(0.0, 3)
    cart.fmu.terminate()
    assert cart.status("doStep", 0.03, 0.01) == DISCARD
    assert cart.status("terminate") == FATAL
    assert cart.get("steps") == 3
    assert len(cart.texts()) == 8
    assert cart.texts()[0] == "fmi2DoStep is not allowed in phase INSTANTIATED; step discarded"
    assert cart.texts()[2] == "fmi2Terminate is not allowed in phase INSTANTIATED, only in STEPPING"


@pytest.mark.parametrize("call", ["getReal", "getInteger", "getBoolean", "getString"])
@pytest.mark.parametrize("reference", [13, 99, 2**31, 2**32 - 1])
def test_unknown_value_reference_when_reading(cart, call, reference):
    push(cart)
    for _ in range(5):
        assert cart.status(call, [reference]) == FATAL
    assert (
        f"value reference {reference - (1 << 32 if reference >= 1 << 31 else 0)}" in cart.texts()[0]
    )
    cart.fmu.reset()
    assert len(push(cart).run(0.0, 3)) == 3


@pytest.mark.parametrize(
    ("call", "reference", "value", "message"),
    [
        ("setReal", 1, 1.0, "no Real variable with value reference 1"),
        ("setInteger", 3, 1, "no Enumeration/Integer variable"),
        ("setBoolean", 77, True, "no Boolean variable"),
        ("setString", 0, "x", "no String variable"),
        ("setReal", 6, 1.0, "position_m is an output, it cannot be set"),
        ("setReal", 0, 1.0, "setting a fixed parameter is not allowed in phase STEPPING"),
        ("setString", 12, "x", "setting a fixed parameter is not allowed in phase STEPPING"),
    ],
)
def test_what_cannot_be_set(cart, call, reference, value, message):
    push(cart)
    for _ in range(5):
        assert cart.status(call, [reference], [value]) == FATAL
    assert message in cart.texts()[0]
    assert len(cart.run(0.0, 3)) == 3


@pytest.mark.parametrize("step_s", [0.0, -0.01, 1e9, math.nan, math.inf])
def test_senseless_steps_are_discarded(cart, step_s):
    push(cart).run(0.0, 3)
    before = cart.state()
    for _ in range(3):
        assert cart.status("doStep", 0.03, step_s) == DISCARD
    assert cart.state() == before
    assert "a step must be above 0 and at most 60 s" in cart.texts()[0]
    assert len(cart.run(0.03, 3)) == 3


@pytest.mark.parametrize("time", [0.02, -1.0, math.nan, math.inf])
def test_senseless_times_are_discarded(cart, time):
    push(cart).run(0.0, 3)
    before = cart.state()
    assert cart.status("doStep", time, 0.01) == DISCARD
    assert cart.state() == before


@pytest.mark.parametrize("time", [math.nan, math.inf])
def test_senseless_start_times_are_refused(cart, time):
    assert cart.status("setupExperiment", None, time) == FATAL
    assert "the start time must be finite" in cart.texts()[0]
    push(cart)


def test_unusable_parameter_is_refused_with_a_clear_message(cart, capfd):
    cart.set(log_file="/no/such/folder/log.txt")
    cart.fmu.setupExperiment(startTime=0.0)
    cart.fmu.enterInitializationMode()
    assert cart.status("exitInitializationMode") == FATAL
    assert cart.texts() == ["log_file /no/such/folder/log.txt: no such folder, 100%% sure"]
    error = capfd.readouterr().err
    assert (
        error == "PushedCart 'one': log_file /no/such/folder/log.txt: no such folder, 100% sure\n"
    )
    cart.set(log_file="")
    cart.fmu.exitInitializationMode()
    assert len(cart.run(0.0, 3)) == 3


def test_exception_in_a_model_is_survived(cart, tmp_path):
    log = tmp_path / "log.txt"
    push(cart, log_file=str(log)).run(0.0, 3)
    cart.set(force_n=666.0)
    for _ in range(3):
        assert cart.status("doStep", 0.03, 0.01) == FATAL
    assert "ZeroDivisionError: the devil is in the 1%% detail (in step" in cart.texts()[0]
    cart.set(force_n=1.0)
    assert len(cart.run(0.03, 3)) == 3
    cart.fmu.terminate()
    assert runs_of(log) == ["6 steps"]


def test_messages_go_through_the_logger_once_and_nothing_to_stdout(cart, capfd):
    folder = os.getcwd()
    push(cart).run(0.0, 50)
    cart.fmu.terminate()
    assert [entry for entry in cart.log if entry[1]] == [
        (1, "logStatusWarning", "memory of 3, 50%% used")
    ]
    assert capfd.readouterr() == ("", "")
    assert os.getcwd() == folder
