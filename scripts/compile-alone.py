#!/usr/bin/env python3
"""Checks that each source file and each header of the project compiles alone.

    scripts/compile-alone.py BUILD [--first FILE...] [--seconds N]

BUILD is configured with clang and without KENAF_COMPILE_TOGETHER. Parses all files of its compile_commands.json with
their own flags, and each header that no file includes first, without generating code: 4 minutes on two cores. What
includes one of the FILEs, itself or through others, comes first; no file is started after N seconds.

Headers of the standard and of Eigen, Catch2 and fmt are parsed once for all files, so a missing include of one of those
is not seen; one of the project's own is. Exit status 0: all that were parsed compile.
"""
import argparse, concurrent.futures, json, os, pathlib, re, shlex, subprocess, sys, tempfile, time

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHARED_HEADERS = '''
    algorithm array atomic charconv chrono cmath condition_variable cstdint cstring deque filesystem fstream functional
    iostream limits map memory mutex numbers numeric optional random regex set span sstream stdexcept string string_view
    thread unordered_map utility variant vector Eigen/Dense Eigen/Geometry catch2/catch.hpp fmt/format.h'''.split()
# Headers that need what Debian 12 does not have.
FOR_ANOTHER_DEBIAN = './tests/support/catch2_v3/'

def flags(command):
    """Returns what a compile command says of where headers are and which macros are set."""
    words = shlex.split(command)
    after = [word + value for word, value in zip(words, words[1:]) if word in ('-I', '-D', '-isystem')]
    return [w for w in words + after if re.match(r'-(I|D|isystem|std=).', w)]

def parse(words, source, cwd, end):
    """Returns what the compiler says of a file that does not compile, '' for one that does, None after the end."""
    if time.monotonic() > end:
        return None
    done = subprocess.run(['clang++', *words, '-fsyntax-only', str(source)], cwd=cwd, capture_output=True, text=True)
    return done.stderr if done.returncode else ''

def shared_headers(folder):
    """Parses the headers of others once; returns the option that uses the result."""
    text = folder / 'shared.hpp'
    text.write_text(''.join(f'#include <{header}>\n' for header in SHARED_HEADERS))
    out = folder / 'shared.pch'
    subprocess.run(['clang++', '-std=c++20', '-isystem', '/usr/include/eigen3', '-Xclang', '-fpch-instantiate-templates',
                    '-x', 'c++-header', str(text), '-o', str(out)], check=True)
    return ['-include-pch', str(out)]

def included(file, known={}):
    """Returns the project's files that a file includes, itself or through others, and itself."""
    if file not in known:
        known[file] = {file}
        for name in re.findall(r'^#include "([^"]+)"', file.read_text(), re.M):
            for path in (ROOT / name, ROOT / 'include' / name, file.parent / name):
                if path.is_file():
                    known[file] |= included(path)
                    break
    return known[file]

def headers_not_first(sources):
    """Returns the project's headers that no source file includes before all others."""
    first = set()
    for source in sources:
        include = re.search(r'^#include "([^"]+)"', source.read_text(), re.M)
        if include:
            first |= {ROOT / include[1], source.parent / include[1]}
    listed = subprocess.run(['find', '.', '-path', './build', '-prune', '-o', '-name', '*.hpp', '-print'], cwd=ROOT,
                            capture_output=True, text=True, check=True).stdout.split()
    return sorted({ROOT / name for name in listed if not name.startswith(FOR_ANOTHER_DEBIAN)} - first)

def all_files(build):
    """Returns a pair of flags and path for each file to parse."""
    entries = [e for e in json.loads((build / 'compile_commands.json').read_text()) if e['file'].endswith('.cpp')]
    flags_of = {pathlib.Path(e['file']): flags(e['command']) for e in entries if not e['file'].startswith(f'{build}/')}
    flags_of_folder = {file.parent: words for file, words in flags_of.items()}
    most_flags = max(flags_of.values(), key=len)
    headers = [(flags_of_folder.get(h.parent, most_flags) + ['-x', 'c++'], h) for h in headers_not_first(flags_of)]
    return [(words, file) for file, words in flags_of.items()] + headers

def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('build', type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument('--first', nargs='*', default=[], type=lambda name: ROOT / name)
    parser.add_argument('--seconds', type=float, default=float('inf'))
    options = parser.parse_args()
    end = time.monotonic() + options.seconds
    files = all_files(options.build)
    first = set(options.first)
    affected = [job for job in files if included(job[1]) & first]
    files = affected + [job for job in files if not included(job[1]) & first]
    with tempfile.TemporaryDirectory() as scratch, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        shared = shared_headers(pathlib.Path(scratch))
        said = list(pool.map(lambda job: parse(shared + job[0], job[1], options.build, end), files))
    failed = [text for text in said if text]
    parsed = len(said) - said.count(None)
    print(''.join(failed), end='', file=sys.stderr)
    print(f'compile-alone: {parsed - len(failed)} of {parsed} files compile alone; {len(files) - parsed} were left for want '
          f'of time, {max(0, len(affected) - parsed)} of them affected by the change')
    sys.exit(1 if failed else 0)

main()
