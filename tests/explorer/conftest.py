"""The page in a real browser, opened once for the tests of a file, whose ``MACHINE`` it shows."""

import pytest
from browsing import DESK, SOON, answered, said, served


@pytest.fixture(scope="module")
def address(request):
    with served(request.module.MACHINE) as (_, found):
        yield found


@pytest.fixture(scope="module")
def open_page(browser, address):
    """Open a page; at the end see that no script of any has failed."""
    context = browser.new_context(viewport=DESK, permissions=["clipboard-read", "clipboard-write"])
    context.set_default_timeout(SOON)
    wrong: list[str] = []

    def go(path: str = "", where: str = address, link=None):
        page = context.new_page()
        if link is not None:
            page.route_web_socket("**/ws*", link)
        page.on("pageerror", lambda problem: wrong.append(str(problem)))
        page.goto(where + path)
        # As soon as anything is touched, nothing moves by itself.
        page.keyboard.press("Shift")
        answered(page, "basin")
        return page

    yield go
    context.close()
    assert wrong == []


@pytest.fixture(scope="module")
def one_page(open_page):
    return open_page()


@pytest.fixture
def page(one_page):
    """The page as it is after loading; the tests share it, because loading takes seconds on a busy machine."""
    one_page.bring_to_front()
    one_page.locator("#reset").click()
    for answer in ("basin", "motion", "beside"):
        answered(one_page, answer, said(one_page, "carom.number"))
    return one_page
