#!/usr/bin/env python3
"""Makes the scenes of this directory: python3 make_scenes.py [DIRECTORY]

A scene is a picture and a conf: white is air, black a fixed support, any other clear colour a mass.
Each function below paints one; the table at the end says how it moves and what msr is told."""
import sys
from math import atan2, hypot, pi
from os.path import dirname

AIR, SUPPORT = (255, 255, 255), (0, 0, 0)
RED, GREEN, BLUE = (220, 20, 30), (0, 150, 60), (30, 80, 210)
YELLOW, CYAN, VIOLET = (250, 190, 0), (0, 170, 200), (150, 40, 170)
RAINBOW = (RED, YELLOW, GREEN, CYAN, BLUE, VIOLET)


class Picture:
    def __init__(self, width, height):
        self.width, self.height = width, height
        self.rows = [[AIR] * width for _ in range(height)]

    def paint(self, colour, inside):
        """Colours the pixels for which inside(x, y); colour may be a function of x and y too."""
        for y, row in enumerate(self.rows):
            for x in range(self.width):
                if inside(x, y):
                    row[x] = colour(x, y) if callable(colour) else colour

    def write(self, path):
        with open(path, "wb") as file:
            file.write(b"P6\n%d %d\n255\n" % (self.width, self.height))
            file.write(bytes(channel for row in self.rows for pixel in row for channel in pixel))


# Shapes: functions of x and y.
def box(left, top, width, height):
    return lambda x, y: left <= x < left + width and top <= y < top + height


def disc(cx, cy, r):
    return lambda x, y: (x - cx) ** 2 + (y - cy) ** 2 <= r * r


def ring(cx, cy, inner, outer):
    return lambda x, y: inner * inner <= (x - cx) ** 2 + (y - cy) ** 2 <= outer * outer


def slot(left, right, cy, r):
    """A hole with round ends, whose centres are at left and right."""
    return lambda x, y: hypot(x - min(max(x, left), right), y - cy) <= r


