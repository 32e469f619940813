#!/usr/bin/env python3
"""Make the meshes and the texture that only the examples use.

    python3 examples/make_assets.py [FOLDER]

Writes into examples/assets/ (or FOLDER).  Tools and conventions are those of
scenes/make_assets.py: standard library only, the same bytes in every run.
"""

import math
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "scenes"))
sys.dont_write_bytecode = True

import make_assets as tools

# Turned profiles: radius and height, from the axis below to the axis above.
STEM = [(0, 0), (0.34, 0), (0.36, 0.012), (0.37, 0.04), (0.365, 0.08), (0.335, 0.12), (0.30, 0.14),
        (0.298, 0.155), (0.31, 0.175), (0.308, 0.20), (0.285, 0.23), (0.235, 0.275), (0.19, 0.34),
        (0.158, 0.44), (0.138, 0.56), (0.128, 0.68), (0.13, 0.78), (0.148, 0.845), (0.20, 0.872),
        (0.228, 0.89), (0.235, 0.91), (0.225, 0.93), (0.195, 0.945), (0.15, 0.955), (0, 0.96)]
CROWN = [(0, 0), (0.125, 0), (0.13, 0.015), (0.135, 0.08), (0.15, 0.16), (0.185, 0.26),
         (0.225, 0.33), (0.225, 0.345), (0.205, 0.35), (0.17, 0.30), (0.09, 0.27), (0, 0.26)]


def make_chessmen():
    tools.revolve(STEM, 36).save_ply("stem", "a turned stem, 0.96 high")
    tools.revolve(CROWN, 36).save_ply("crown", "a crown without its points")


def make_wood():
    """Grain along v that repeats: rings of a trunk cut lengthwise."""
    size = 256
    wander = tools.cloud_grid(size, size, 4, 1, 3, 7)
    fibre = tools.noise_grid(size, size, 128, 4, 8)
    image = []
    for j in range(size):
        row = []
        for i in range(size):
            ring = 0.5 + 0.5 * math.sin(2 * math.pi * (5 * i / size + 3.2 * wander[j][i]))
            row.append(0.15 + 0.55 * ring ** 2 + 0.3 * fibre[j][i])
        image.append(row)
    tools.save_shades("wood.png", image, (70, 36, 18), (150, 88, 46), 24)


def main():
    tools.OUT = sys.argv[1] if len(sys.argv) > 1 else os.path.join(HERE, "assets")
    os.makedirs(tools.OUT, exist_ok=True)
    make_chessmen()
    make_wood()


if __name__ == "__main__":
    main()
