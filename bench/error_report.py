"""The report of bench/error: pictures, plots, slopes and marks as one page of HTML."""
import array
import base64
import html
import math
import os
import platform
import shutil
import struct
import subprocess
import sys
import zlib

MEASURES = ["max", "rmse", "mae", "psnr", "p99.9", "above", "flip"]
MODES = {"grid": ("n × n grid", "#3b6fb6"), "jittered": ("n × n jittered", "#d9782d"),
         "adaptive": ("adaptive", "#2a8f5b")}
RAYS_MARK = 0.30      # of a grid's rays, for the same RMSE
ESTIMATE_MARK = 2     # estimated over actual error, either way
COST_MARKS = {"area_light_3": 2.5, "area_light_5": 4.0}
ORIGINAL_COSTS = {"area_light_3": 15, "area_light_5": 64}

# Of samples of a cube cut by planes, as computed before this was written.
EXPECTED_OF_PLANES = {("middles", 64): 1.4e-2, ("middles", 512): 3.8e-3,
                      ("jittered", 64): 2.0e-2, ("jittered", 512): 6.1e-3}

# ---- pictures -----------------------------------------------------------------------------------


def read_pfm(path):
    """(width, height, floats), rows from the bottom."""
    with open(path, "rb") as file:
        assert file.readline() == b"PF\n"
        width, height = map(int, file.readline().split())
        little = float(file.readline()) < 0
        floats = array.array("f", file.read())
    if little != (sys.byteorder == "little"):
        floats.byteswap()
    return width, height, floats


def png(width, height, rgb):
    """RGB bytes, rows from the top, as a PNG file."""
    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))
    lines = b"".join(b"\0" + rgb[y * 3 * width:(y + 1) * 3 * width] for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(lines, 9)) +
            chunk(b"IEND", b""))


def srgb_byte(light):
    light = min(max(light, 0), 1)
    v = light * 12.92 if light <= 0.0031308 else 1.055 * light ** (1 / 2.4) - 0.055
    return int(v * 255 + 0.5)


def png_of_pfm(path):
    width, height, floats = read_pfm(path)
    rows = [bytes(map(srgb_byte, floats[y * 3 * width:(y + 1) * 3 * width]))
            for y in reversed(range(height))]
    return png(width, height, b"".join(rows))


# ---- numbers ------------------------------------------------------------------------------------


def rows_of(scene, mode):
    return [row for row in scene["rows"] if row["mode"] == mode]


def slope(points):
    """Of log y over log x, by least squares; None where there is nothing to fit."""
    logs = [(math.log(x), math.log(y)) for x, y in points if x > 0 and y > 0]
    if len(logs) < 2:
        return None
    mx, my = (sum(p[i] for p in logs) / len(logs) for i in (0, 1))
    spread = sum((x - mx) ** 2 for x, _ in logs)
    return sum((x - mx) * (y - my) for x, y in logs) / spread if spread > 0 else None


def pixel_error(row):
    """Of the samples of the pixels alone, where a regular reference tells it apart from the steps of
    area lights."""
    return row["rmse"] if row["rmse_regular"] is None else row["rmse_regular"]


def slope_of(scene, mode):
    """From 4 samples on: fewer are far from any law."""
    return slope([(row["samples"], pixel_error(row)) for row in rows_of(scene, mode)
                  if row["samples"] >= 4])


def rays_for(scene, error, of):
    """The rays adaptive sampling needs for that error, on straight lines between what was
    measured; None when it did not get there."""
    points = sorted((of(row), row["rays"]) for row in rows_of(scene, "adaptive"))
    if not points or points[0][0] > error:
        return None
    if points[-1][0] <= error:
        return points[-1][1]
    for (e0, r0), (e1, r1) in zip(points, points[1:]):
        if e0 <= error <= e1:
            t = math.log(error / e0) / math.log(e1 / e0) if e1 > e0 else 0
            return math.exp(math.log(r0) + t * math.log(r1 / r0))
    return None


def rays_ratio(scene, n, of):
    """(ratio or None,) of adaptive to the n x n grid; None where either was not measured."""
    grid = [row for row in rows_of(scene, "grid") if row["setting"] == str(n)]
    if not grid or not rows_of(scene, "adaptive"):
        return None
    rays = rays_for(scene, of(grid[0]), of)
    return (rays / grid[0]["rays"] if rays else None,)


