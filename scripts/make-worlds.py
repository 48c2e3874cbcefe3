#!/usr/bin/env python3
"""Writes the worlds that come in families, and those whose ground is computed, into share/worlds/.

    scripts/make-worlds.py [FOLDER]

The files are committed: this is run when a family changes, never by the build. The same script gives the same files.
flat.sdf and boxes.sdf are written by hand.
"""
import math
import pathlib
import struct
import sys
import zlib

OBSTACLE_M = 1.0  # x where every obstacle begins; robots start at the origin, facing it


def number(value):
    text = f"{value:.9f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def numbers(*values):
    return " ".join(number(v) for v in values)


def collision(name, geometry, pose=None):
    at = f"<pose>{numbers(*pose)}</pose>" if pose else ""
    return f'<collision name="{name}">{at}<geometry>{geometry}</geometry></collision>'


def box(*size):
    return f"<box><size>{numbers(*size)}</size></box>"


def model(name, collisions, pose=None):
    at = f"      <pose>{numbers(*pose)}</pose>\n" if pose else ""
    lines = "".join(f"        {c}\n" for c in collisions)
    return (f'    <model name="{name}">\n      <static>true</static>\n{at}'
            f'      <link name="link">\n{lines}      </link>\n    </model>\n')


def ground(z=0.0):
    return model("ground", [collision("collision", "<plane><normal>0 0 1</normal></plane>")], (0, 0, z, 0, 0, 0))


def fixed_box(name, low, high):
    """The box between two corners."""
    size = [h - l for l, h in zip(low, high)]
    middle = [(l + h) / 2 for l, h in zip(low, high)]
    return model(name, [collision("collision", box(*size))], (*middle, 0, 0, 0))


def world(name, words, models):
    starts = "".join(f'    <frame name="start_{i:02}"><pose>{-i} 0 0 0 0 0</pose></frame>\n' for i in range(4))
    return (f'<?xml version="1.0"?>\n<!-- {words} -->\n<sdf version="1.9">\n  <world name="{name}">\n'
            f"    <gravity>0 0 -9.80665</gravity>\n{starts}{''.join(models)}  </world>\n</sdf>\n")


def step(height_mm):
    name = f"step-{height_mm}"
    return name, world(
        name, f"A step of {height_mm} mm: a platform 3 m deep and 2 m wide, its face at x = 1 m. Start at the origin.",
        [ground(), fixed_box("platform", (OBSTACLE_M, -1, 0), (OBSTACLE_M + 3, 1, height_mm / 1000))])


def trench(width_mm):
    name = f"trench-{width_mm}"
    far = OBSTACLE_M + width_mm / 1000
    return name, world(
        name, f"A trench {width_mm} mm wide and 1 m deep from x = 1 m on, between platforms 4 m wide with their tops at z = 0.",
        [ground(-1), fixed_box("near", (OBSTACLE_M - 6, -2, -1), (OBSTACLE_M, 2, 0)),
         fixed_box("far", (far, -2, -1), (far + 5, 2, 0))])


def stairs():
    steps, rise, run, landing = 12, 0.075, 0.175, 2.0
    boxes = []
    for i in range(steps):
        x = OBSTACLE_M + i * run
        end = x + (run if i + 1 < steps else landing)
        top = (i + 1) * rise
        boxes.append(collision(f"step_{i + 1:02}", box(end - x, 2, top), ((x + end) / 2, 0, top / 2, 0, 0, 0)))
    return "stairs", world("stairs", "12 steps of 75 mm rise and 175 mm run from x = 1 m on, 2 m wide, then a landing of 2 m.",
                           [ground(), model("stairs", boxes)])


def ramp(degrees):
    """A turned box whose upper face begins at the ground at x = 1 m and ends at the plateau's edge, 0.5 m up."""
    slope, height, thickness = math.radians(degrees), 0.5, 0.2
    length = height / math.sin(slope)
    end_x = OBSTACLE_M + height / math.tan(slope)
    middle = (OBSTACLE_M + length / 2 * math.cos(slope) + thickness / 2 * math.sin(slope),
              length / 2 * math.sin(slope) - thickness / 2 * math.cos(slope))
    name = f"ramp-{degrees}"
    return name, world(
        name, f"A ramp of {degrees} degrees from x = 1 m on, 2 m wide and 0.5 m high, then a plateau of 3 m.",
        [ground(),
         model("ramp", [collision("collision", box(length, 2, thickness))], (middle[0], 0, middle[1], 0, -slope, 0)),
         fixed_box("plateau", (end_x, -1, 0), (end_x + 3, 1, height))])


