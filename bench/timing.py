"""Renderers that take turns: medians of the seconds that each traces, without reading and writing."""
import json
import os
import re
import shutil
import statistics
import subprocess

WRT = os.path.abspath(os.environ.get("WRT", "build/wrt"))


def output_of(*command):
    run = subprocess.run(command, check=True, capture_output=True, text=True)
    return run.stdout + run.stderr


def wrt_stats(scene, *options):
    """What --stats says of rendering by one thread, unless the options say otherwise."""
    return json.loads(output_of(WRT, "render", "-q", "-t", "1", "--stats=json", scene,
                                "-o", "wrt.ppm", *options))


def wrt(scene, *options):
    return lambda: wrt_stats(scene, *options)["render_s"]


def tachyon(scene, width, height):
    def seconds():
        said = output_of("tachyon", scene, "-numthreads", "1", "-res", str(width), str(height),
                         "-format", "PPM", "-o", "tachyon.ppm")
        return float(re.search(r"Ray Tracing Time: *([0-9.]+)", said).group(1))
    return seconds


def povray(scene, width, height):
    def seconds():
        said = output_of("povray", f"+I{scene}", f"+W{width}", f"+H{height}", "+Opovray.png", "-A",
                         "-D", "+WT1")
        times = re.findall(r"Trace Time:.*?\(([0-9.]+) seconds\)", said)
        return float(times[-1])
    return seconds


def peers_of(scene, width, height):
    """The other renderers that are here, for our scene as their own writers' files say it."""
    peers, stem = {}, os.path.splitext(os.path.basename(scene))[0]
    for name, suffix, job in (("Tachyon", ".dat", tachyon), ("POV-Ray", ".pov", povray)):
        if shutil.which(job.__name__):
            output_of(WRT, "convert", "-q", scene, "-o", stem + suffix)
            peers[name] = job(stem + suffix, width, height)
    return peers


def in_turn(rounds, jobs):
    """{name: what its job returns, the median of the rounds}, after a round that does not count."""
    results = {name: [] for name in jobs}
    for i in range(rounds + 1):
        for name, job in jobs.items():
            result = job()
            if i > 0:
                results[name].append(result)
    return {name: statistics.median(of) for name, of in results.items()}