def whole_error(row):
    return row["rmse"]


def estimate_ratio(scene, default):
    """Estimated over actual error of the default adaptive picture."""
    for row in rows_of(scene, "adaptive"):
        if row["setting"] == default and row["estimate"] and pixel_error(row) > 0:
            return row["estimate"] / pixel_error(row)
    return None


def number(x, digits=3):
    if x is None:
        return "–"
    if x == 0:
        return "0"
    if x >= 1000:
        return f"{x:,.0f}".replace(",", "\u2009")
    text = f"{x:.{digits}g}"
    return text if "e" not in text else f"{x:.{digits - 1}e}".replace("e-0", "e-")


def verdict(value, right, text=None):
    """A table cell: the value, and whether it is on the right side of its mark."""
    if value is None:
        return '<td class="n miss">not reached</td>'
    shown = text or number(value)
    return f'<td class="n {"hit" if right else "miss"}">{shown} {"✓" if right else "✗"}</td>'


# ---- plots --------------------------------------------------------------------------------------


def plot(folder, name, title, x_label, y_label, series, guide=None):
    """Curves as (title, colour, points) on logarithmic axes, in NAME.svg; a guide is (slope, text)."""
    if not shutil.which("gnuplot"):
        return None
    target = os.path.join(folder, name + ".svg")
    blocks, curves = [], []
    seen = [(x, y) for _, _, points in series for x, y in points if x > 0 and y > 0]
    for i, (label, colour, points) in enumerate(series):
        rows = "\n".join(f"{x:.9g} {y:.9g}" for x, y in points if x > 0 and y > 0)
        if rows:
            blocks.append(f"$curve{i} << EOD\n{rows}\nEOD")
            curves.append(f"$curve{i} with linespoints lw 2 pt 7 ps 0.5 lc rgb '{colour}' "
                          f"title '{label}'")
    if guide and curves:
        x0, y0 = min((x, y) for x, y in series[0][2] if y > 0)
        curves.append(f"{1.6 * y0:.9g} * (x / {x0:.9g}) ** {guide[0]} with lines dt 2 lw 1.5 "
                      f"lc rgb '#999999' title '{guide[1]}'")
    ranges = [f"set {axis}range [{min(p[i] for p in seen) / 1.6:.9g}:{1.6 * max(p[i] for p in seen):.9g}]"
              for i, axis in enumerate("xy")]
    script = "\n".join(blocks + ranges + [
        "set terminal svg size 420,330 font 'Helvetica,13' background 'white'",
        f"set output '{target}'", "set logscale xy", "set format xy '10^{%T}'",
        "set grid lc rgb '#e4e4e4' lw 1", "set border 3 lc rgb '#777777'", "set tics nomirror",
        "set key bottom left Left reverse samplen 1.6 spacing 1.1 tc rgb '#333333'",
        f"set title '{title}' tc rgb '#333333'", f"set xlabel '{x_label}' tc rgb '#555555'",
        f"set ylabel '{y_label}' tc rgb '#555555'", "plot " + ", ".join(curves)])
    subprocess.run(["gnuplot"], input=script, text=True, check=True)
    with open(target, "rb") as file:
        return file.read()


def mode_series(scene, x, y):
    return [(MODES[mode][0], MODES[mode][1],
             sorted((row[x], row[y]) for row in rows_of(scene, mode)))
            for mode in MODES if rows_of(scene, mode)]


# ---- the page -----------------------------------------------------------------------------------