# Colours: functions of x and y too.
def stripes(size, *colours):
    return lambda x, y: colours[x // size % len(colours)]


def bands(size, *colours):
    return lambda x, y: colours[y // size % len(colours)]


def sectors(cx, cy, *colours):
    share = 2 * pi / len(colours)
    return lambda x, y: colours[int((atan2(y - cy, x - cx) + pi) / share) % len(colours)]


def rings(cx, cy, size, *colours):
    return lambda x, y: colours[int(hypot(x - cx, y - cy) / size) % len(colours)]


def room(width, height, thick=4):
    """A picture with a floor and two walls."""
    p = Picture(width, height)
    p.paint(SUPPORT, lambda x, y: x < thick or x >= width - thick or y >= height - thick)
    return p


def assignment():
    p = room(220, 190)
    p.paint((255, 0, 0), box(14, 10, 192, 40))
    for peg, inwards in (36, -9), (184, 9):
        p.paint(AIR, slot(min(peg, peg + inwards), max(peg, peg + inwards), 20, 7))
        p.paint(SUPPORT, disc(peg, 20, 5))
    p.paint(SUPPORT, disc(110, 78, 14))
    p.paint((255, 0, 0), ring(50, 104, 17, 24))
    p.paint((255, 0, 0), ring(172, 100, 14, 20))
    p.paint(SUPPORT, disc(62, 100, 5))
    p.paint(SUPPORT, disc(166, 94, 5))
    p.paint((255, 0, 0), box(86, 100, 48, 20))
    p.paint(SUPPORT, lambda x, y: x < 76 and y >= 128 + min(x // 12 * 8, 30))
    p.paint(SUPPORT, lambda x, y: x >= 76 and y >= 128
            and ((x - 140) / 76) ** 2 + ((y - 128) / 56) ** 2 > 1)
    p.paint(SUPPORT, disc(104, 146, 6))
    return p


def bridge():
    p = Picture(320, 160)
    p.paint(SUPPORT, lambda x, y: (x < 40 or x >= 280) and y >= 30 or y >= 154)
    p.paint(stripes(8, RED, YELLOW), box(40, 40, 240, 5))
    for x, drop, colour in (98, 30, GREEN), (158, 44, BLUE), (218, 30, GREEN):
        p.paint(colour, box(x, 45, 4, drop))
        p.paint(colour, box(x - 7, 45 + drop, 18, 14))
    return p


def flag():
    p = Picture(220, 200)
    p.paint(SUPPORT, box(24, 45, 4, 155))
    p.paint(bands(20, BLUE, YELLOW, RED), box(28, 60, 120, 60))
    return p


def jelly():
    p = room(220, 150)
    p.paint(bands(6, RED, YELLOW), lambda x, y: 30 <= y < 66 and abs(x - 54) < 12 + (y - 30) / 2)
    p.paint(sectors(150, 48, *RAINBOW), disc(150, 48, 22))
    p.paint(SUPPORT, disc(132, 150, 16))
    return p


def letters():
    font = {"M": ("#...#", "##.##", "#####", "#.#.#", "#...#"),
            "S": ("#####", "#....", "#####", "....#", "#####"),
            "R": ("####.", "#..##", "####.", "#.##.", "#..##")}
    p = room(280, 260)
    for left, letter, colour in (34, "M", RED), (116, "S", GREEN), (198, "R", BLUE):
        p.paint(colour, lambda x, y: box(left, 10, 45, 45)(x, y)
                and font[letter][(y - 10) // 9][(x - left) // 9] == "#")
    for row in range(3):
        for x in range(36 + 36 * (row % 2), 270, 72):
            p.paint(SUPPORT, disc(x, 90 + 52 * row, 6))
    return p


def rope():
    p = Picture(320, 200)
    p.paint(SUPPORT, box(150, 30, 10, 10))
    p.paint(stripes(20, RED, BLUE), box(160, 33, 130, 3))
    p.paint(stripes(20, GREEN, YELLOW), box(60, 34, 90, 3))
    return p


def blocks():
    p = room(280, 180)
    for n, colour in enumerate((RED, GREEN, BLUE, YELLOW)):
        left = 4 + 68 * n
        p.paint(SUPPORT, lambda x, y: left <= x < left + 68 and y > 160 - (left + 68 - x) * n / 4)
        p.paint(colour, box(left + 8, 70, 30, 30))
    return p


def big():
    p = room(400, 400)
    p.paint(SUPPORT, disc(130, 410, 40))
    p.paint(rings(200, 180, 22.3, *RAINBOW), disc(200, 180, 178))
    return p


def stairs():
    p = Picture(320, 200)
    p.paint(SUPPORT, lambda x, y: y >= (46 + x / 2 if x < 60 else 76 + (x - 60) // 44 * 20))
    p.paint(SUPPORT, box(314, 0, 6, 200))
    p.paint(sectors(24, 34, RED, YELLOW, GREEN, BLUE), disc(24, 34, 16))
    return p


def laundry():
    p = Picture(300, 160)
    p.paint(SUPPORT, lambda x, y: (x < 6 or x >= 294) or 18 <= y < 21)
    for left, width, height, colours in ((30, 66, 70, (RED, YELLOW)), (128, 40, 90, (GREEN, CYAN)),
                                         (196, 72, 60, (BLUE, RED))):
        p.paint(colours[0], lambda x, y: 21 <= y < 24 and left <= x < left + width
                and (x - left) % ((width - 4) // 3) < 4)
        p.paint(bands(6, *colours), box(left, 24, width, height))
    return p


def trampoline():
    p = Picture(240, 180)
    p.paint(SUPPORT, lambda x, y: y >= 174 or (x < 20 or x >= 220) and y >= 90)
    p.paint(RED, box(20, 95, 200, 3))
    p.paint(sectors(120, 74, YELLOW, BLUE, YELLOW, BLUE), disc(120, 74, 20))
    return p


def pendulum():
    p = Picture(120, 70)
    p.paint(SUPPORT, box(60, 10, 1, 1))
    p.paint(stripes(8, RED, YELLOW), box(61, 10, 40, 4))
    return p


def heap():
    p = Picture(160, 140)
    p.paint(SUPPORT, lambda x, y: hypot(x - 80, y - 60) > 74 and y > 60 or x < 6 or x >= 154)
    p.paint(stripes(10, RED, YELLOW), box(40, 10, 100, 2))
    p.paint(sectors(62, 60, GREEN, CYAN, GREEN, CYAN), disc(62, 60, 13))
    p.paint(sectors(90, 92, BLUE, VIOLET, BLUE, VIOLET), disc(90, 92, 16))
    return p


def turn():
    p = Picture(60, 60)
    p.paint(bands(4, RED, YELLOW), box(20, 20, 20, 20))
    return p


# Name: what it shows; options of msr; GRAVITE, MASSE, TENSION_RESSORT, NB_ITERATIONS, NB_IMAGES, and
# DT if it isn't 0.005 s. All but the assignment's make 25 images per second.
SCENES = {
    assignment: ("the assignment's own parameters: a hammock, two loops and a block, undamped",
                 "", 9.8, 0.1, 1500, 20000, 800),
    big: ("about 10^5 masses: a ball of jelly lands on a bump",
          "--neighbours 8", 40, 0.1, 12000, 1200, 150),
    blocks: ("blocks come to rest on ever steeper ramps, by friction and damping",
             "--neighbours 8 --friction 0.8 --restitution 0.2 --damping 2",
             60, 0.1, 12000, 2400, 300),
    bridge: ("loads swing from a bridge that is tied to both banks",
             "--neighbours 8 --attach --drag 0.02", 80, 0.1, 40000, 2000, 250),
    flag: ("a flag, tied to its pole, in gusts of wind",
           "--attach --wind 200 --gust 80 --gust-time 0.7", 60, 0.1, 20000, 2400, 300),
    heap: ("two balls and a rope fall into a bowl, and on each other",
           "--neighbours 8 --collide --restitution 0.3 --damping 1", 60, 0.1, 12000, 1600, 200),
    jelly: ("bodies that keep their shape (8 neighbours) bounce, and lose some speed each time",
            "--neighbours 8 --restitution 0.9", 60, 0.1, 20000, 2400, 300),
    laundry: ("cloth (4 neighbours: it folds as it likes) hangs from a few threads in the wind",
              "--attach --wind 10 --gust 35 --gust-time 0.5", 60, 0.1, 12000, 2400, 300),
    letters: ("three letters tumble through pegs",
              "--neighbours 8 --restitution 0.6", 60, 0.1, 40000, 3000, 375),
    pendulum: ("a stiff rod swings from one pixel: slow motion, fast vibrations",
               "--neighbours 8 --attach", 60, 0.1, 1500000000, 50, 50, 0.04),
    rope: ("two ropes swing about one nail, undamped: chaos",
           "--attach", 200, 0.1, 30000, 2400, 300),
    stairs: ("a ball rolls down a ramp and stairs, by friction",
             "--neighbours 8 --friction 0.4 --restitution 0.6", 60, 0.1, 12000, 3200, 400),
    trampoline: ("a ball sewn to a trampoline bounces, undamped",
                 "--neighbours 8 --attach", 60, 0.1, 20000, 2400, 300),
    turn: ("a block that nothing holds or hits, turned by two forces, undamped",
           "--neighbours 8 --push 20,20,150,0 --push 39,39,-150,0", 0, 0.1, 1500, 400, 50),
}
NAMES = ("GRAVITE", "MASSE", "TENSION_RESSORT", "NB_ITERATIONS", "NB_IMAGES")


def main(directory):
    for picture, (shows, options, *values) in SCENES.items():
        name, dt = picture.__name__, values.pop() if len(values) > len(NAMES) else 0.005
        picture().write(f"{directory}/{name}.ppm")
        with open(f"{directory}/{name}.conf", "w") as conf:
            print(f"# {shows[0].upper()}{shows[1:]}.", file=conf)
            print(f"# msr {name}.ppm {name}.conf {options}".rstrip(), file=conf)
            for parameter, value in zip(("DT", *NAMES), (dt, *values)):
                print(parameter, value, sep="\n", file=conf)


main(sys.argv[1] if len(sys.argv) > 1 else dirname(__file__) or ".")
