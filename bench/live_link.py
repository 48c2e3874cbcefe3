#!/usr/bin/env python3
"""The live view as an operator has it, in a headless Chromium: over a slow network, and what it costs the server.

    bench/live_link.py [--build DIR] [--world NAME] [--each-way-ms MS] [--repeats N] [--seconds N]

1. Through a network that delays all bytes by MS each way: from a released key, and from Space, until the robot's tracks
   rest (below 0.01 m/s), until the page shows the order to stand in force, and until it shows the tracks at rest, each
   less the round trip; whether the slow link raises the alarm; and by how much the age is wrong that the page gives to
   each camera picture. When the tracks rest, and when a picture was exposed, a second client knows, which hears the
   states beside the network.
2. Without the network: CPU time of kenaf-world with the page and its two pictures open, while the robot stands and while
   it turns in place, and after the page was closed.

The browser draws no 3D: without a graphics card it would draw on the cores that the server needs. So the pictures take its
place in 1; in 2 the world is drawn once and then stands still, and the pictures are as small as they are beside it. Other
load on the machine changes CPU time little and the rest much: run it on an idle one.

Exit status 1: tracks that rest later than 150 ms after the round trip, no alarm, a median age wrong by more than 10 ms, or
more than 0.17 of a core, standing or turning; 2: wrong use.
"""
import argparse, asyncio, base64, bisect, contextlib, json, os, pathlib, socket, sys, threading, time, urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / 'scripts/pages'))
from browser import Browser, end_on_request
from served import ROOT, live_server, place_robot

REST_LIMIT_MS, AGE_LIMIT_MS, COST_LIMIT_CORES = 150, 10, 0.17
REST_MPS = 0.01
AGES_FOR_S = 10
WITHOUT_3D = ['--disable-3d-apis']
STAND_STILL = 'requestAnimationFrame = () => 0, 0'  # of the world in 3D

# Notes, in the page: when a key came up or Space went down; when a state first has the order to stand since, and the robot at rest; which age each
# picture is given, beside the robot time in the picture itself. All times are performance.now().
NOTES = '''(() => {
  const bench = window.bench = { released_ms: null, ordered_ms: null, rested_ms: null, speed_mps: 0, pictures: 0, ages: [] };
  const released = (event) => { bench.released_ms ??= event.timeStamp; };
  addEventListener("keyup", (event) => { if (event.code === "KeyW" || event.code === "KeyS") released(event); }, true);
  addEventListener("keydown", (event) => { if (event.code === "Space") released(event); }, true);
  const heard = (event) => {
    const message = JSON.parse(event.data), robot = message.robots?.[0];
    if (message.type !== "state" || !robot) return;
    bench.speed_mps = Math.max(...robot.track_mps.map(Math.abs));
    if (bench.released_ms === null || !robot.command.track.every((value) => value === 0)) return;
    bench.ordered_ms ??= performance.now();
    if (bench.speed_mps < REST_MPS) bench.rested_ms ??= performance.now();
  };
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function (text) {
    if (!this.isNoted) this.addEventListener("message", heard);
    this.isNoted = true;
    send.call(this, text);
  };
  const robotTime_s = new Map(), make = URL.createObjectURL;
  URL.createObjectURL = (blob) => {
    const url = make.call(URL, blob);
    ++bench.pictures;
    blob.slice(0, 400).text().then((text) => robotTime_s.set(url, Number(/robot_time_s=([0-9.]+)/.exec(text)?.[1])));
    return url;
  };
  bench.watchAges = () => {
    for (const output of document.querySelectorAll("#pictures output")) {
      new MutationObserver(() => {
        const age = /^([0-9]+) ms$/.exec(output.textContent), url = output.closest("figure").querySelector("img").src;
        if (age && url) bench.ages.push({ url, age_ms: Number(age[1]), at_ms: performance.now() });
      }).observe(output, { childList: true, characterData: true, subtree: true });
    }
  };
  bench.agesSeen = () => bench.ages.filter(({ url }) => robotTime_s.has(url))
    .map(({ url, age_ms, at_ms }) => [robotTime_s.get(url), at_ms, age_ms]);
})(), 0'''.replace('REST_MPS', str(REST_MPS))


def epoch_ms():
    return time.time_ns() / 1e6


class Network:
    """A port through which all bytes to a server on loopback, and back, come later by a fixed time."""

    def __init__(self, server_port, each_way_s):
        self._server_port, self._each_way_s = server_port, each_way_s
        self._loop = asyncio.new_event_loop()
        self._listener = self._loop.run_until_complete(asyncio.start_server(self._carry, '127.0.0.1', 0))
        self.port = self._listener.sockets[0].getsockname()[1]
        threading.Thread(target=self._loop.run_forever, daemon=True).start()

    async def _carry(self, reader, writer):
        server_reader, server_writer = await asyncio.open_connection('127.0.0.1', self._server_port)
        await asyncio.gather(self._one_way(reader, server_writer), self._one_way(server_reader, writer), return_exceptions=True)

    async def _one_way(self, reader, writer):
        while not writer.is_closing() and (data := await reader.read(1 << 16)):
            self._loop.call_later(self._each_way_s, lambda data=data: writer.is_closing() or writer.write(data))
        self._loop.call_later(self._each_way_s, writer.close)