STYLE = """
:root { color-scheme: light; }
body { font: 16px/1.55 system-ui, "Segoe UI", Helvetica, Arial, sans-serif; color: #222;
  max-width: 1060px; margin: 2.5em auto 5em; padding: 0 1.2em; background: #fff; }
h1 { font-size: 2em; margin: 0; letter-spacing: -.01em; }
h2 { font-size: 1.35em; margin: 2.6em 0 .4em; padding-top: .7em; border-top: 1px solid #ddd; }
h3 { font-size: 1.05em; margin: 1.6em 0 .3em; }
p, ul { max-width: 46em; } .lead { color: #555; margin-top: .3em; }
table { border-collapse: collapse; margin: .8em 0; font-size: .9em; }
th, td { padding: .22em .75em; text-align: left; border-bottom: 1px solid #eee; white-space: nowrap; }
th { font-weight: 600; color: #555; border-bottom: 1px solid #bbb; vertical-align: bottom; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; }
tr.first td { border-top: 1px solid #bbb; }
.hit { color: #1c7a45; } .miss { color: #b3261e; }
.row { display: flex; flex-wrap: wrap; gap: 14px; margin: .9em 0; align-items: flex-start; }
figure { margin: 0; } figcaption { font-size: .82em; color: #666; margin-top: .15em; }
figure.picture img { display: block; width: 192px; image-rendering: auto; border-radius: 3px; }
figure.plot img { display: block; width: 338px; }
code { font: .92em ui-monospace, Menlo, Consolas, monospace; background: #f5f5f5;
  padding: 0 .25em; border-radius: 3px; }
details summary { cursor: pointer; color: #3b6fb6; font-size: .92em; }
small, .note { color: #666; font-size: .87em; }
nav a { margin-right: 1em; color: #3b6fb6; text-decoration: none; font-size: .92em; }
"""


def image(data, kind):
    return f"data:image/{kind};base64,{base64.b64encode(data).decode('ascii')}"


def figures(kind, items):
    """(caption, bytes, image type) side by side; what is None is left out."""
    shown = [f'<figure class="{kind}"><img src="{image(data, type_)}" alt="{html.escape(caption)}">'
             f"<figcaption>{html.escape(caption) if kind == 'picture' else ''}</figcaption></figure>"
             for caption, data, type_ in items if data]
    return "".join(shown)


def side_by_side(*parts):
    return f'<div class="row">{"".join(parts)}</div>'


def table(heads, rows):
    """Heads as text, numbers' with a leading >; rows of ready cells."""
    cells = "".join(f'<th class="n">{h[1:]}</th>' if h[0] == ">" else f"<th>{h}</th>" for h in heads)
    return f"<table><thead><tr>{cells}</tr></thead><tbody>{''.join(rows)}</tbody></table>"


def cell(text):
    return f"<td>{text}</td>"


def cells(*values):
    return "".join(f'<td class="n">{number(v) if not isinstance(v, str) else v}</td>' for v in values)


def ratio_cell(ratio):
    if ratio is None:
        return cells("–")
    return verdict(ratio[0], ratio[0] is not None and ratio[0] <= RAYS_MARK)


def adaptive_section(results):
    if not any(rows_of(scene, "adaptive") for scene in results["scenes"]):
        return "<p>This wrt has no <code>--adaptive</code>.</p>"
    rows = []
    for scene in results["scenes"]:
        estimate = estimate_ratio(scene, results["default_error"])
        right = estimate is not None and 1 / ESTIMATE_MARK <= estimate <= ESTIMATE_MARK
        alone = [ratio_cell(rays_ratio(scene, n, pixel_error)) if scene["steps"] else cells("")
                 for n in (4, 8)]
        rows.append(f"<tr>{cell(scene['title'])}{ratio_cell(rays_ratio(scene, 4, whole_error))}"
                    f"{ratio_cell(rays_ratio(scene, 8, whole_error))}{''.join(alone)}"
                    f"{verdict(estimate, right)}{cells(scene['steps'] or '')}</tr>")
    n = results["reference"]
    return (f"<p>Rays that <code>--adaptive</code> needs for the RMSE of a grid, as a share of that grid’s "
            f"rays (mark: at most {RAYS_MARK:.2f}), and its own estimate of the error over the actual one "
            f"at {results['default_error']} (mark: within a factor of {ESTIMATE_MARK}).</p>"
            f"<p>The grid of an area light’s samples is part of a scene: its steps stay however finely a "
            f"pixel is sampled; only jittering takes them away.  Where there are such lights, a second "
            f"reference of {n} × {n} regular samples has the same steps.  Against it the error is that of "
            "the pixels’ samples alone, which is what the estimate speaks of; the last column tells how "
            "far the two references are apart, below which no regular or adaptive picture gets.</p>" +
            table(["scene", ">of 4 × 4", ">of 8 × 8", ">of 4 × 4,<br>pixels alone",
                   ">of 8 × 8,<br>pixels alone", ">estimate /<br>actual", ">steps of<br>lights (RMSE)"],
                  rows))


