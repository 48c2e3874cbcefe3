#!/usr/bin/env python3
"""Looks at every page in a browser: live view, playback, report and comparison, at four sizes, light and dark.

    scripts/check-pages.py [--build DIR] [--shots-only] [--list] [PAGE...]

PAGE is a name of --list, or a pattern such as 'live-*'; default: all. Prints each finding of axe-core and of
tests/server/live/page_checks.js with page, rule, selector, and where it was: a contrast, a control without a name, text
that is cut or covered. Screenshots are in build/pages/, PAGE-WIDTHxHEIGHT-light.png and -dark.png.

Needs a build in build/release (or DIR) and chromium-headless-shell; axe-core comes by npm into build/pages/axe, the
first time alone. --shots-only: without axe-core and its npm. Takes a quarter of an hour on two cores.

Exit status: 0 no finding; 1 findings; 2 wrong use, or a page could not be looked at.
"""
import argparse, collections, contextlib, dataclasses, fnmatch, pathlib, shutil, subprocess, sys, typing

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / 'pages'))
from browser import Browser, end_on_request
from served import ROOT, environment, live_view, place_robot, playback

OUT = ROOT / 'build/pages'
AXE = '4.14.1'
PAGE_CHECKS = ROOT / 'tests/server/live/page_checks.js'
SIZES = (1280, 720, False), (1440, 900, False), (844, 390, True), (390, 844, True)  # the last two are phones
WORLDS = 'flat', 'hills', 'rubble-mesh'
ROBOTS = 0, 1, 4

# axe.run() with all rules but those it calls experimental; target-size (WCAG 2.2, 2.5.8) is off by itself. The playback's
# marks are as wide as their time, which is essential there; a pointer is taken by the whole lane that they are in.
RUN_AXE = '''axe.run(document, {rules: {'target-size': {enabled: true}}, resultTypes: ['violations'], selectors: true, elementRef: true, iframes: false})
  .then(({violations}) => violations.flatMap(({id, help, nodes}) => nodes
    .filter(({element}) => !(id === 'target-size' && element.matches('#marks > .mark')))
    .map(({target}) => [`${id} (${help})`, target.join(' ')])))'''
RUN_PAGE_CHECKS = '''['overlaps', 'pale', 'nameless', 'small'].flatMap((rule) => window[rule]().map((what) => [rule, what]))'''
# Software draws the 3D view: at full rate it would leave no time for what looks at the page.
FEW_FRAMES = '''(() => {
  const { requestAnimationFrame } = window;
  window.requestAnimationFrame = (draw) => setTimeout(() => requestAnimationFrame(draw), 250);
  window.cancelAnimationFrame = (timer) => clearTimeout(timer);
})()'''
IS_DRAWN = 'new Promise((drawn) => setTimeout(() => requestAnimationFrame(() => drawn(true)), 500))'  # the 3D view takes turns


@dataclasses.dataclass
class Page:
    name: str
    served: typing.Callable[[pathlib.Path], contextlib.AbstractContextManager]  # of the build: gives the address
    prepare: typing.Callable[[Browser], None] = lambda browser: None
    ready: typing.Callable[[Browser], None] = lambda browser: None  # before each look
    switches: tuple = ()  # of the browser
    has_page_checks: bool = True  # page_checks.js is of the live view's layout, in which nothing covers anything or scrolls
    expected: str = ''  # what the browser complains of there


HAS_PICTURES = ("document.querySelectorAll('#pictures img').length === 2 && "
                "[...document.querySelectorAll('#pictures img')].every((picture) => picture.naturalWidth > 0)")


def connected(browser):
    browser.wait_for("document.getElementById('link')?.dataset.state === 'good'")


# Takes the robot, too, from a page that was busy for longer than 10 s: by the server's rules it was let go of.
HOLDS = '''(() => {
  const take = document.getElementById('take');
  if (!take.disabled) take.click();
  return document.getElementById('drive-state').dataset.state === 'held';
})()'''


def place(robots):
    """Places robots by hand at free starts, the last of which is held."""
    def placed(browser):
        connected(browser)
        for robot in range(robots):
            browser.wait_for("!document.getElementById('place').disabled")
            place_robot(browser)
            browser.wait_for(f"document.getElementById('robot').options.length === {robot + 1}")
            browser.wait_for(HOLDS)
    return placed


def held(browser):
    connected(browser)
    browser.wait_for(HOLDS)
    browser.wait_for(HAS_PICTURES)


def press(identity):
    def pressed(browser):
        place(1)(browser)
        browser.evaluate(f"document.getElementById('{identity}').click()")
    return pressed


def data(build):
    """Runs, two diagnoses and a comparison of them; made again when the program is newer."""
    folder = OUT / 'data'
    done = folder / 'done'
    if done.exists() and done.stat().st_mtime > (build / 'bin/kenaf-gap').stat().st_mtime:
        return folder
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    manoeuvres = '--manoeuvre straight --manoeuvre turn-in-place --manoeuvre step-150-flippers --repeats 2'
    physics = '--physics time_step_s=0.0005 --physics solver_iterations=20'
    for command in (f'simulate {manoeuvres} --effect drive_lag:lag_s=0.05 {physics} --out real',
                    f'simulate {manoeuvres} --seed 3 --out sim', 'diagnose real --out diagnosis', 'diagnose sim --out no-gap',
                    'compare real sim --out compared'):
        ran = subprocess.run(['kenaf-gap', *command.split()], cwd=folder, env=environment(build), capture_output=True, text=True)
        if ran.returncode:
            raise RuntimeError(f'kenaf-gap {command}: status {ran.returncode}\n{ran.stderr}')
    done.touch()
    return folder