class Witness:
    """What the world did when, by the states that a client on loopback gets (RFC 6455)."""

    def __init__(self, port):
        self._robot_time_s, self._reached_ms, self._rests = [], [], []
        self._socket = socket.create_connection(('127.0.0.1', port), timeout=20)
        self._stream = self._socket.makefile('rb')
        self._socket.sendall((f'GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n'
                              'Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: ' +
                              base64.b64encode(os.urandom(16)).decode() + '\r\n\r\n').encode())
        while self._stream.readline().strip():
            pass
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self):
        text = b''
        with contextlib.suppress(OSError, ValueError):  # the server ends
            while head := self._stream.read(2):
                length = head[1] & 0x7f
                if length >= 126:
                    length = int.from_bytes(self._stream.read(2 if length == 126 else 8), 'big')
                payload, kind = self._stream.read(length), head[0] & 0x0f
                if kind == 9:  # a ping: somebody is here
                    self._socket.sendall(b'\x8a\x80\0\0\0\0')
                if kind > 1:
                    continue
                text += payload
                if not head[0] & 0x80:
                    continue
                message, text = json.loads(text), b''
                if message['type'] == 'state' and message['t'] > (self._robot_time_s or [-1])[-1]:
                    self._rests.append(all(order == 0 and abs(speed_mps) < REST_MPS for robot in message['robots']
                                           for order, speed_mps in zip(robot['command']['track'], robot['track_mps'])))
                    self._reached_ms.append(epoch_ms())
                    self._robot_time_s.append(message['t'])

    def reached_ms(self, robot_time_s):
        """Straight between two states; None before the first and after the newest."""
        after = bisect.bisect_left(self._robot_time_s, robot_time_s)
        if not 0 < after < len(self._robot_time_s):
            return None
        t, ms = self._robot_time_s[after - 1:after + 1], self._reached_ms[after - 1:after + 1]
        return ms[0] + (ms[1] - ms[0]) * (robot_time_s - t[0]) / (t[1] - t[0])

    def rested_ms(self, since_ms):
        """When the tracks of all robots had come to rest; None if they had not."""
        first = bisect.bisect_left(self._reached_ms, since_ms)
        return next((ms for ms, rests in zip(self._reached_ms[first:], self._rests[first:]) if rests), None)


def page_origin_ms(browser):
    """The epoch of the page's performance.now(), by the quickest of many questions."""
    def ask():
        asked_ms = epoch_ms()
        page_ms = browser.evaluate('performance.now()')
        took_ms = epoch_ms() - asked_ms
        return took_ms, asked_ms + took_ms / 2 - page_ms
    return min(ask() for _ in range(50))[1]


def open_page(browser, port):
    """With a robot, placed by the page's button and held, and the pictures of its two cameras."""
    browser.resize(1280, 800)
    browser.open(f'http://127.0.0.1:{port}/')
    browser.wait_for("document.getElementById('link')?.dataset.state === 'good'")
    browser.evaluate(NOTES)
    place_robot(browser)
    browser.wait_for("document.getElementById('drive-state').dataset.state === 'held'")
    browser.wait_for("document.querySelectorAll('#pictures img').length === 2 && "
                     "[...document.querySelectorAll('#pictures img')].every((picture) => picture.naturalWidth)")


def rest_after_ms(browser, witness, drive, by_space):
    """From a key, until the page shows the order, until it shows the rest, and until the tracks rest."""
    browser.evaluate('bench.released_ms = bench.ordered_ms = bench.rested_ms = null')
    browser.key(drive, True)
    browser.wait_for('bench.speed_mps > 0.2')
    browser.key('Space' if by_space else drive, by_space)
    browser.wait_for('bench.rested_ms !== null')
    if by_space:
        browser.key('Space', False)
        browser.key(drive, False)
    browser.wait_for("document.getElementById('drive-state').dataset.state === 'held'")
    released_ms, ordered_ms, rested_ms = browser.evaluate('[bench.released_ms, bench.ordered_ms, bench.rested_ms]')
    released_epoch_ms = page_origin_ms(browser) + released_ms
    tracks_rested_ms = witness.rested_ms(released_epoch_ms)  # the page has shown it, so it has happened
    return ordered_ms - released_ms, rested_ms - released_ms, tracks_rested_ms - released_epoch_ms


