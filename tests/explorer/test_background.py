"""Work beside the page: the newest counts."""

import threading

from carom.base.progress import Progress
from carom.explorer.background import Job, Worker

SOON = 30.0
"""Seconds after which a thread that does not answer is taken to hang."""


class Work:
    """Work that begins, waits to be let go, and reports progress when it is."""

    def __init__(self, name: str, shown: list[str]) -> None:
        self.name, self.stated = name, shown
        self.begun, self.go, self.ended = threading.Event(), threading.Event(), threading.Event()

    @property
    def request(self) -> Job:
        return Job(self.run, self.done)

    def run(self, tell):
        self.begun.set()
        assert self.go.wait(SOON)
        tell(Progress(0.5, "half"))
        return self.name

    def done(self, result):
        self.stated.append(result)
        self.ended.set()


def test_of_each_kind_only_the_newest_that_waits_is_done_and_the_most_urgent_first():
    shown: list[str] = []
    worker = Worker(("urgent", "later"))
    first, old, new, urgent = (Work(name, shown) for name in ("first", "old", "new", "urgent"))
    worker.submit("later", first.request)
    assert first.begun.wait(SOON)
    for kind, work in (("later", old), ("later", new), ("urgent", urgent)):
        worker.submit(kind, work.request)
        work.go.set()
    first.go.set()
    assert new.ended.wait(SOON)
    worker.close()
    assert worker.join(SOON)
    assert shown == ["first", "urgent", "new"]
    assert not old.begun.is_set()


def test_what_pauses_lets_newer_and_more_urgent_work_go_first():
    shown: list[str] = []
    worker = Worker(("urgent", "later"))
    old, new, urgent, soon = (Work(name, shown) for name in ("old", "new", "urgent", "soon"))
    for work in (old, new, urgent, soon):
        work.go.set()
    # It would begin after the test: what ends its pause is always one of the requests that follow.
    worker.submit("later", Job(old.run, old.done, pause=2 * SOON))
    worker.submit("urgent", urgent.request)
    assert urgent.ended.wait(SOON)
    worker.submit("later", Job(new.run, new.done, pause=2 * SOON))
    worker.submit("later", Job(soon.run, soon.done, pause=0.01))
    assert soon.ended.wait(SOON)
    worker.close()
    assert worker.join(SOON)
    assert shown == ["urgent", "soon"]


def test_what_is_dropped_ends_at_its_next_report_and_says_nothing():
    shown: list[str] = []
    worker = Worker(("one",))
    dropped, next_one = Work("dropped", shown), Work("next", shown)
    worker.submit("one", dropped.request)
    assert dropped.begun.wait(SOON)
    worker.drop()
    worker.submit("one", next_one.request)
    dropped.go.set()
    next_one.go.set()
    assert next_one.ended.wait(SOON)
    worker.close()
    assert shown == ["next"]


def test_errors_are_handed_over_and_do_not_end_the_desk():
    shown: list[object] = []
    worker, ended = Worker(("one",)), threading.Event()

    def fail(tell):
        raise ValueError("no")

    worker.submit("one", Job(fail, lambda result: (shown.append(result), ended.set())))
    assert ended.wait(SOON)
    assert isinstance(shown[0], ValueError)
    after = Work("after", shown)
    after.go.set()
    worker.submit("one", after.request)
    assert after.ended.wait(SOON)
    worker.close()


def test_a_desk_without_work_closes():
    worker = Worker(("one",))
    worker.close()
    assert worker.join(SOON)
