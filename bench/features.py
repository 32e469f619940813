"""Scenes that differ in one feature, in the original program's format."""
import math

import displaced
from error_report import png

# {scene: (the scene without, in words, what the original's manual says it cost there)}
FEATURES = {
    "texture": ("plain", "texture", "+25 %"),
    "filter": ("texture", "bilinear filter", "+4 %"),
    "normal_map": ("plain", "normal map", "+6 %"),
    "textured": ("plain", "texture, filter and normal map", "-"),
    "smooth": ("mesh", "interpolated normals", "0 %"),
    "reflection": ("plain", "reflection", "+7 %"),
    "refraction": ("plain", "refraction", "+50 %"),
    "area_3": ("plain", "area light, 3 x 3 x 3 samples", "15 x"),
    "area_5": ("plain", "area light, 5 x 5 x 5 samples", "64 x"),
}

POINT = '<light class="PointLight"><intensity>1 1 1</intensity><position>4 8 6</position></light>'
AREA = ('<light class="AreaLight"><intensity>1 1 1</intensity><position>4 8 6</position>'
        "<nsamples>{}</nsamples><shape>Sphere</shape><size>2</size></light>")
GREY = ("<diffuse>0.7 0.7 0.6</diffuse><specular>0.3 0.3 0.3</specular><exponent>30</exponent>")
CORNERS = [(-9, -9), (-9, 9), (9, 9), (9, -9)]


def material(kind, more=""):
    return f'<material class="{kind}">{GREY}{more}</material>'


def surfaces(of, mapped):
    """Nine spheres over a floor."""
    bumps = "<bTexture>1</bTexture><tscale>3 3 0</tscale>" if mapped else ""
    for i in range(9):
        yield (f'<surface class="Sphere">{of}{bumps}<position>{2.2 * (i % 3 - 1)} 0 '
               f"{2.2 * (i // 3 - 1)}</position><radius>1</radius></surface>")
    floor = "".join(f"<v{i}>{x} -1 {z}</v{i}><v{i}t>{x / 4} {z / 4} 0</v{i}t>"
                    for i, (x, z) in enumerate(CORNERS))
    yield f'<surface class="Quad">{of}{bumps}{floor}</surface>'


def scene(side, of=None, light=POINT, filtered=0, mapped=False, bodies=None):
    bodies = bodies or "\n".join(surfaces(of or material("Phong"), mapped))
    return f"""<scene>
<camera><origin>0 5 9</origin><z>0 5 9</z><y>0 1 0</y><yfov>24</yfov>
<xResolution>{side}</xResolution><yResolution>{side}</yResolution></camera>
<lights>{light}</lights>
<textures>
<texture><file>colours.png</file><filter>{filtered}</filter></texture>
<texture><file>bumps.png</file><filter>{filtered}</filter></texture>
</textures>
<surfaces>
{bodies}
</surfaces>
</scene>
"""


def mesh(breakang):
    return (f'<surface class="Mesh">{material("Phong")}<filename>mesh.off</filename>'
            f"<position>0 0 0</position><size>3 3 3</size><breakang>{breakang}</breakang></surface>")


def write_pictures(side=512):
    def wave(x, y, k):
        return int(127 + 120 * math.sin(x * k / 20) * math.cos(y * (k + 1) / 23))
    for name, channels in (("colours", (1, 2, 3)), ("bumps", (4, 5, 0))):
        rgb = bytes(wave(x, y, k) for y in range(side) for x in range(side) for k in channels)
        with open(name + ".png", "wb") as file:
            file.write(png(side, side, rgb))


def write(scenes):
    for name, text in scenes.items():
        with open(name + ".xml", "w") as file:
            file.write(text)


def feature_scenes(side):
    write_pictures()
    displaced.write_mesh("mesh.off", 20)
    painted = "<texture>0</texture><tscale>3 3 0</tscale>"
    mirror = "<reflection>0.3 0.3 0.3</reflection>"
    glass = mirror + "<refraction>0.5 0.5 0.5</refraction><refractionCoef>1.3</refractionCoef>"
    write({
        "plain": scene(side),
        "texture": scene(side, material("Phong", painted)),
        "filter": scene(side, material("Phong", painted), filtered=1),
        "normal_map": scene(side, mapped=True),
        "textured": scene(side, material("Phong", painted), filtered=1, mapped=True),
        "mesh": scene(side, bodies=mesh(0)),
        "smooth": scene(side, bodies=mesh(1)),
        "reflection": scene(side, material("ShinyPhong", mirror)),
        "refraction": scene(side, material("RefractionShinyPhong", glass)),
        "area_3": scene(side, light=AREA.format(3)),
        "area_5": scene(side, light=AREA.format(5)),
    })


def unused_scenes(side):
    """{what: (scene, the same with a textured glass sphere behind the camera)}"""
    feature_scenes(side)
    glass = material("RefractionShinyPhong",
                     "<texture>0</texture><reflection>0.3 0.3 0.3</reflection>"
                     "<refraction>0.5 0.5 0.5</refraction><refractionCoef>1.3</refractionCoef>")
    unseen = (f'<surface class="Sphere">{glass}<bTexture>1</bTexture><position>0 5 40</position>'
              "<radius>1</radius></surface>\n</surfaces>")
    pairs = {}
    for name in ("plain", "mesh", "area_3"):
        with open(name + ".xml") as file:
            write({name + "_unseen": file.read().replace("</surfaces>", unseen)})
        pairs[name] = (name + ".xml", name + "_unseen.xml")
    return pairs