def report(figure, value, limit=None):
    print(f"{figure},{value:.3g},{'' if limit is None else limit}", flush=True)
    return limit is None or value <= limit


def measure_slow_link(port, each_way_ms, repeats):
    witness, network = Witness(port), Network(port, each_way_ms / 1000)
    with Browser(WITHOUT_3D) as browser:
        open_page(browser, network.port)
        is_good = True
        for by_space, figure in (False, 'key_up'), (True, 'space'):
            # forward and back: the robot stays away from what is in the world
            times = [rest_after_ms(browser, witness, 'KeyS' if i % 2 else 'KeyW', by_space) for i in range(repeats)]
            for until, column in zip(('order_shown', 'rest_shown', 'rest'), zip(*times)):
                less_round_trip_ms = sorted(ms - 2 * each_way_ms for ms in column)
                report(f'{figure}_to_{until}_less_round_trip_ms_median', less_round_trip_ms[repeats // 2])
                is_good &= report(f'{figure}_to_{until}_less_round_trip_ms_worst', less_round_trip_ms[-1],
                                  REST_LIMIT_MS if until == 'rest' else None)

        has_alarm = browser.evaluate("!document.getElementById('alarm').hidden && "
                                     "document.getElementById('alarm').textContent.includes('Slow link')")
        is_good &= report('slow_link_without_alarm', not has_alarm, 0)

        origin_ms = page_origin_ms(browser)
        browser.evaluate('bench.watchAges()')
        time.sleep(AGES_FOR_S)
        seen = browser.evaluate('bench.agesSeen()')
        time.sleep(0.2)  # the witness hears a state that is newer than the last picture
    known = [(origin_ms + at_ms - witness.reached_ms(robot_time_s), age_ms) for robot_time_s, at_ms, age_ms in seen
             if witness.reached_ms(robot_time_s) is not None]
    if not known:
        raise RuntimeError('the page showed no age')
    wrong_ms = sorted(abs(age_ms - true_ms) for true_ms, age_ms in known)
    report('picture_age_ms_median', sorted(true_ms for true_ms, _ in known)[len(known) // 2])
    is_good &= report('picture_age_wrong_by_ms_median', wrong_ms[len(known) // 2], AGE_LIMIT_MS)
    report('picture_age_wrong_by_ms_99_percent', wrong_ms[(len(known) * 99 - 1) // 100])
    return is_good


def cpu_s(pid):
    """User and system time of a process so far."""
    fields = pathlib.Path(f'/proc/{pid}/stat').read_text().rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def measure_cost(port, pid, seconds):
    def cores():
        began_s, cpu = time.monotonic(), cpu_s(pid)
        time.sleep(seconds)
        return (cpu_s(pid) - cpu) / (time.monotonic() - began_s)
    is_good = True
    with Browser() as browser:
        open_page(browser, port)
        browser.evaluate(STAND_STILL)
        for moves, key in ('stands', None), ('turns', 'KeyA'):  # what turns is drawn at each exposure
            if key:
                browser.key(key, True)
                browser.wait_for('bench.speed_mps > 0.1')
            pictures = browser.evaluate('bench.pictures')
            with_page = cores()
            report(f'pictures_a_second_robot_{moves}', (browser.evaluate('bench.pictures') - pictures) / seconds)
            is_good &= report(f'server_cores_with_page_and_two_cameras_robot_{moves}', with_page, COST_LIMIT_CORES)
    time.sleep(4)  # a camera without a reader is drawn for 2 s more
    report('server_cores_without_page', cores())
    return is_good


def main():
    def whole_number(least, most):
        def read(text):
            if not text.isdecimal() or not least <= int(text) <= most:
                raise argparse.ArgumentTypeError(f"'{text}' must be a whole number from {least} to {most}")
            return int(text)
        return read

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--build', type=pathlib.Path, default=ROOT / 'build/release')
    parser.add_argument('--world', default='step-200')
    parser.add_argument('--each-way-ms', type=whole_number(200, 5000), default=250)
    parser.add_argument('--repeats', type=whole_number(1, 1000), default=10, help='stops by a released key, and as many by Space')
    parser.add_argument('--seconds', type=whole_number(1, 3600), default=30, help='of the cost with the page, and without')
    arguments = parser.parse_args()
    end_on_request()
    print('figure,value,limit', flush=True)
    is_good = True
    try:
        for measure in (lambda port, pid: measure_slow_link(port, arguments.each_way_ms, arguments.repeats),
                        lambda port, pid: measure_cost(port, pid, arguments.seconds)):
            with live_server(arguments.build.resolve(), arguments.world) as (url, pid):
                is_good &= measure(urllib.parse.urlsplit(url).port, pid)
    except (OSError, RuntimeError) as error:
        print(f'live_link: {error}', file=sys.stderr)
        return 1
    return 0 if is_good else 1


if __name__ == '__main__':
    sys.exit(main())