def mixed(*values):
    """A number from 0 to 1 that looks random and never changes: integer mixing (xor, shift, multiply)."""
    h = 2166136261
    for v in values:
        h = ((h ^ (v & 0xFFFF)) * 16777619) & 0xFFFFFFFF
        h ^= h >> 15
        h = (h * 2246822519) & 0xFFFFFFFF
        h ^= h >> 13
    return h / 0xFFFFFFFF


def step_field():
    """Three pallets of 12 x 12 posts, as the random step fields of the NIST and RoboCup test arenas: posts of 100 mm by
    100 mm in multiples of 50 mm; a flat, a hill across the way and a diagonal pallet, each with one level more or less
    at random. Neighbouring posts of one height in a row become one box."""
    posts, width = 12, 0.1

    def level(pallet, i, j):
        from_middle = abs(j - 5.5) if pallet == 1 else abs(i - j) / 2
        base = 1 if pallet == 0 else max(0, 3 - int(from_middle / 1.5))
        return min(4, max(1, base + int(3 * mixed(pallet, i, j)) - (pallet != 0)))

    boxes = []
    for pallet in range(3):
        for i in range(posts):  # rows along y
            j = 0
            while j < posts:
                end = j + 1
                while end < posts and level(pallet, j, i) == level(pallet, end, i):
                    end += 1
                height = 0.05 * level(pallet, j, i)
                x = OBSTACLE_M + pallet * posts * width
                boxes.append(collision(f"p{pallet}_{i}_{j}", box((end - j) * width, width, height),
                                       (x + (j + end) / 2 * width, (i + 0.5 - posts / 2) * width, height / 2, 0, 0, 0)))
                j = end
    return "step-field", world(
        "step-field", "Three pallets of 1.2 m x 1.2 m in a row from x = 1 m on: posts of 100 mm x 100 mm, 50 to 200 mm high.",
        [ground(), model("pallets", boxes)])


def tilted_box():
    """The box_obstacle of gz-sim's tracked vehicle test: 0.5 x 0.85 x 0.15 m, its middle 28 mm up, falling away forward
    by 1.7821 rad - 90 degrees."""
    length, thickness, z, tilt = 0.5, 0.15, 0.028, 1.7821 - math.pi / 2
    edge_x = -length / 2 * math.cos(tilt) + thickness / 2 * math.sin(tilt)
    return "tilted-box", world(
        "tilted-box", "A box whose upper edge, at x = 1 m, is 0.154 m up and which falls away behind it by 12 degrees.",
        [ground(), model("box", [collision("collision", box(length, 0.85, thickness))],
                         (OBSTACLE_M - edge_x, 0, z, 0, tilt, 0))])


def half_cylinder():
    radius = 0.15
    return "half-cylinder", world(
        "half-cylinder", "A cylinder of 150 mm radius that lies across the way, half in the ground, from x = 1 m on, 2 m wide.",
        [ground(), model("cylinder", [collision(
            "collision", f"<cylinder><radius>{radius}</radius><length>2</length></cylinder>")],
            (OBSTACLE_M + radius, 0, 0, math.pi / 2, 0, 0))])


HILLS_M, HILLS_PIXELS = 8.0, 129


def hills():
    picture = '<heightmap><uri>hills.png</uri><size>8 8 0.2</size><pos>0 0 0</pos></heightmap>'
    return "hills", world(
        "hills", "Smooth hills of up to 0.2 m on 8 m x 8 m from x = 1 m on, a height map of 129 x 129 pixels; level around it.",
        [ground(), model("hills", [collision("collision", picture)], (OBSTACLE_M + HILLS_M / 2, 0, 0, 0, 0, 0))])


