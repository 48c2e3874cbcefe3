"""A program in a terminal of its own, and a picture of its screen as an HTML page.

Knows the control sequences that ncurses sends to a terminal of the kind "linux" (terminfo; ECMA-48), no others.
"""
import fcntl, html, os, pty, re, select, signal, struct, termios, time

from browser import PATIENCE_S

COLOURS = '#15181a', '#d9534f', '#4fb878', '#d9a441', '#5b9bd5', '#b07cc6', '#4fb8c4', '#d5dad7'  # black to white, as SGR 30 to 37
SEQUENCE = re.compile(rb'\x1b\[([?0-9;]*)([@A-Za-z])|\x1b[()][A-Z0-9]|\x1b\](?:R|P[0-9A-Fa-f]{7})|\x1b[78=>c]')


class Terminal:
    """Use it in a `with` statement; the program is killed at its end."""

    def __init__(self, command, environment, rows=24, columns=80):
        self.rows, self.columns, self._text = rows, columns, b''
        self._cells = [[(' ', ())] * columns for _ in range(rows)]
        self._row = self._column = 0
        self._style = {}
        self._pid, self._end = pty.fork()
        if self._pid == 0:
            os.execvpe(command[0], command, {**environment, 'TERM': 'linux'})
        fcntl.ioctl(self._end, termios.TIOCSWINSZ, struct.pack('HHHH', rows, columns, 0, 0))

    def __enter__(self):
        return self

    def __exit__(self, *error):
        os.kill(self._pid, signal.SIGKILL)
        os.waitpid(self._pid, 0)
        os.close(self._end)

    def press(self, keys):
        os.write(self._end, keys.encode())

    def read_for(self, seconds):
        """Shows what the program writes meanwhile."""
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            if select.select([self._end], [], [], left)[0]:
                self._show(os.read(self._end, 1 << 16))

    def lines(self):
        return [''.join(character for character, _ in row) for row in self._cells]

    def wait_for(self, condition, held=''):
        """Until the condition holds of lines(); a held key is repeated meanwhile, as a keyboard does."""
        end = time.monotonic() + PATIENCE_S
        while not condition('\n'.join(self.lines())):
            if time.monotonic() > end:
                raise RuntimeError('in vain waited at this screen:\n' + '\n'.join(self.lines()))
            if held:
                self.press(held)
            self.read_for(0.05)

    def _show(self, data):
        self._text += data
        while self._text:
            if match := SEQUENCE.match(self._text):
                if match[2]:
                    self._control(match[1], chr(match[2][0]))
                self._text = self._text[match.end():]
            elif self._text[0] == 0x1b:
                if len(self._text) > 40:
                    raise RuntimeError(f'a control sequence that is not known: {self._text[:40]!r}')
                return  # the rest of it is still to come
            else:
                self._character(self._text[0])
                self._text = self._text[1:]

    def _character(self, code):
        if code == 0x0d:
            self._column = 0
        elif code == 0x0a:
            self._row = min(self._row + 1, self.rows - 1)
        elif code == 0x08:
            self._column = max(self._column - 1, 0)
        elif code >= 0x20:
            self._put(chr(code))

    def _put(self, character):
        if self._column == self.columns:  # the last column holds the cursor until the next character
            self._row, self._column = min(self._row + 1, self.rows - 1), 0
        self._cells[self._row][self._column] = (character, tuple(sorted(self._style.items())))
        self._column += 1

    def _control(self, parameters, final):
        numbers = [int(each or 0) for each in parameters.split(b';')] if not parameters.startswith(b'?') else []
        first = numbers[0] if numbers else 0
        blank = (' ', tuple(sorted(item for item in self._style.items() if item[0] == 'background')))
        if final == 'H':
            self._row, self._column = max(first, 1) - 1, max(numbers[1] if len(numbers) > 1 else 1, 1) - 1
        elif final in 'ABCDGd':
            step = max(first, 1)
            row = {'A': self._row - step, 'B': self._row + step, 'd': step - 1}.get(final, self._row)
            column = {'C': self._column + step, 'D': self._column - step, 'G': step - 1}.get(final, self._column)
            self._row, self._column = min(max(row, 0), self.rows - 1), min(max(column, 0), self.columns - 1)
        elif final in 'KX':
            to = min(self._column + max(first, 1), self.columns) if final == 'X' else self.columns
            start, to = (0, self._column + 1) if final == 'K' and first == 1 else (self._column, to)
            self._cells[self._row][start:to] = [blank] * (to - start)
        elif final in 'P@':  # characters taken out, put in
            row, count = self._cells[self._row], min(max(first, 1), self.columns - self._column)
            rest = row[self._column + count:] + [blank] * count if final == 'P' else [blank] * count + row[self._column:-count]
            row[self._column:] = rest
        elif final in 'ML':  # lines
            count = min(max(first, 1), self.rows - self._row)
            new, rest = [[blank] * self.columns for _ in range(count)], self._cells[self._row:]
            self._cells[self._row:] = rest[count:] + new if final == 'M' else new + rest[:-count]
        elif final == 'J':
            self._cells[self._row][self._column:] = [blank] * (self.columns - self._column)
            self._cells[self._row + 1:] = [[blank] * self.columns for _ in range(self.rows - self._row - 1)]
        elif final == 'm':
            for number in numbers:
                self._set_style(number)
        elif final not in 'hlrc':
            raise RuntimeError(f'a control sequence that is not known: {final}')

    def _set_style(self, number):
        if number == 0:
            self._style = {}
        elif number in (1, 2, 7):
            self._style[{1: 'bold', 2: 'dim', 7: 'reverse'}[number]] = True
        elif number in (21, 22):
            self._style.pop('bold', None), self._style.pop('dim', None)
        elif number == 27:
            self._style.pop('reverse', None)
        elif number in (39, 49):
            self._style.pop('colour' if number == 39 else 'background', None)
        elif 30 <= number < 48:
            self._style['colour' if number < 40 else 'background'] = number % 10

    def page(self):
        """The screen as an HTML page: a `pre` of its size."""
        spans = []
        for row in self._cells:
            for character, style in row:
                style = dict(style)
                colour, back = COLOURS[style.get('colour', 7)], COLOURS[style.get('background', 0)]
                if 'reverse' in style:
                    colour, back = back, colour
                css = f'color:{colour};background:{back}' + (';font-weight:bold' if 'bold' in style else '') + (';opacity:.6' if 'dim' in style else '')
                spans.append((css, character))
            spans.append(('', '\n'))
        merged = []
        for css, text in spans:
            if merged and merged[-1][0] == css:
                merged[-1][1] += text
            else:
                merged.append([css, text])
        text = ''.join(f'<span style="{css}">{html.escape(words)}</span>' for css, words in merged)
        return ('<!doctype html><meta charset="utf-8"><style>body{margin:0;background:#15181a}pre{display:inline-block;margin:0;'
                f'padding:10px;font:15px/18px "DejaVu Sans Mono",monospace}}</style><pre>{text}</pre>')
