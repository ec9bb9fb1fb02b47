#!/usr/bin/env python3
"""Uses pages as a reader does, in headless Chromium without a network: pages_test.py PAGE...

At 1400 and 400 pixels: nothing is wider than the window, every column of a table can be scrolled to, every head of a sortable
table sorts both ways, a slider slides, matches answer to clicks, a map in 3-D turns, nothing is fetched but files, no script
fails. Says "chromium is not installed" and ends well without it. Needs Python alone: Chromium is spoken to by its debugging pipe.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

WIDTHS = (1400, 400)
WITHOUT_NETWORK = ('--headless=new', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage', '--hide-scrollbars',
                   '--host-resolver-rules=MAP * ~NOTFOUND', '--disable-background-networking', '--no-first-run')

TOO_WIDE = 'document.documentElement.scrollWidth - innerWidth'
FETCHED = 'performance.getEntriesByType("resource").map(e => e.name).filter(n => !/^(file|data):/.test(n))'
BROKEN = '[...document.images].filter(i => { i.loading = "eager"; return i.complete && !i.naturalWidth; }).map(i => i.src)'
UNREACHABLE = '''[...document.querySelectorAll("details")].forEach(d => d.open = true);
[...document.querySelectorAll("table")].filter(t => {
    const box = t.closest(".scroll") || document.documentElement, cells = t.rows[0].cells;
    box.scrollLeft = 1e6;
    const last = cells[cells.length - 1].getBoundingClientRect(), covered = cells[0].getBoundingClientRect().right;
    box.scrollLeft = 0;
    return last.right > innerWidth + 1 || cells.length > 1 && last.left < covered - 1;
}).map(t => t.rows[0].textContent.trim().slice(0, 60))'''
# A column's values as a reader sees them: texts, or numbers, with those that lack a figure at the end.
UNSORTED = '''[...document.querySelectorAll("table.sortable")].flatMap(t => [...t.tHead.rows[0].cells].filter(head => {
    const values = () => [...t.tBodies[0].rows].map(r => r.cells[head.cellIndex]).map(c => c.dataset.value || c.textContent.trim());
    const inOrder = sign => {
        const all = values(), numbers = all.map(parseFloat).filter(v => !isNaN(v));
        const some = numbers.length ? numbers : all.map(v => v.toLowerCase());
        return some.every((v, i) => !i || (sign > 0 ? some[i - 1] <= v : some[i - 1] >= v));
    };
    const before = values().sort().join(), wrong = [1, 2].some(() => {
        head.querySelector("button").click();
        return !inOrder(head.getAttribute("aria-sort") === "ascending" ? 1 : -1);
    });
    return wrong || values().sort().join() !== before;
})).map(head => head.textContent)'''


class Browser:
    """Chromium at the other end of two pipes: messages are JSON, each ended by a zero."""

    def __init__(self, program, profile):
        commands, self.commands = os.pipe()
        self.answers, answers = os.pipe()

        def pipes():  # Chromium reads from 3 and writes to 4
            spare = os.dup2(commands, 30), os.dup2(answers, 31)
            os.dup2(spare[0], 3)
            os.dup2(spare[1], 4)
        self.process = subprocess.Popen([program, *WITHOUT_NETWORK, '--remote-debugging-pipe', '--user-data-dir=' + profile],
                                        preexec_fn=pipes, close_fds=False, stderr=subprocess.DEVNULL)
        os.close(commands)
        os.close(answers)
        self.number, self.rest, self.events, self.session = 0, b'', [], None
        target = self.call('Target.createTarget', url='about:blank')['targetId']
        self.session = self.call('Target.attachToTarget', targetId=target, flatten=True)['sessionId']
        for domain in ('Page', 'Runtime', 'Log'):
            self.call(domain + '.enable')

    def receive(self):
        while b'\0' not in self.rest:
            more = os.read(self.answers, 1 << 20)
            if not more:
                sys.exit('chromium ended')
            self.rest += more
        text, _, self.rest = self.rest.partition(b'\0')
        message = json.loads(text)
        if 'method' in message:
            self.events.append(message)
        return message

    def call(self, method, **parameters):
        self.number += 1
        message = {'id': self.number, 'method': method, 'params': parameters}
        if self.session:
            message['sessionId'] = self.session
        os.write(self.commands, json.dumps(message).encode() + b'\0')
        while True:
            answer = self.receive()
            if answer.get('id') == self.number:
                if 'error' in answer:
                    sys.exit('%s: %s' % (method, answer['error']))
                return answer['result']

    def open(self, page, width):
        self.call('Emulation.setDeviceMetricsOverride', width=width, height=900, deviceScaleFactor=1, mobile=width < 600)
        self.events.clear()
        self.call('Page.navigate', url=page.resolve().as_uri())
        while not any(event['method'] == 'Page.loadEventFired' for event in self.events):
            self.receive()

    def value(self, script):
        found = self.call('Runtime.evaluate', expression=script, returnByValue=True, awaitPromise=True)
        if 'exceptionDetails' in found:
            return str(found['exceptionDetails'])
        return found['result'].get('value')

    def place(self, selector):
        """The middle of an element, scrolled to, and half its width."""
        return self.value('{const e = document.querySelector(%s); e.scrollIntoView({block: "center"});'
                          'const r = e.getBoundingClientRect(); [r.x + r.width / 2, r.y + r.height / 2, r.width / 2]}'
                          % json.dumps(selector))

    def click(self, x, y):
        for kind in ('mousePressed', 'mouseReleased'):
            self.call('Input.dispatchMouseEvent', type=kind, x=x, y=y, button='left', clickCount=1)

    def failures(self):
        return [event['params'] for event in self.events if event['method'] == 'Runtime.exceptionThrown' or
                event['method'] == 'Log.entryAdded' and event['params']['entry']['level'] == 'error']


def slide(browser):
    """What is wrong with the slider between two pictures, the scenes, and the matches on them."""
    if not browser.value('!!document.querySelector("#wipe")'):
        return
    x, y, half = browser.place('#wipe')
    shown = []
    for part in (-.5, .5):
        browser.click(x + part * half, y)
        shown.append(browser.value('getComputedStyle(document.querySelector("#night")).clipPath'))
    if shown[0] == shown[1]:
        yield 'the slider does not change what is shown: %s' % shown

    def told():
        return browser.value('document.querySelector("#told").textContent')

    pictures = set()
    for scene in range(browser.value('document.querySelectorAll("#scenes button").length')):
        browser.click(*browser.place('#scenes button:nth-of-type(%d)' % (scene + 1))[:2])
        pictures.add(browser.value('document.querySelector("#night").src'))
        if browser.value('Promise.all([...document.querySelectorAll("#frame img")].map(i => i.decode())).then(() => 0, () => 1)'):
            yield 'scene %d lacks a picture' % scene
        for chosen in range(browser.value('document.querySelectorAll("#methods button").length')):
            browser.click(*browser.place('#methods button:nth-of-type(%d)' % (chosen + 1))[:2])
            drawn = browser.value('document.querySelectorAll("#matches g").length')
            right, wrong, _, step = map(int, re.findall(r'\d+', told()))
            if drawn != -(-(right + wrong) // step) or not drawn:
                yield 'scene %d, method %d draws %d of %d matches' % (scene, chosen, drawn, right + wrong)
        before = told()
        browser.click(*browser.place('#matches g .hit')[:2])
        if told() == before:
            yield 'scene %d: a click on a match tells nothing' % scene
    if len(pictures) != scene + 1:
        yield '%d scenes have %d pictures' % (scene + 1, len(pictures))


def turn(browser):
    """What is wrong with the map in 3-D."""
    if not browser.value('!!document.querySelector("#world")'):
        return
    x, y, _ = browser.place('#world')
    seen = [browser.value('document.querySelector("#world").toDataURL()')]
    for kind, where in (('mousePressed', x), ('mouseMoved', x + 60), ('mouseReleased', x + 60)):
        browser.call('Input.dispatchMouseEvent', type=kind, x=where, y=y, button='left', buttons=1, clickCount=1)
    seen.append(browser.value('document.querySelector("#world").toDataURL()'))
    for selector in ('#nearer', 'label input'):
        browser.click(*browser.place(selector)[:2])
        seen.append(browser.value('document.querySelector("#world").toDataURL()'))
    if len(set(seen)) != len(seen):
        yield 'the map in 3-D does not turn, come nearer or change its lights'


def problems(browser, page, width):
    browser.open(page, width)
    if browser.value(TOO_WIDE) > 0:
        yield 'wider than the window'
    for script, what in ((UNREACHABLE, 'columns that cannot be reached'), (UNSORTED, 'columns not sorted'),
                         (BROKEN, 'pictures that are not there'), (FETCHED, 'fetched')):
        found = browser.value(script)
        if found:
            yield '%s: %s' % (what, found)
    yield from slide(browser)
    yield from turn(browser)
    if browser.failures():
        yield 'failures: %s' % browser.failures()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('pages', type=pathlib.Path, nargs='+', metavar='PAGE')
    arguments = parser.parse_args()
    program = shutil.which('chromium')
    if not program:
        sys.exit(print('chromium is not installed'))
    wrong = []
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        browser = Browser(program, profile)
        try:
            for page in arguments.pages:
                for width in WIDTHS:
                    wrong += ['%s at %d pixels: %s' % (page, width, what) for what in problems(browser, page, width)]
        finally:
            browser.process.kill()
            browser.process.wait()
    sys.exit('\n'.join(wrong) or 0)


if __name__ == '__main__':
    main()