def hills_png():
    """Four waves of 1.6 to 4 m; falling to 0 over the outer 1 m, so that the map joins the level ground."""
    def height(x, y):
        waves = [(1.0, 4.0, 0.3, 0.0), (0.7, 2.7, 1.4, 1.0), (0.5, 2.1, 2.3, 2.0), (0.3, 1.6, 0.9, 3.0)]
        wave = sum(a * math.cos(2 * math.pi / l * (x * math.cos(d) + y * math.sin(d)) + p) for a, l, d, p in waves)
        rim = [min(1.0, (HILLS_M / 2 - abs(c)) / 1.0) for c in (x, y)]
        return (0.5 + wave / 5.0) * math.prod(0.5 - 0.5 * math.cos(math.pi * r) for r in rim)

    n = HILLS_PIXELS
    at = [(i / (n - 1) - 0.5) * HILLS_M for i in range(n)]
    heights = [[height(at[c], -at[r]) for c in range(n)] for r in range(n)]
    top = max(map(max, heights))
    rows = b"".join(b"\x00" + b"".join(struct.pack(">H", round(65535 * h / top)) for h in row) for row in heights)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", n, n, 16, 0, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def rubble():
    return "rubble-mesh", world(
        "rubble-mesh", "Rough ground of up to 0.15 m on 4 m x 3 m from x = 1 m on, a closed mesh of triangles.",
        [ground(), model("rubble", [collision("collision", "<mesh><uri>rubble.obj</uri></mesh>")],
                         (OBSTACLE_M, 0, 0, 0, 0, 0))])


def rubble_obj():
    """Corners 125 mm apart, at random heights of up to 0.15 m; the rim at the ground; a bottom 0.1 m below it. Each
    corner stands for a stone of its own: neighbours share nothing but the triangles between them."""
    cell, columns, rows, depth, highest = 0.125, 33, 25, 0.1, 0.15

    def height(i, j):
        rim = i in (0, columns - 1) or j in (0, rows - 1)
        return 0.0 if rim else highest * mixed(i, j, 7) ** 2

    lines = ["# Written by scripts/make-worlds.py", "o rubble"]
    for j in range(rows):
        for i in range(columns):
            lines.append(f"v {numbers(i * cell, (j - (rows - 1) / 2) * cell)} {height(i, j):.4f}")
    for j in range(rows - 1):
        for i in range(columns - 1):
            a, b, c, d = (v + 1 for v in (j * columns + i, j * columns + i + 1, (j + 1) * columns + i + 1, (j + 1) * columns + i))
            lines += [f"f {a} {b} {c}", f"f {a} {c} {d}"]
    # the rim, counter-clockwise as seen from above, and its copy below
    rim = ([(i, 0) for i in range(columns - 1)] + [(columns - 1, j) for j in range(rows - 1)] +
           [(i, rows - 1) for i in range(columns - 1, 0, -1)] + [(0, j) for j in range(rows - 1, 0, -1)])
    first = columns * rows + 1
    for i, j in rim:
        lines.append(f"v {numbers(i * cell, (j - (rows - 1) / 2) * cell, -depth)}")
    lines.append(f"v {numbers((columns - 1) / 2 * cell, 0, -depth)}")
    middle = first + len(rim)
    for k, (i, j) in enumerate(rim):
        following = (k + 1) % len(rim)
        top, next_top = j * columns + i + 1, rim[following][1] * columns + rim[following][0] + 1
        bottom, next_bottom = first + k, first + following
        lines += [f"f {bottom} {next_bottom} {next_top}", f"f {bottom} {next_top} {top}",
                  f"f {middle} {next_bottom} {bottom}"]
    return "\n".join(lines) + "\n"


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent / "share/worlds"
    worlds = [step(mm) for mm in range(50, 351, 50)] + [trench(mm) for mm in range(100, 401, 50)]
    worlds += [ramp(degrees) for degrees in (10, 20, 30)]
    worlds += [stairs(), step_field(), tilted_box(), half_cylinder(), hills(), rubble()]
    for name, text in worlds:
        (folder / f"{name}.sdf").write_text(text, encoding="ascii")
    (folder / "hills.png").write_bytes(hills_png())
    (folder / "rubble.obj").write_text(rubble_obj(), encoding="ascii")


if __name__ == "__main__":
    main()
