"""The Python package on a real run: each case compares with what the command `constrictor` says, or with physics."""

import json
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import constrictor
from support import COMMAND, Launched, command, eventually


@pytest.fixture(scope="module")
def launched(tmp_path_factory):
    # Twice real time, until a test changes the pace.
    made = Launched(tmp_path_factory.mktemp("run"), "case_study", "--pace", "2x")
    yield made
    made.end()


@pytest.fixture
def run(launched):
    with constrictor.join() as joined:
        yield joined


def test_errors_without_a_run_are_those_of_the_command(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    assert constrictor.runs() == []
    with pytest.raises(constrictor.NoRunError) as error:
        constrictor.join()
    said = subprocess.run([COMMAND, "pause"], capture_output=True, text=True, timeout=30).stderr
    assert str(error.value) in said
    with pytest.raises(constrictor.NoRunError, match="writes its report into"):
        constrictor.join(directory=tmp_path)
    with pytest.raises(ValueError, match="accepted a DDS domain from 0 to 229"):
        constrictor.join(230)
    with pytest.raises(ValueError, match="accepted external or operator"):
        constrictor.join(level="boss")


def test_images_are_arrays_of_pixels(run):
    image = run.latest("camera/image", timeout=20)
    pixels = image["data"]
    assert pixels.dtype == np.uint8 and pixels.shape == (image["height"], image["width"], 3)
    # The painted line is blue, so in the lower half of an image of it some pixels are much more blue than red. This
    # test is an early one: later, the robot turns away from the line.
    def shows_the_line():
        seen = run.latest("camera/image", timeout=20)["data"]
        lower = seen[seen.shape[0] // 2 :].astype(int)
        return ((lower[:, :, 2] - lower[:, :, 0]) > 60).sum() > 50

    assert eventually(shows_the_line)


def test_a_run_is_found_by_itself_by_number_and_by_directory(launched):
    (note,) = constrictor.runs()
    assert note.scenario == "case_study" and note.plant == "physics" and note.pid == launched.process.pid
    for options in ({}, {"run": note.domain}, {"directory": launched.report}):
        with constrictor.join(**options) as joined:
            assert joined.domain == note.domain
            with pytest.raises(constrictor.Error, match="already joined"):
                constrictor.join()
    with pytest.raises(constrictor.Error, match="was left"):
        joined.state()


def test_a_run_is_left_when_nothing_refers_to_it(launched):
    for message in constrictor.join().subscribe("joint_state", timeout=20):
        break  # the subscription has kept the run
    first = constrictor.join(name="first")
    first.take()
    source = first.source
    del first
    second = constrictor.join()
    assert second.authority()["source"] != source
    second.close()
    second.close()
    assert message["joint_count"] == 23


def test_samples_are_dictionaries_with_arrays(run):
    state = run.latest("joint_state", timeout=20)
    assert state["joint_count"] == 23
    assert state["position_rad"].shape == (23,) and state["position_rad"].dtype == np.float64
    assert run.latest("joint_state", whole=True)["position_rad"].shape == (64,)
    # The same tick as the command prints it.
    run.pause()
    mine = run.latest("joint_state", whole=True)
    while mine["header"]["tick"] < run.state()["tick"] - 1:
        mine = run.latest("joint_state", whole=True)
    shown = json.loads(command("topic", "echo", "joint_state", "--count", "1", "--json"))
    run.resume()
    assert shown["header"] == mine["header"]
    np.testing.assert_array_equal(mine["position_rad"], shown["position_rad"])
    assert eventually(lambda: run.latest("task/status")["task"] == "follow_line")
    assert isinstance(run.latest("task/status", names=False)["task"], int)
    assert np.isnan(run.latest("task/status")["cross_track_m"])


def test_iterations_have_bounds_and_miss_nothing(run):
    numbers = []
    for message in run.subscribe("joint_state", timeout=10):
        numbers.append(message["header"]["sequence_number"])
        if len(numbers) == 40:
            break
    assert numbers == list(range(numbers[0], numbers[0] + 40))
    history = run.subscribe("task/event", history=True)
    assert history.next(timeout=10)["header"]["sequence_number"] == 1
    with pytest.raises(TimeoutError, match="no sample of 'motion/command' within 0.1 s"):
        run.subscribe("motion/command").next(timeout=0.1)
    with pytest.raises(constrictor.Error, match="did you mean 'joint_state'"):
        run.subscribe("joint_stat")


def test_messages_are_published_checked(run):
    with pytest.raises(constrictor.RefusedError, match="belongs to physics of the run"):
        run.publisher("joint_state")
    with pytest.raises(constrictor.Error, match="needs the name of its type"):
        run.publisher("posture")
    publisher = run.publisher("posture", type="JointState")
    with pytest.raises(TimeoutError, match="no reader of 'posture' within 0.1 s"):
        publisher.wait_for_reader(timeout=0.1)
    echo = subprocess.Popen(
        [COMMAND, "topic", "echo", "posture", "--json", "--timeout", "20", "-n", "1"], stdout=subprocess.PIPE, text=True
    )
    try:
        publisher.wait_for_reader(timeout=20)
        with pytest.raises(ValueError, match="there is no field 'positions'"):
            publisher.publish({"positions": []})
        with pytest.raises(ValueError, match=r"position_rad\[1\]: found null, accepted a finite number"):
            publisher.publish({"position_rad": np.array([0.0, np.nan])})
        publisher.publish({"robot_id": 3, "position_rad": np.array([0.25, -1.0])})
        assert publisher.flush()
        shown = json.loads(echo.communicate(timeout=20)[0])
    finally:
        echo.kill()
        echo.wait()
    assert shown["robot_id"] == 3 and shown["joint_count"] == 2 and shown["position_rad"][:2] == [0.25, -1.0]


def test_parameters_are_read_set_and_refused(run):
    name = "navigation.travel.speed_m_s"
    assert run.get_parameter(name) == 0.63
    assert run.parameters(name)[name]["unit"] == "m/s"
    tick = run.set_parameter(name, 0.8)
    assert eventually(lambda: json.loads(command("param", "get", name, "--json"))["value"] == 0.8)
    assert tick > 0
    with pytest.raises(constrictor.RefusedError, match="found 9, accepted 0.001 to 2 m/s"):
        run.set_parameter(name, 9)
    with pytest.raises(KeyError, match="no parameter"):
        run.get_parameter("navigation.nothing")
    with pytest.raises(KeyError, match="did you mean 'navigation.travel.speed_m_s'"):
        run.get_parameter("navigation.travel.speeed_m_s")
    with pytest.raises(constrictor.RefusedError, match="did you mean 'navigation.travel.speed_m_s'"):
        run.set_parameter("navigation.travel.speeed_m_s", 0.8)
    assert run.get_parameter("control.motion.travel.method") == "undulation"
    run.set_parameter("control.motion.travel.method", "rolling")
    assert eventually(lambda: run.get_parameter("control.motion.travel.method") == "rolling")
    run.set_parameter("control.motion.travel.method", "undulation")
    with pytest.raises(ValueError, match="found 'moonwalk', accepted undulation, "):
        run.set_parameter("control.motion.travel.method", "moonwalk")


def test_wrong_types_are_named_with_argument_found_and_accepted(run):
    wrong = [
        (lambda: run.drive("fast"), r"drive: speed_m_s: found 'fast' \(str\), accepted float"),
        (lambda: run.drive(0.1, None), r"turn_rad_s: found None \(NoneType\), accepted float"),
        (lambda: run.step(1.5), r"ticks: found 1.5 \(float\), accepted int"),
        (lambda: run.step(True), r"ticks: found True \(bool\), accepted int"),
        (lambda: run.start(3), r"task: found 3 \(int\), accepted str"),
        (lambda: run.start("rotate", direction=1), r"direction: found 1 \(int\), accepted str or None"),
        (lambda: run.set_parameter("navigation.travel.speed_m_s", [1]), r"value: .* accepted float or str"),
        (lambda: run.subscribe("joint_state", depth="8"), r"depth: found '8' \(str\), accepted int"),
        (lambda: constrictor.join("3"), r"join: run: found '3' \(str\), accepted int or None"),
    ]
    for call, text in wrong:
        with pytest.raises(TypeError, match=text):
            call()
    with pytest.raises(TypeError, match="unexpected keyword argument 'speed'"):
        run.drive(speed=1.0)
    for call in (lambda: run.reset(-1), lambda: run.start("grasp", object_handle=70000),
                 lambda: run.subscribe("joint_state", depth=0)):
        with pytest.raises(ValueError, match="found .*, accepted [01] to"):
            call()
    run.drive(np.float32(0.1), np.int64(0))  # numbers of NumPy are numbers
    run.stand()


def test_time_is_commanded(run):
    paused = run.pause()
    assert paused["paused"]
    assert run.step(5)["tick"] == paused["tick"] + 5
    assert run.state()["paused"]
    assert run.pace(1.5)["pace"] == 1.5
    assert run.pace(2.0)["pace"] == 2.0
    assert not run.resume()["paused"]
    with pytest.raises(ValueError, match="accepted 0.001 to 1000"):
        run.pace(0)


def test_driving_moves_the_robot_and_the_block_ends_with_a_release(launched):
    with constrictor.join() as run:
        run.drive(0.6)
        assert run.authority()["mine"] and run.authority()["level"] == "external"
        run.wait(1.0)
        before = run.latest("guidance/pose")
        run.wait(2.0)
        after = run.latest("guidance/pose")
        ticks = after["header"]["tick"] - before["header"]["tick"]
        assert ticks >= 95  # 100 ticks of 20 ms, less those between a message and the next
        moved_m = np.hypot(after["x_m"] - before["x_m"], after["y_m"] - before["y_m"])
        assert 0.2 * ticks / 100 < moved_m < 2.0 * ticks / 100
        source = run.source
        with pytest.raises(ValueError, match="speed_m_s: found 3"):
            run.drive(3)
    with constrictor.join() as run:
        assert run.authority()["source"] != source


def test_goals_report_events_ends_and_refusals(run):
    with pytest.raises(ValueError, match="rotate needs a direction"):
        run.start("rotate")
    with pytest.raises(ValueError, match="accepted follow_line"):
        run.start("fly")
    with pytest.raises(constrictor.RefusedError, match="navigation"):
        run.start("drop", drop_zone_colour="green")
    goal = run.start("rotate", direction="left", timeout_s=1.0)
    with pytest.raises(TimeoutError, match="it goes on"):
        goal.wait(timeout=0.05)
    assert goal.wait_event("timeout", timeout=20)["event"] == "timeout"
    end = goal.wait(timeout=20)
    assert end.succeeded, end
    with pytest.raises(constrictor.Error, match="it has succeeded"):
        goal.wait_event("line found", timeout=20)
    assert [event["event"] for event in goal.events()].count("timeout") == 1
    goal = run.start("rotate", direction="left")
    goal.cancel()
    assert goal.wait(timeout=20).state in ("cancelled", "preempted")


def test_another_thread_stops_the_robot_during_a_wait(run):
    goal = run.start("rotate", direction="left")
    result = []
    waiting = threading.Thread(target=lambda: result.append(goal.wait(timeout=30)))
    waiting.start()
    run.wait(0.2)
    begin = time.monotonic()
    run.emergency_stop()
    assert time.monotonic() - begin < 5.0  # the other thread waits for 30 s
    waiting.join(20)
    assert result and not result[0].succeeded
    assert run.authority()["emergency_stop"]
    with pytest.raises(constrictor.RefusedError, match="clear_stop"):
        run.drive(0.1)
    run.clear_stop()
    assert not run.authority()["emergency_stop"]


@pytest.mark.parametrize("wait", ["goal.wait()", "run.wait(1000)", "run.subscribe('motion/command').next()"])
def test_ctrl_c_ends_a_wait_and_the_program_leaves_the_run(launched, wait):
    program = (
        "import constrictor\n"
        "with constrictor.join(name='victim') as run:\n"
        "    goal = run.start('rotate', direction='left')\n"
        "    print('waiting', flush=True)\n"
        f"    {wait}\n"
    )
    pipe = subprocess.PIPE
    victim = subprocess.Popen([sys.executable, "-c", program], stdout=pipe, stderr=pipe, text=True)
    try:
        assert victim.stdout.readline() == "waiting\n"
        victim.send_signal(signal.SIGINT)
        begin = time.monotonic()
        errors = victim.communicate(timeout=20)[1]
        assert time.monotonic() - begin < 5.0
    finally:
        victim.kill()
        victim.wait()
    assert "KeyboardInterrupt" in errors
    with constrictor.join() as run:
        assert not run.authority()["source"].startswith("victim")


def test_the_run_ends_and_so_do_iterations(launched):
    with constrictor.join() as run:
        samples = run.subscribe("joint_state")
        samples.next(timeout=20)
        run.end()
        for _ in samples:
            pass
        assert run.over() == "the run has ended"
        with pytest.raises(constrictor.Error, match="has ended"):
            run.wait(1)
    launched.process.wait(20)
    assert json.loads((launched.report / "report.json").read_text())["reason"].startswith("ended by")