def minus(x):
    return "–" if x is None else f"{x:.2f}".replace("-", "−")


def slopes_section(results):
    rows = []
    for scene in results["scenes"]:
        found = [minus(slope_of(scene, mode)) for mode in MODES]
        expected = "−0.75" if scene["name"] == "edges" else "−0.75 to −1"
        rows.append(f"<tr>{cell(scene['title'])}{cells(expected, *found)}</tr>")
    lights = minus(slope([(row["samples"], row["rmse"]) for row in results["lights"]]))
    rows.append(f"<tr>{cell('Samples of area lights')}{cells('−0.75', lights, '–', '–')}</tr>")
    return ("<p>The error of N samples falls as a power of N.  Independent random samples give "
            "N<sup>−1/2</sup>.  One sample in each of N cells does better: only cells that an edge "
            "crosses are uncertain, and of these there are about N<sup>1/2</sup>, which makes "
            "N<sup>−3/4</sup>; where the picture is smooth it is N<sup>−1</sup> (Mitchell, "
            "<i>Consequences of Stratified Sampling in Graphics</i>, SIGGRAPH 1996: variances of "
            "N<sup>−3/2</sup> and N<sup>−2</sup>).  Regular grids behave alike on edges at odd angles, "
            "worse on those along their rows, better where all is smooth.  Detail finer than the cells, "
            "and the samples of area lights, which jittering moves independently of each other, fall with "
            "N<sup>−1/2</sup> only.  Adaptive sampling, which takes its samples where the edges are, may "
            "be beyond all that.  Fitted from 4 samples on, to the error of the pixels’ samples alone."
            "</p>" +
            table(["scene", ">expected of grids<br>and jittered"] +
                  [">" + MODES[mode][0] for mode in MODES], rows))


def planes_table(planes):
    rows = [f"<tr>{cell(f'{rule}, {samples} samples')}{cells(planes[rule, samples], expected)}</tr>"
            for (rule, samples), expected in EXPECTED_OF_PLANES.items()]
    return ("<p>The rules on planes of any direction at any distance that meets the cube:</p>" +
            table(["rule", ">RMSE", ">expected"], rows))


def cube_section(results):
    cube = results["cube"]
    rows = ["<tr>" + cells(str(row["n"]), *(row[rule] for rule in (
        "samples", "wrt", "faces", "middles", "jittered")), f"{100 * row['agree']:.0f} %") + "</tr>"
            for row in cube["rows"]]
    found = {rule: slope([(row["samples"], row[rule]) for row in cube["rows"]])
             for rule in ("wrt", "middles", "jittered")}
    text = ", ".join(f"{name} {minus(found[rule])}" for rule, name in
                     (("wrt", "wrt"), ("middles", "middles of cells"), ("jittered", "jittered")))
    plotted = plot(results["folder"], "cube", "visibility of a cube", "samples", "RMSE", [
        ("wrt, from face to face", "#3b6fb6", [(r["samples"], r["wrt"]) for r in cube["rows"]]),
        ("middles of cells", "#8a5fb0", [(r["samples"], r["middles"]) for r in cube["rows"]]),
        ("jittered in cells", "#d9782d", [(r["samples"], r["jittered"]) for r in cube["rows"]]),
    ], (-2 / 3, "N^{-2/3}"))
    return ("<p>An area light of <code>model classic</code> is a cube of n × n × n points.  Over its floor "
            "stands one straight edge; what each point of the floor sees of the cube is cut off by the plane "
            "through that point and the edge, and has a closed form by inclusion and exclusion of the "
            f"cube’s eight corners.  RMSE over the {cube['pixels']} pixels of the penumbra, in parts "
            "of the light; the other columns are the same planes (a random part of them) with other "
            "rules, computed apart from wrt.  <i>Agree</i>: pixels whose share is that of the rule "
            "exactly.</p>" +
            side_by_side(figures("plot", [("visibility", plotted, "svg+xml")]),
                         table([">n", ">samples", ">wrt", ">same rule", ">middles", ">jittered",
                                ">agree"], rows)) +
            planes_table(cube["planes"]) +
            f'<p class="note">Slopes: {text}; expected −1/3 for points that reach to the faces (half a '
            "cell too far, all the way round), and −2/3 for the others: a plane cuts N<sup>2/3</sup> of "
            "the cells.</p>")


