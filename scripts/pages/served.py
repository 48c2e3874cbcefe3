"""Kenaf's programs that serve pages, on free ports of loopback, from a build."""
import contextlib, os, pathlib, re, subprocess, tempfile, time

from browser import PATIENCE_S

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def environment(build):
    """That of this process, with the build's programs and this tree's descriptions."""
    return {**os.environ, 'KENAF_DATA_DIR': str(ROOT / 'share'), 'PATH': f"{build / 'bin'}:{os.environ['PATH']}",
            'LD_LIBRARY_PATH': str(build / 'lib')}


@contextlib.contextmanager
def served(build, pattern, *command):
    """Runs a server; gives its process number, and what the pattern's group matches in its output once it does."""
    with tempfile.TemporaryFile() as log:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, env=environment(build))
        try:
            end = time.monotonic() + PATIENCE_S
            while True:
                said = os.pread(log.fileno(), 1 << 20, 0).decode(errors='replace')
                if match := re.search(pattern, said):
                    break
                if process.poll() is not None or time.monotonic() > end:
                    raise RuntimeError(f"'{' '.join(map(str, command))}' did not say '{pattern}' but:\n{said}")
                time.sleep(0.05)
            yield match[1], process.pid
        finally:
            process.terminate()
            process.wait()


def live_server(build, world):
    """The address of a live view with the world and no robot, and the number of its process."""
    return served(build, r'live view: (http\S+)', 'kenaf-world', '--world', world, '--port', '0', '--camera-port', '0', '--view', '127.0.0.1:0')


@contextlib.contextmanager
def live_view(build, world):
    """The same address alone."""
    with live_server(build, world) as (url, _):
        yield url


def place_robot(browser):
    """Asks an open live view for a robot at a free start: Enter places it where no place was pointed at."""
    browser.evaluate("document.getElementById('place').click()")
    browser.press('Enter')


@contextlib.contextmanager
def playback(build, runs, report, run=None):
    """The address of a page that plays the runs beside their simulations."""
    first = ['--run', run] if run else []
    command = ['kenaf-gap', 'play', str(runs), '--report', str(report), '--view', '127.0.0.1:0', *first]
    with served(build, r'(http\S+)', *command) as (url, _):
        yield url