def live(world):
    return lambda build: live_view(build, world)


def file_of(name):
    return lambda build: contextlib.nullcontext(f'file://{data(build) / name}')


def play(build):
    return playback(build, data(build) / 'real', data(build) / 'diagnosis', 'step-150-flippers')


def played(browser):
    browser.wait_for("document.querySelectorAll('.mark').length && document.querySelectorAll('#difference td').length")
    for _ in range(30):  # to where the robots differ
        browser.press('ArrowRight')


def curves(browser):
    played(browser)
    browser.evaluate("document.getElementById('channels').open = true")


PAGES = [
    *(Page(f'live-{world}-{robots}', live(world), place(robots), held if robots else connected) for world in WORLDS for robots in ROBOTS),
    Page('live-keys', live('flat'), press('help-open'), connected),
    Page('live-question', live('flat'), press('remove'), connected),
    Page('live-cameras', live('step-200'), place(1), held, ('--disable-3d-apis',), expected='WebGL'),
    Page('play', play, played, has_page_checks=False),
    Page('play-curves', play, curves, has_page_checks=False),
    Page('report', file_of('diagnosis/report.html'), has_page_checks=False),
    Page('report-no-gap', file_of('no-gap/report.html'), has_page_checks=False),
    Page('compare', file_of('compared/compare.html'), has_page_checks=False),
]


def axe():
    """axe-core's source, fetched if it is not there."""
    folder = OUT / 'axe'
    source = folder / 'node_modules/axe-core/axe.min.js'
    package = folder / 'node_modules/axe-core/package.json'
    if not (source.exists() and f'"version": "{AXE}"' in package.read_text()):
        folder.mkdir(parents=True, exist_ok=True)
        done = subprocess.run(['npm', 'install', '--prefix', str(folder), '--no-save', '--no-audit', '--no-fund', '--ignore-scripts',
                               f'axe-core@{AXE}'], capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f'npm could not install axe-core {AXE}:\n{done.stderr}')
    return source.read_text()


def look_at(page, build, axe_source):
    """Takes the pictures; returns where each finding, a pair of rule and selector, was seen."""
    found = collections.defaultdict(list)
    with page.served(build) as url, Browser(page.switches) as browser:
        width, height, phone = SIZES[0]
        browser.resize(width, height, phone)
        browser.call('Page.addScriptToEvaluateOnNewDocument', source=FEW_FRAMES)
        browser.open(url)
        page.prepare(browser)
        browser.evaluate(axe_source + ';0')
        browser.evaluate(PAGE_CHECKS.read_text() + ', 0')
        for width, height, phone in SIZES:
            browser.resize(width, height, phone)
            for dark in False, True:
                browser.set_dark(dark)
                page.ready(browser)
                browser.evaluate(IS_DRAWN)
                where = f"{width}x{height}-{'dark' if dark else 'light'}"
                browser.screenshot(OUT / f'{page.name}-{where}.png')
                findings = browser.evaluate(RUN_AXE) if axe_source else []
                page_width = browser.evaluate('document.documentElement.scrollWidth')
                if page_width > width:
                    findings.append(('wider than the screen', f'html, {page_width}'))
                if page.has_page_checks:
                    findings += browser.evaluate(RUN_PAGE_CHECKS)
                for rule, selector in findings:
                    found[rule, selector].append(where)
        for complaint in browser.complaints:
            if page.expected and page.expected in complaint:
                continue
            found['the browser complains', complaint].append('at any size')
    return found


def main():
    words = __doc__.split('\n\n')
    parser = argparse.ArgumentParser(usage=words[1].strip(), description=words[0], epilog='\n\n'.join(words[2:]),
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--build', type=pathlib.Path, default=ROOT / 'build/release')
    parser.add_argument('--shots-only', action='store_true')
    parser.add_argument('--list', action='store_true')
    parser.add_argument('pages', metavar='PAGE', nargs='*', default=['*'])
    arguments = parser.parse_args()
    for pattern in arguments.pages:
        if not any(fnmatch.fnmatch(page.name, pattern) for page in PAGES):
            parser.error(f"no page '{pattern}'; --list has them")
    pages = [page for page in PAGES if any(fnmatch.fnmatch(page.name, pattern) for pattern in arguments.pages)]
    if arguments.list:
        print('\n'.join(page.name for page in pages))
        return 0

    end_on_request()
    OUT.mkdir(parents=True, exist_ok=True)
    count = 0
    try:
        source = '' if arguments.shots_only else axe()
        for page in pages:
            found = look_at(page, arguments.build.resolve(), source)
            for (rule, selector), where in found.items():
                print(f"{page.name}: {rule}: {selector} [{'everywhere' if len(where) == 2 * len(SIZES) else ', '.join(where)}]", flush=True)
            count += len(found)
            print(f'check-pages: {page.name}: {len(found) or "no"} finding{"s" * (len(found) != 1)}', file=sys.stderr, flush=True)
    except (OSError, RuntimeError) as error:
        print(f'check-pages: {error}', file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    return 1 if count else 0


if __name__ == '__main__':
    sys.exit(main())