def costs_section(results):
    costs, rows = results["costs"], []
    base = costs["area_light_1"]
    rows.append(f"<tr>{cell('point light')}{cells(base, '1', '1')}<td></td></tr>")
    for name, mark in COST_MARKS.items():
        n = name[-1]
        ratio = costs[name] / base
        rows.append(f"<tr>{cell(f'area light, {n} × {n} × {n}')}{cells(costs[name])}"
                    f"{verdict(ratio, ratio <= mark, f'{ratio:.2f}')}"
                    f"{cells(str(ORIGINAL_COSTS[name]))}{cell(f'at most {mark}')}</tr>")
    return ("<p>The scene of <code>scenes/area_light_5.xml</code> with an area light and with a point light "
            "in its place; the fastest of several runs in turns.  The original program paid so many times "
            "its unshadowed picture.</p>" +
            table(["light", ">seconds", ">times", ">original", "mark"], rows))


def result_rows(scene):
    out, last = [], None
    for row in scene["rows"]:
        first = ' class="first"' if row["mode"] != last else ""
        last = row["mode"]
        out.append(f"<tr{first}>{cell(MODES[row['mode']][0])}{cells(row['setting'])}" + cells(
            row["samples"], row["rays"], row["seconds"], row["rmse"], row["p99.9"], row["max"],
            row["above"], row["flip"], row["estimate"]) + "</tr>")
    return out


def scene_section(results, scene):
    folder, name = results["folder"], scene["name"]
    plots = [
        ("rays", plot(folder, name + "-rays", "error over rays", "rays", "RMSE",
                      mode_series(scene, "rays", "rmse"), (-0.75, "N^{-3/4}")), "svg+xml"),
        ("seconds", plot(folder, name + "-seconds", "error over time", "seconds", "RMSE",
                         mode_series(scene, "seconds", "rmse")), "svg+xml"),
        ("FLIP", plot(folder, name + "-flip", "what is seen, over rays", "rays", "FLIP",
                      mode_series(scene, "rays", "flip")), "svg+xml")]
    source = f" <small><code>{scene['source']}</code></small>" if scene["source"] else ""
    return (f'<h2 id="{name}">{html.escape(scene["title"])}{source}</h2>' +
            side_by_side(figures("picture", [(caption, data, "png")
                                             for caption, data in scene["pictures"]])) +
            side_by_side(figures("plot", plots)) + "<details><summary>all numbers</summary>" +
            table(["sampling", ">setting", ">samples", ">rays", ">seconds", ">RMSE", ">P99.9", ">max",
                   ">% above 1/255", ">FLIP", ">estimate"], result_rows(scene)) + "</details>")


def lights_section(results):
    rows = ["<tr>" + cells(f"{row['setting']} × {row['setting']}", *(row[key] for key in (
        "rays", "seconds", "rmse", "p99.9", "flip"))) + "</tr>" for row in results["lights"]]
    plotted = plot(results["folder"], "lights", "samples of area lights", "samples of each light",
                   "RMSE", [("n × n grid of a light", "#3b6fb6",
                             [(row["samples"], row["rmse"]) for row in results["lights"]])],
                   (-0.75, "N^{-3/4}"))
    return ("<p><code>examples/soft_shadows.wrt</code>, one sample a pixel, against 48 × 48 samples of each "
            "light: what the number of a light’s samples does alone.</p>" +
            side_by_side(figures("plot", [("lights", plotted, "svg+xml")]),
                         table([">samples", ">rays", ">seconds", ">RMSE", ">P99.9", ">FLIP"], rows)))


