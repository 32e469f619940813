"""check.py PICTURE.ppm X Y < JSON: the colours told add up, and are the picture's."""
import json
import sys


def close(a, b):
    return all(abs(x - y) <= 1e-10 * (1 + abs(y)) for x, y in zip(a, b))


def check(ray):
    if not ray["hit"]:
        return
    total = list(ray["ambient"])
    for light in ray["lights"]:
        assert light["lit"] + sum(b["rays"] for b in light["blockers"]) == light["rays"]
        for k in range(3):
            total[k] += light["diffuse"][k] + light["highlight"][k]
    for way in "reflected", "refracted":
        if way in ray:
            check(ray[way])
            for k in range(3):
                total[k] += ray[way]["weight"][k] * ray[way]["colour"][k]
    assert close(total, ray["colour"]), (total, ray["colour"])


with open(sys.argv[1], "rb") as f:
    assert f.readline() == b"P6\n"
    width, height = map(int, f.readline().split())
    f.readline()
    pixels = f.read()
pixel = json.load(sys.stdin)
check(pixel)
at = 3 * (int(sys.argv[3]) * width + int(sys.argv[2]))
assert pixel["bytes"] == list(pixels[at : at + 3]), (pixel["bytes"], list(pixels[at : at + 3]))
