# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""The chart's page in headless Chromium: from disk, without a network, by mouse and by keyboard."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from selenium.webdriver import ActionChains, Chrome, ChromeOptions
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select
from small_chart import EVERY_METHOD, shared_chart

_FLAGS = ("--headless=new", "--no-sandbox", "--window-size=1280,1000", "--disable-gpu")
# Of the plot: the points of every method, by its trace's name.
_TRACES = (
    "return Object.fromEntries(document.getElementById('plot').data"
    ".filter(t => t.mode === 'markers').map(t => [t.name, Array.from(t.y)]))"
)


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return shared_chart(tmp_path_factory) / "index.html"


@pytest.fixture(scope="module")
def chromium() -> Iterator[Chrome]:
    driver = shutil.which("chromedriver")
    assert driver, "chromedriver is missing: ./nightcity installs it with chromium"
    options = ChromeOptions()
    for flag in _FLAGS:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    browser = Chrome(options=options, service=Service(driver))
    yield browser
    browser.quit()


@pytest.fixture
def browser(chromium: Chrome, page: Path) -> Chrome:
    chromium.get(page.as_uri())
    return chromium


def element(browser: Chrome, name: str):  # type: ignore[no-untyped-def]
    return browser.find_element(By.ID, name)


def chosen(browser: Chrome) -> str:
    return element(browser, "chosen").text


def test_loads_from_disk_alone(browser: Chrome) -> None:
    assert browser.get_log("browser") == []
    entries = "return performance.getEntriesByType('resource').map(entry => entry.name)"
    assert [name for name in browser.execute_script(entries) if not name.startswith("data:")] == []
    traces = browser.execute_script(_TRACES)
    assert sum(len(points) for points in traces.values()) == len(EVERY_METHOD)


def test_filters_and_error_kinds(browser: Chrome) -> None:
    total = browser.execute_script(_TRACES)
    element(browser, "methods").find_element(By.CSS_SELECTOR, "input[value=march]").click()
    assert set(browser.execute_script(_TRACES)) == set(total) - {"march"}
    browser.find_element(By.CSS_SELECTOR, "input[value=numerical]").click()
    numerical = browser.execute_script(_TRACES)
    assert numerical["gauss"][0] < 1 < 30 < total["gauss"][0]  # %: of the paper's own model
    Select(element(browser, "statistic")).select_by_value("max")
    assert browser.execute_script(_TRACES)["gauss"][0] > numerical["gauss"][0]
    assert browser.get_log("browser") == []


def test_click_shows_the_picture(browser: Chrome) -> None:
    # The middle of the one point of path, by Plotly's own axes.
    place = browser.execute_script(
        "const plot = document.getElementById('plot'); plot.scrollIntoView({block: 'center'});"
        "const point = plot.data.find(trace => trace.name === 'path');"
        "const box = plot.getBoundingClientRect(); const layout = plot._fullLayout;"
        "return [box.x + layout._size.l + layout.xaxis.d2p(point.x[0]),"
        "        box.y + layout._size.t + layout.yaxis.d2p(point.y[0])]"
    )
    before = element(browser, "image").get_attribute("src")
    body = browser.find_element(By.TAG_NAME, "html")
    ActionChains(browser).move_to_element(body).perform()
    actions = ActionChains(browser)
    actions.w3c_actions.pointer_action.move_to_location(round(place[0]), round(place[1]))
    actions.w3c_actions.perform()
    hovered = browser.execute_script(
        "return new Promise(done => setTimeout(() => done(document.querySelector("
        "'#plot .hoverlayer').textContent), 500))"
    )
    assert "path 16, full" in hovered and "surface frames" in hovered
    actions = ActionChains(browser)
    actions.w3c_actions.pointer_action.click()
    actions.w3c_actions.perform()
    after = element(browser, "image").get_attribute("src")
    assert chosen(browser) == "path 16, full"
    assert after != before and after.startswith("data:image/png")
    for name in ("truth", "map"):
        assert int(element(browser, name).get_property("naturalWidth")) == 32


def test_slider_moves_the_border(browser: Chrome) -> None:
    slider = element(browser, "slider")
    slider.send_keys(Keys.HOME)
    assert element(browser, "image").value_of_css_property("clip-path") == "inset(0px 100% 0px 0px)"
    slider.send_keys(Keys.END)
    assert "100%" not in element(browser, "image").value_of_css_property("clip-path")


def test_keyboard_reaches_everything(browser: Chrome) -> None:
    wanted = browser.execute_script(
        "return [...document.querySelectorAll('select, input, #table button, #plot')]"
        ".filter(e => e.offsetParent && (e.type !== 'radio' || e.checked))"
        ".map(e => e.id || e.value || e.textContent)"
    )
    reached = []
    for _ in range(len(wanted) + 20):
        ActionChains(browser).send_keys(Keys.TAB).perform()
        reached.append(
            browser.execute_script(
                "const e = document.activeElement; return e.id || e.value || e.textContent"
            )
        )
    assert set(wanted) <= set(reached)


def test_arrows_go_from_point_to_point(browser: Chrome) -> None:
    plot = element(browser, "plot")
    seen = []
    for _ in range(len(EVERY_METHOD)):
        plot.send_keys(Keys.ARROW_LEFT)
    for _ in range(len(EVERY_METHOD)):
        seen.append(chosen(browser))
        plot.send_keys(Keys.ARROW_RIGHT)
    assert sorted(seen) == sorted(point.name for point in EVERY_METHOD)


def test_table_sorts_and_chooses(browser: Chrome) -> None:
    table = element(browser, "table")

    def medians() -> list[float]:
        cells = table.find_elements(By.CSS_SELECTOR, "tbody td:nth-child(8)")
        return [float(cell.text.split()[0]) for cell in cells]

    def heading():  # type: ignore[no-untyped-def]
        return table.find_elements(By.CSS_SELECTOR, "thead button")[7]

    heading().send_keys(Keys.ENTER)
    assert medians() == sorted(medians())
    heading().send_keys(Keys.ENTER)
    assert medians() == sorted(medians(), reverse=True)
    name = table.find_element(By.CSS_SELECTOR, "tbody button")
    text = name.text
    name.send_keys(Keys.ENTER)
    assert chosen(browser) == text