def method_section(results):
    n = results["reference"]
    sizes = ", ".join("{} {} × {}".format(scene["title"], *scene["size"]) for scene in results["scenes"])
    cpu = platform.processor() or platform.machine()
    if os.path.exists("/proc/cpuinfo"):
        with open("/proc/cpuinfo", encoding="utf-8") as info:
            cpu = next((line.split(":")[1].strip() for line in info if "model name" in line), cpu)
    return (f"<p>Pictures (pixels: {sizes}) are written as floats and compared by "
            f"<code>wrt diff</code> with {n} × {n} = {n * n} jittered samples of another seed, at least 16 "
            "times as many as any picture compared but the finest adaptive ones take.  Seconds are those of "
            f"rendering alone, the fastest of three runs where they are short, on {os.cpu_count()} "
            "threads.  Rays are all rays: from the eye, reflected, refracted, towards lights.  The error of "
            "a pixel is of light, not of bytes; FLIP (Andersson et al. 2020) is its mean over the "
            "picture; its maps go from black, where nothing is seen, by purple and orange to pale yellow "
            f"for 1.</p><p class='note'>{html.escape(results['version'])}, {html.escape(cpu)}; "
            f"measured in {results['took']:.0f} s.</p>")


def page(results):
    quick = ("<p class='note'>Made with <code>--quick</code>: small pictures and few settings, so the "
             "numbers are rough.</p>" if results["quick"] else "")
    links = "".join(f'<a href="#{id_}">{title}</a>' for id_, title in
                    [("marks", "Adaptive"), ("slopes", "Slopes")] +
                    [(s["name"], s["title"]) for s in results["scenes"]] +
                    [("lights", "Light samples"), ("cube", "Closed form"), ("costs", "Cost of area lights"),
                     ("method", "Method")])
    parts = [f"<h1>Time against error</h1><p class='lead'>How far rendered pictures are from right, "
             f"and what it takes to come nearer.</p>{quick}<nav>{links}</nav>",
             '<h2 id="marks">Adaptive sampling against grids</h2>', adaptive_section(results),
             '<h2 id="slopes">How fast the error falls</h2>', slopes_section(results)]
    parts += [scene_section(results, scene) for scene in results["scenes"]]
    parts += ['<h2 id="lights">Samples of area lights</h2>', lights_section(results),
              '<h2 id="cube">A shadow with a closed form</h2>', cube_section(results),
              '<h2 id="costs">What soft shadows cost</h2>', costs_section(results),
              '<h2 id="method">How it was measured</h2>', method_section(results)]
    return ("<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>"
            "<meta name='viewport' content='width=device-width, initial-scale=1'>"
            f"<title>wrt: time against error</title><style>{STYLE}</style></head>"
            f"<body>{''.join(parts)}</body></html>\n")


# ---- the terminal -------------------------------------------------------------------------------


def summary(results):
    """The marks as text."""
    lines = ["rays of adaptive for the error of a grid; estimated over actual error; slopes",
             f"{'scene':14}" + "".join(f"{head:>12}" for head in (
                 "of 4x4", "of 8x8", "4x4 pixels", "8x8 pixels", "estimate", *MODES))]
    for scene in results["scenes"]:
        ratios = [rays_ratio(scene, n, of) for of in (whole_error, pixel_error) for n in (4, 8)]
        shown = ["-" if r is None else "not reached" if r[0] is None else f"{r[0]:.2f}" for r in ratios]
        estimate = estimate_ratio(scene, results["default_error"])
        slopes = [slope_of(scene, mode) for mode in MODES]
        shown += ["-" if x is None else f"{x:.2f}" for x in [estimate] + slopes]
        lines.append(f"{scene['name']:14}" + "".join(f"{x:>12}" for x in shown))
    base = results["costs"]["area_light_1"]
    for name, mark in COST_MARKS.items():
        lines.append(f"{name}: {results['costs'][name] / base:.2f} times a point light (mark {mark})")
    for row in results["cube"]["rows"]:
        if row["n"] in (4, 8):
            lines.append(f"cube of {row['samples']}: wrt {row['wrt']:.4f}, middles {row['middles']:.4f}, "
                         f"jittered {row['jittered']:.4f}")
    return "\n".join(lines)


def write(folder, results):
    """index.html and the plots in the folder; returns the marks as text."""
    results["folder"] = folder
    if not shutil.which("gnuplot"):
        print("bench/error: gnuplot is not installed, so there are no plots", file=sys.stderr)
    with open(os.path.join(folder, "index.html"), "w", encoding="utf-8") as out:
        out.write(page(results))
    return summary(results)
