#!/usr/bin/env python3
"""Takes a picture of a page for docs/pictures; scripts/refresh-figures.sh calls it.

    scripts/pages/picture.py live-view BUILD PNG                 a robot that is driven by hand up to a step
    scripts/pages/picture.py playback BUILD PNG RUNS REPORT      a climb beside its simulations, where they part
    scripts/pages/picture.py console BUILD PNG PORT              the console of the control process on PORT, on a step
"""
import pathlib, re, sys

from browser import Browser, end_on_request
from served import environment, live_view, place_robot, playback
from terminal import Terminal


def picture_of_live_view(build, png):
    """The front flippers up and towards the step, then held before it."""
    with live_view(build, 'step-200') as url, Browser() as browser:
        browser.resize(1280, 800)
        browser.open(url)
        browser.wait_for("document.getElementById('link')?.dataset.state === 'good'")
        place_robot(browser)
        browser.wait_for("document.getElementById('drive-state').dataset.state === 'held'")
        for code, until in ('Digit3', "/^4[45]/.test(reading('Angles'))"), ('KeyW', "Number(reading('Travel').split(',')[0]) > 0.45"):
            browser.key(code, True)
            browser.wait_for("((reading) => " + until + ")((name) => [...document.querySelectorAll('#readings dt')]"
                             ".find((term) => term.textContent === name).nextElementSibling.textContent)")
            if code != 'KeyW':
                browser.key(code, False)
        browser.wait_for("document.getElementById('alarm').hidden && "
                         "[...document.querySelectorAll('#pictures img')].every((picture) => picture.naturalWidth > 0)")
        browser.screenshot(png)
        browser.key('KeyW', False)


def picture_of_playback(build, png, runs, report):
    with playback(build, runs, report, 'step-150-flippers') as url, Browser() as browser:
        browser.resize(1280, 800)
        browser.open(url)
        browser.wait_for("document.querySelectorAll('.mark').length && document.querySelectorAll('#difference td').length")
        # to the largest distance between the recorded robot and the nominal one
        largest, at = -1, 0
        for step in range(100):
            distance = abs(float(browser.evaluate("document.querySelector('#difference tbody tr td').textContent.replace('\\u2212', '-')")))
            if distance > largest:
                largest, at = distance, step
            for _ in range(10):
                browser.key('ArrowRight', True)
                browser.key('ArrowRight', False)
        browser.key('Home', True)
        for _ in range(10 * at):
            browser.key('ArrowRight', True)
            browser.key('ArrowRight', False)
        browser.screenshot(png)


def picture_of_console(build, png, port):
    command = ['operator_console', '--control', f'127.0.0.1:{port}']
    with Terminal(command, environment(build)) as terminal, Browser() as browser:
        terminal.wait_for(lambda screen: 'DRIVING' in screen or 'READY' in screen.upper())
        terminal.press('3')
        terminal.read_for(4)
        terminal.wait_for(lambda screen: (up := re.search(r'nose up ([0-9.]+)', screen)) and float(up[1]) > 20, held='w')
        browser.resize(760, 460)
        browser.call('Page.setDocumentContent', frameId=browser.call('Page.getFrameTree')['frameTree']['frame']['id'], html=terminal.page())
        width, height = browser.evaluate("(() => { const box = document.querySelector('pre').getBoundingClientRect();"
                                         " return [Math.ceil(box.width), Math.ceil(box.height)]; })()")
        browser.resize(width, height)
        browser.screenshot(png)


def main():
    pictures = {'live-view': picture_of_live_view, 'playback': picture_of_playback, 'console': picture_of_console}
    if len(sys.argv) < 4 or sys.argv[1] not in pictures or len(sys.argv) != {'live-view': 4, 'playback': 6, 'console': 5}[sys.argv[1]]:
        print(__doc__, file=sys.stderr)
        return 2
    end_on_request()
    pictures[sys.argv[1]](pathlib.Path(sys.argv[2]).resolve(), *sys.argv[3:])
    return 0


if __name__ == '__main__':
    sys.exit(main())
