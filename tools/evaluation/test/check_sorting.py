#!/usr/bin/env python3
# This file is part of OpenCV project.
# It is subject to the license terms in the LICENSE file found in the top-level directory
# of this distribution and at http://opencv.org/license.html.

"""check_sorting.py PAGE: drives Chromium through the page's main table, and sees that it fits a phone and a desk.

Prints "is not installed" and ends well where Debian's chromium, chromium-driver or python3-selenium are missing."""
import os
import shutil
import sys

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
except ImportError:
    sys.exit(print("python3-selenium is not installed"))
for program in ("chromium", "chromedriver"):
    if not shutil.which(program):
        sys.exit(print(program + " is not installed"))

options = webdriver.ChromeOptions()
options.binary_location = shutil.which("chromium")
for argument in ("--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"):
    options.add_argument(argument)
browser = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)
try:
    browser.get("file://" + os.path.abspath(sys.argv[1]))

    def column(index):
        cells = browser.find_elements(By.CSS_SELECTOR, "#overview tbody td:nth-child(%d)" % index)
        return [cell.get_attribute("data-value") or cell.text for cell in cells]

    def press(index):
        browser.find_element(By.CSS_SELECTOR, "#overview th:nth-child(%d) button" % index).click()
        return browser.find_element(By.CSS_SELECTOR, "#overview th:nth-child(%d)" % index).get_attribute("aria-sort")

    names = column(1)
    assert len(names) > 4, names
    assert press(4) == "descending"
    recalls = [float(value) for value in column(4)]
    assert recalls == sorted(recalls, reverse=True), recalls
    assert press(4) == "ascending"
    assert [float(value) for value in column(4)] == sorted(recalls), column(4)
    assert press(1) == "ascending"
    assert column(1) == sorted(names, key=str.lower), column(1)
    assert press(2) == "descending"
    sizes = [int(value) for value in column(2)]
    assert sizes == sorted(sizes, reverse=True), sizes  # as numbers: 64 before 512 otherwise
    assert sorted(column(1)) == sorted(names)

    for width in (400, 1400):
        browser.set_window_size(width, 900)
        inner, whole = browser.execute_script("return [innerWidth, document.documentElement.scrollWidth]")
        assert whole <= inner, "at %d pixels the page is %d wide" % (inner, whole)
    problems = [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"]
    assert not problems, problems
finally:
    browser.quit()
