# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
import threading

import pytest

from walk_ros.worker import Superseded, Worker

LIMIT_S = 10.0


class Bench:
    """A worker whose steps wait until the test lets them go on."""

    def __init__(self, body=lambda worker: None):
        self.entered, self.go_on = threading.Semaphore(0), threading.Semaphore(0)
        self.steps, self.errors, self.superseded = 0, [], 0
        self.body = body
        self.worker = Worker("test", self._step, self.errors.append)
        self.worker.start()

    def _step(self):
        self.entered.release()
        assert self.go_on.acquire(timeout=LIMIT_S)
        self.steps += 1
        try:
            self.body(self.worker)
        except Superseded:
            self.superseded += 1
            raise

    def wait_entered(self):
        assert self.entered.acquire(timeout=LIMIT_S)


@pytest.fixture
def bench():
    made = []

    def make(*args):
        made.append(Bench(*args))
        return made[-1]

    yield make
    for one in made:
        one.go_on.release(50)
        assert one.worker.stop(LIMIT_S)


def test_many_wakes_during_a_step_make_one_more_step(bench):
    b = bench()
    b.worker.wake()
    b.wait_entered()
    for _ in range(100):
        b.worker.wake()
    b.go_on.release()
    b.wait_entered()
    b.go_on.release()
    assert not b.entered.acquire(timeout=0.1)
    assert b.steps == 2


def test_a_superseded_step_ends_at_its_next_progress_and_runs_again(bench):
    b = bench(lambda worker: worker.progress("stage", 0.5))
    b.worker.wake()
    b.wait_entered()
    b.worker.wake(supersede=True)
    b.go_on.release()
    b.wait_entered()
    b.go_on.release()
    assert not b.entered.acquire(timeout=0.1)
    assert (b.steps, b.superseded, b.errors) == (2, 1, [])


def test_a_plain_wake_lets_the_step_finish(bench):
    b = bench(lambda worker: worker.progress("stage", 0.5))
    b.worker.wake()
    b.wait_entered()
    b.worker.wake()
    b.go_on.release()
    b.wait_entered()
    b.go_on.release()
    assert b.superseded == 0


def test_the_worker_lives_on_after_an_error(bench):
    def body(worker):
        raise ValueError("once")

    b = bench(body)
    for _ in range(2):
        b.worker.wake()
        b.wait_entered()
        b.go_on.release()
    assert b.worker.stop(LIMIT_S)
    assert [str(e) for e in b.errors][:1] == ["once"]


def test_stop_without_start_returns():
    assert Worker("never", lambda: None, print).stop(0.1)


def test_a_short_step_runs_in_the_callers_thread_while_the_worker_rests():
    worker = Worker("test", lambda: None, pytest.fail)
    ran = []
    worker.now(lambda: ran.append(threading.get_ident()))
    assert ran == [threading.get_ident()]


def test_a_short_step_never_runs_beside_the_workers_own(bench):
    made = bench()
    made.worker.wake()
    made.wait_entered()
    ran = []
    made.worker.now(lambda: ran.append(1))
    assert not ran
    made.go_on.release()
    # What could not run now has woken the worker, which serves it.
    made.wait_entered()
    made.go_on.release()


def test_an_error_of_a_short_step_is_reported():
    errors = []
    worker = Worker("test", lambda: None, errors.append)
    worker.now(lambda: 1 / 0)
    assert [type(e) for e in errors] == [ZeroDivisionError]


def test_input_that_is_not_urgent_is_served_all_the_same(bench):
    made = bench()
    made.worker.wake(rest_s=0.02)
    assert not made.entered.acquire(timeout=0.01)
    made.wait_entered()
    made.go_on.release()


def test_urgent_input_takes_along_what_may_wait(bench):
    made = bench()
    made.worker.wake(rest_s=LIMIT_S)
    made.worker.wake()
    made.worker.wake(rest_s=LIMIT_S)
    assert made.entered.acquire(timeout=0.5 * LIMIT_S)
    made.go_on.release()
    assert not made.entered.acquire(timeout=0.1)
