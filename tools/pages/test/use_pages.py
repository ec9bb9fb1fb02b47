#!/usr/bin/env python3
"""Uses pages as a reader does, in headless Chromium without a network: use_pages.py PAGE...

At 1400 and 400 pixels: nothing is wider than the window, every column of a table can be scrolled to, every head of a sortable
table sorts both ways, a slider slides, matches answer to clicks, a map in 3-D turns, nothing is fetched but files, no script
fails. Says "chromium is not installed" and ends well without it. The page lies in a frame, whose scripts are asked.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading

WIDTHS = (1400, 400)
OPTIONS = ('--headless=new', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage', '--hide-scrollbars', '--no-first-run',
           '--host-resolver-rules=MAP * ~NOTFOUND', '--disable-background-networking', '--allow-file-access-from-files',
           '--enable-logging=stderr', '--window-size=1500,1000')
FRAME = '''<!DOCTYPE html><iframe id="frame" style="border:0;width:%dpx;height:900px" src=%s></iframe><script>
const frame = document.getElementById("frame"), wrong = [];
let page, view;
const find = selector => page.querySelector(selector), all = selector => [...page.querySelectorAll(selector)];
function place(selector) {  // the middle of an element, scrolled to
    find(selector).scrollIntoView({block: "center"});
    const box = find(selector).getBoundingClientRect();
    return [box.x + box.width / 2, box.y + box.height / 2];
}
function send(kind, x, y, type) {  // to what a reader sees there
    page.elementFromPoint(x, y).dispatchEvent(new view[type || "MouseEvent"](kind, {clientX: x, clientY: y, buttons: 1,
        movementX: 60, bubbles: true, cancelable: true}));
}
const click = selector => send("click", ...place(selector));
const told = () => find("#told").textContent, scene = () => find("#world").toDataURL();

// A column's values as a reader sees them: texts, or numbers, with those that lack a figure at the end.
function unsorted(head) {
    const values = () => [...head.closest("table").tBodies[0].rows].map(r => r.cells[head.cellIndex])
        .map(c => c.dataset.value || c.textContent.trim());
    const before = values().sort().join();
    return [1, 2].some(() => {
        head.querySelector("button").click();
        const sign = head.getAttribute("aria-sort") === "ascending" ? 1 : -1, shown = values();
        const numbers = shown.map(parseFloat).filter(v => !isNaN(v));
        const some = numbers.length ? numbers : shown.map(v => v.toLowerCase());
        return !some.every((v, i) => !i || (sign > 0 ? some[i - 1] <= v : some[i - 1] >= v));
    }) || values().sort().join() !== before;
}

function unreachable(table) {
    const box = table.closest(".scroll") || page.documentElement, cells = table.rows[0].cells;
    box.scrollLeft = 1e6;
    const last = cells[cells.length - 1].getBoundingClientRect(), covered = cells[0].getBoundingClientRect().right;
    box.scrollLeft = 0;
    return last.right > view.innerWidth + 1 || cells.length > 1 && last.left < covered - 1;
}

async function slide() {  // between two pictures; the scenes, and the matches on them
    const [x, y] = place("#wipe"), wipe = find("#wipe"), pictures = new Set();
    const shown = [25, 75].map(value => {
        wipe.value = value;
        wipe.dispatchEvent(new view.Event("input"));
        return view.getComputedStyle(find("#night")).clipPath;
    });
    if (shown[0] === shown[1] || page.elementFromPoint(x, y) !== wipe)
        wrong.push(`the slider does not change what is shown: ${shown}`);
    for (let i = 1; i <= all("#scenes button").length; i++) {
        click(`#scenes button:nth-of-type(${i})`);
        pictures.add(find("#night").src);
        await Promise.all(all("#frame img").map(image => image.decode())).catch(() => wrong.push(`scene ${i} lacks a picture`));
        for (let k = 1; k <= all("#methods button").length; k++) {
            click(`#methods button:nth-of-type(${k})`);
            const [right, wrongs, , step] = told().match(/\\d+/g).map(Number), drawn = all("#matches g").length;
            if (!drawn || drawn !== Math.ceil((right + wrongs) / step))
                wrong.push(`scene ${i}, method ${k} draws ${drawn} of ${right + wrongs} matches`);
        }
        const before = told();
        click("#matches g .hit");
        if (told() === before)
            wrong.push(`scene ${i}: a click on a match tells nothing`);
    }
    if (pictures.size !== all("#scenes button").length)
        wrong.push(`the scenes have ${pictures.size} pictures`);
}

function turn() {  // the map in 3-D
    const seen = [scene()];
    for (const touch of [() => send("pointermove", ...place("#world"), "PointerEvent"), () => click("#nearer"), () => click("label input")]) {
        touch();
        seen.push(scene());
    }
    if (new Set(seen).size !== seen.length)
        wrong.push("the map in 3-D does not turn, come nearer or change its lights");
}

async function look() {
    page = frame.contentDocument;
    view = frame.contentWindow;
    const names = (what, found) => found.length && wrong.push(`${what}: ${found}`);
    if (page.documentElement.scrollWidth > view.innerWidth)
        wrong.push("wider than the window");
    all("details").forEach(details => details.open = true);
    names("columns that cannot be reached", all("table").filter(unreachable).map(t => t.rows[0].textContent.trim().slice(0, 60)));
    names("columns not sorted", all("table.sortable thead th").filter(unsorted).map(head => head.textContent));
    all("img").forEach(image => image.loading = "eager");
    names("pictures that are not there", all("img").filter(i => i.complete && !i.naturalWidth).map(i => i.src));
    names("fetched", view.performance.getEntriesByType("resource").map(e => e.name).filter(n => !/^(file|data):/.test(n)));
    if (find("#wipe"))
        await slide();
    if (find("#world"))
        turn();
}
frame.onload = () => look().catch(error => wrong.push(error.stack)).then(() => console.log("wrong: " + JSON.stringify(wrong)));
</script>'''


def problems(program, page, width):
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        frame = pathlib.Path(folder, 'frame.html')
        frame.write_text(FRAME % (width, json.dumps(page.resolve().as_uri())))
        browser = subprocess.Popen([program, *OPTIONS, '--user-data-dir=' + folder, frame.as_uri()], stderr=subprocess.PIPE, text=True)
        late, found = threading.Timer(120, browser.kill), []
        late.start()
        for line in browser.stderr:
            answer = re.search('"wrong: (.*)", source: ', line)
            if answer:
                found += json.loads(answer[1])
                break
            found += re.findall(r':CONSOLE\S* (.*)', line)
        else:
            found.append('no answer')
        late.cancel()
        browser.kill()
        browser.communicate()
    return found


def main():
    program = shutil.which('chromium')
    if not program:
        sys.exit(print('chromium is not installed'))
    pages = [pathlib.Path(argument) for argument in sys.argv[1:]]
    sys.exit('\n'.join('%s at %d pixels: %s' % (page, width, what) for page in pages for width in WIDTHS
                       for what in problems(program, page, width)) or 0)


if __name__ == '__main__':
    main()
