#!/usr/bin/env python3
"""Measures what it saves to compile the files of a folder as one (KENAF_COMPILE_TOGETHER).

    scripts/compile-cost.py [BUILD] [--only TEXT] [--seconds N]     BUILD: default build/release, built before

Compiles each unit of BUILD that has several files once together and once file by file, with the unit's own flags and
precompiled header, and prints the processor time of both. Starts no further unit after N seconds. A unit whose files
take less apart than together does not pay.
"""
import argparse, json, pathlib, re, resource, shlex, subprocess, tempfile, time

def cpu_s(command, cwd):
    """Processor time of a command and its children; its output is dropped. Raises if it fails."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, cwd=cwd, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime

def compile_s(entry, source, out):
    """Compiles `source` with the flags of `entry`, without a compiler cache."""
    words = [w for w in shlex.split(entry['command']) if not w.endswith('ccache')]
    words[words.index('-o') + 1] = out
    words[words.index('-c') + 1] = source
    return cpu_s(words, entry['directory'])

def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('build', nargs='?', default='build/release')
    parser.add_argument('--only', default='', help='only units whose path holds this')
    parser.add_argument('--seconds', type=float, default=float('inf'))
    options = parser.parse_args()
    end = time.monotonic() + options.seconds
    build = pathlib.Path(options.build).resolve()
    units = [e for e in json.loads((build / 'compile_commands.json').read_text()) if '/Unity/unity_' in e['file']]
    together_s = apart_s = 0
    with tempfile.TemporaryDirectory() as scratch:
        out = scratch + '/out.o'
        for entry in sorted(units, key=lambda e: e['file']):
            files = re.findall(r'#include "([^"]+)"', pathlib.Path(entry['file']).read_text())
            if len(files) < 2 or options.only not in entry['file'] or time.monotonic() > end:
                continue
            one = compile_s(entry, entry['file'], out)
            each = sum(compile_s(entry, file, out) for file in files)
            together_s += one
            apart_s += each
            unit = re.sub(r'CMakeFiles/([^/]+)\.dir/Unity/', r'\1 ', str(pathlib.Path(entry['file']).relative_to(build)))
            print(f'{len(files):3d} files  {one:6.1f} s together  {each:6.1f} s apart  {each / one:5.2f}  {unit}', flush=True)
    if together_s > 0:
        print(f'all: {together_s:.0f} s together, {apart_s:.0f} s apart, {apart_s / together_s:.2f} times')

main()
