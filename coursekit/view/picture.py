"""A scene as a PNG, without a browser: what GitHub, nbconvert and a reader without WebGL see.

Its ground is left clear, so that it stands on a white page as on a dark one.

A small software renderer: every triangle is spread over the pixels of its bounding box, and at each pixel the
nearest wins. All triangles at once, in numpy.
"""

import importlib.util
import io
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFilter, ImageFont

from . import stage
from .camera import FOV
from .paint import PALETTE, channels, color
from .scene import Scene

KEY = np.array([0.8, -0.95, 1.9]) / np.linalg.norm([0.8, -0.95, 1.9])  # where the light comes from
INK = {"x": 0xC02F24, "y": 0x25783E, "z": 0x2558BD, "axis": 0x6A3FB0, "tick": 0x5B6675}
BAND = 128  # rows that are painted at once
FINER = 2  # pixels drawn per pixel kept, along each side
SHADES = 256  # colors in the file
LINE = 14  # pixels from one label to the next below it


def png(scene: Scene, width: int = 720, height: int = 440, view: str = "home") -> bytes:
    """The scene from one of its views as PNG bytes; the same scene gives the same bytes.

    Parameters
    ----------
    scene : Scene
    width, height : pixels
    view : "home", "top", "side" or "front"

    Examples
    --------
    >>> png(Scene(), 160, 120)[1:4]
    b'PNG'
    """
    eye = _Eye(scene.views[view], width * FINER, height * FINER)
    shown = [path for path in scene.parts if scene.visible(path)]
    worlds = scene.worlds(shown)
    drawn = cache(lambda path: [(part.mesh(coarse=True), part) for part in scene.parts[path]])
    things = [(mesh.moved(worlds[path]), part) for path in shown for mesh, part in drawn(path)]
    opaque = [thing for thing in things if thing[1].opacity == 1]
    solid = _Layer(eye, opaque, 1)
    clear = [_Layer(eye, [thing], thing[1].opacity, True) for thing in things if thing[1].opacity < 1]
    ghosts = [
        _Layer(eye, _copies(scene, ghost, drawn), ghost["opacity"])
        for ghost in scene.ghosts
        if ghost["shown"]
    ]
    # what shines through, faintly, even where hidden
    xrays = [
        _Layer(eye, [thing for thing in opaque if thing[1].xray == xray], xray)
        for xray in sorted({part.xray for _, part in opaque} - {0})
    ]
    ink = channels(PALETTE["grid"])
    grid, shadow = _ground(scene, eye, [mesh for mesh, part in opaque if part.casts])
    pixels = np.empty((eye.height, eye.width, 4), np.uint8)
    # in bands: a kernel in the browser keeps for ever the most memory that it once needed
    for start in range(0, eye.height, BAND):
        eye.rows = start, min(start + BAND, eye.height)
        rows = slice(*eye.rows)
        lines, shade = (part[rows].reshape(-1, 1) / 255 for part in (grid, 0.2 * shadow))
        canvas = np.hstack([(1 - shade) * lines * ink, lines + shade * (1 - lines)])  # times its opacity
        nothing_near = np.zeros(len(canvas))
        for ghost in ghosts:
            _paint(canvas, nothing_near, eye, ghost)
        near = _paint(canvas, nothing_near, eye, solid)
        for one in clear:
            _paint(canvas, near, eye, one)
        for seen_through in xrays:
            _paint(canvas, nothing_near, eye, seen_through)
        pixels[rows] = (np.clip(canvas, 0, 1) * 255).round().reshape(-1, eye.width, 4)
    image = Image.frombytes("RGBa", (eye.width, eye.height), pixels.tobytes())
    image = image.resize((width, height), Image.Resampling.BOX).convert("RGBA")
    _letter(image, scene, eye)
    return _packed(image)


def _packed(image):
    """PNG bytes of few colors, clear and half clear ones among them: most for what is faint."""
    image.putalpha(image.getchannel("A").point([round((255 * a) ** 0.5) for a in range(256)]))
    few = image.quantize(SHADES, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
    palette = np.reshape(few.getpalette("RGBA"), (-1, 4))
    palette[:, 3] = palette[:, 3] ** 2 // 255
    few.putpalette(palette.astype(np.uint8).tobytes(), "RGBA")
    file = io.BytesIO()
    few.save(file, "PNG")
    return file.getvalue()


class _Eye:
    """A pinhole camera: points in the space frame to pixels and nearness (1 / distance along the view)."""

    def __init__(self, stand, width, height):
        self.position = np.array(stand["position"])
        back = self.position - stand["target"]
        back /= np.linalg.norm(back)
        right = np.cross([0, 0, 1], back)
        right /= np.linalg.norm(right)
        self.axes = np.array([right, np.cross(back, right), -back])
        self.width, self.height = width, height
        self.rows = 0, height  # of pixels that are painted, from and to
        self.focus = height / 2 / np.tan(np.radians(FOV / 2))

    def project(self, points):
        x, y, away = self.axes @ (points - self.position).T
        away = np.maximum(away, 1e-6)
        return np.column_stack(
            [self.width / 2 + self.focus * x / away, self.height / 2 - self.focus * y / away]
        ), 1 / away


class _Layer:
    """(mesh, part) pairs that are painted at once: what is the same for every band of the picture."""

    def __init__(self, eye, things, opacity, both_sides=False):  # both sides: a plane has no inside
        things = list(things)
        meshes = [mesh for mesh, _ in things]
        vertices, faces = _together(meshes)
        self.pixel, self.nearness = eye.project(vertices)
        self.faces = _facing(self.pixel, faces, both_sides)
        height = self.pixel[self.faces, 1]
        self.top, self.bottom = height.min(axis=1), height.max(axis=1)
        self.normals = np.concatenate([np.empty((0, 3)), *(mesh.normals for mesh in meshes)])
        look = np.array([[*channels(color(part.color)), part.glow] for _, part in things]).reshape(-1, 4)
        self.look = np.repeat(look, [len(mesh.vertices) for mesh in meshes], axis=0)
        self.opacity = opacity


def _area(a, b, c):
    """Twice the area of triangles in pixels, corners (2, k) each; below 0 where we see the outside."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])  # pixels count downwards


def _facing(pixel, faces, both_sides=False):
    """The triangles of which we see the outside, or a side at all."""
    area = _area(*(pixel[faces[:, k]].T for k in range(3)))
    return faces[np.abs(area) > 1e-9 if both_sides else area < -1e-9]


def _rasterise(eye, pixel, nearness, faces):
    """What the triangles cover: pixel (m,), corners (m, 3), barycentric weights (m, 3), nearness (m,)."""
    (ax, ay), (bx, by), (cx, cy) = a, b, c = [pixel[faces[:, k]].T for k in range(3)]
    area = _area(a, b, c)
    # Row by row and not over the bounding box, huge for a thin rod that runs askew. Pixel centres lie at 0.5;
    # a span begins a pixel early and ends one late, and the weights decide.
    top, bottom = (f(f(ay, by), cy).clip(*eye.rows) for f in (np.minimum, np.maximum))
    face, y = _runs(np.ceil(top - 0.5).astype(int), np.ceil(bottom - 0.5).astype(int))
    left, right = np.full(len(face), np.inf), np.full(len(face), -np.inf)
    for px, py, qx, qy in ((ax, ay, bx, by), (bx, by, cx, cy), (cx, cy, ax, ay)):
        with np.errstate(divide="ignore", invalid="ignore"):  # an edge that is level crosses no row
            way = (y + 0.5 - py[face]) / (qy - py)[face]
        crosses = np.abs(way - 0.5) <= 0.5 + 1e-9
        x = px[face] + way * (qx - px)[face]
        left = np.minimum(left, np.where(crosses, x, np.inf))
        right = np.maximum(right, np.where(crosses, x, -np.inf))
    left, right = (edge.clip(0, eye.width) for edge in (left - 1.5, right + 1.5))
    row, x = _runs(np.ceil(left).astype(int), np.floor(right).astype(int))
    face, y = face[row], y[row]

    # how far a pixel is from the edge p q, as a part of the triangle's height there
    def weight(px, py, qx, qy):
        slope_x, slope_y = (py - qy) / area, (qx - px) / area
        return slope_x[face] * (x + 0.5) + slope_y[face] * (y + 0.5) - (slope_x * px + slope_y * py)[face]

    u, v = weight(bx, by, cx, cy), weight(cx, cy, ax, ay)
    inside = (u >= 0) & (v >= 0) & (u + v <= 1)
    u, v, at = u[inside], v[inside], ((y - eye.rows[0]) * eye.width + x)[inside]
    corners, weights = faces[face[inside]], np.column_stack([u, v, 1 - u - v])
    return at, corners, weights, np.einsum("ij,ij->i", weights, nearness[corners])


def _runs(start, end):
    """All whole numbers from start to end (exclusive) of each run: which run, and the number."""
    count = np.maximum(end - start, 0)
    run = np.repeat(np.arange(len(count)), count)
    return run, start[run] + np.arange(len(run)) - np.repeat(np.cumsum(count) - count, count)


def _paint(canvas, near, eye, layer):
    """Paint a layer onto the canvas where it is nearer than `near`; the new nearness."""
    faces = layer.faces[(layer.top < eye.rows[1]) & (layer.bottom > eye.rows[0])]
    if not len(faces):
        return near
    at, corners, weights, depth = _rasterise(eye, layer.pixel, layer.nearness, faces)
    nearest = near.copy()
    np.maximum.at(nearest, at, depth)
    seen = (depth >= nearest[at]) & (depth > near[at])
    at, corners, weights = at[seen], corners[seen], weights[seen]
    normal = np.einsum("ij,ijk->ik", weights, layer.normals[corners])
    paint = layer.look[corners[:, 0]]
    shown = _shade(paint[:, :3], normal, paint[:, 3], eye).clip(0, 1)
    paint = np.column_stack([shown, np.ones(len(at))])
    canvas[at] = (1 - layer.opacity) * canvas[at] + layer.opacity * paint
    return nearest


def _together(meshes):
    """All vertices and all faces of several meshes."""
    starts = np.cumsum([0] + [len(mesh.vertices) for mesh in meshes])
    faces = [mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]
    vertices = [np.empty((0, 3)), *(mesh.vertices for mesh in meshes)]
    return np.concatenate(vertices), np.concatenate([np.empty((0, 3), int), *faces])


def _shade(base, normal, glow, eye):
    """Color under one key light and a bright sky, on the side that is seen."""
    toward = np.sign(normal @ eye.axes[2])[:, None]
    normal = normal * np.where(toward > 0, -1, 1)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    key = np.clip(normal @ KEY, 0, 1)
    sky = 0.5 + 0.5 * normal[:, 2]
    light = 0.5 + 0.22 * sky + 0.45 * key
    half = KEY - eye.axes[2]
    gloss = 0.16 * np.clip(normal @ (half / np.linalg.norm(half)), 0, 1) ** 24
    light += (1 - np.minimum(light, 1)) * np.minimum(2 * glow, 1)
    return base * light[:, None] + gloss[:, None]


def _copies(scene, ghost, drawn):
    """The parts of a ghost, in its color; drawn: path -> [(mesh, part)]."""
    links = [f"{ghost['path']}/{k}" for k in range(1, ghost["n"] + 1)]
    for k, T in enumerate(scene.worlds(links).values(), 1):
        for mesh, part in drawn(f"{ghost['src']}/{k}/solid"):
            yield mesh.moved(T), replace(part, color=ghost["color"])


def _ground(scene, eye, casting):
    """How strong the grid is on the floor (rows, columns), and the shadow (rows, columns), both 0 to 255."""
    image = Image.new("L", (eye.width, eye.height))
    pen = ImageDraw.Draw(image)
    pieces, alpha = stage.grid_lines(scene.size, scene.floor)
    pixel, nearness = eye.project(pieces.reshape(-1, 3))
    ahead = (nearness.reshape(-1, 2) < 1e5).all(axis=1)
    for (a, b), strength, shown in zip(pixel.reshape(-1, 2, 2), alpha.mean(axis=1), ahead, strict=True):
        if shown:
            pen.line([*a, *b], fill=int(255 * strength), width=FINER)
    mask = np.zeros((eye.height, eye.width), np.uint8)
    if casting and eye.position[2] > scene.floor:
        points, faces = _together(casting)
        points = points - KEY * ((points[:, 2:] - scene.floor) / KEY[2])
        pixel, nearness = eye.project(points)
        mask.ravel()[_rasterise(eye, pixel, nearness, _facing(pixel, faces))[0]] = 255
    soft = Image.fromarray(mask).filter(ImageFilter.GaussianBlur(4 * FINER))
    return np.asarray(image), np.asarray(soft)


def _letter(image, scene, eye):
    """Labels with a halo of white, drawn last so that nothing hides them.

    Words give way to each other, downwards; the letters of axes and the scale of the grid, by not being
    there: the same rule as in the page (actors.js).
    """
    sheet = Image.new("RGBA", image.size, (255, 255, 255, 0))
    pen = ImageDraw.Draw(sheet)
    worlds = scene.worlds({label["path"] for label in scene.labels})
    taken = []  # x, y and width of what stands already, in pixels
    for label in sorted(scene.labels, key=_is_word, reverse=True):
        T = worlds[label["path"]]
        pixel, nearness = eye.project((T[:3, :3] @ label["pos"] + T[:3, 3])[None])
        if nearness[0] >= 1e5:  # behind the camera
            continue
        (x, y), font = pixel[0] / FINER, _font(12 if label["cls"] in ("tick", "note", "axis") else 14)
        wide = font.getlength(label["text"]) + 3

        def is_taken(x, y, wide):
            return any(abs(a - x) < (w + wide) / 2 and abs(b - y) < LINE for a, b, w in taken)

        while _is_word(label) and is_taken(x, y, wide):
            y += LINE
        if is_taken(x, y, wide):
            continue
        taken.append((x, y, wide))
        ink = f"#{INK.get(label['cls'], PALETTE['bone']):06x}"
        pen.text((x, y), label["text"], ink, font, anchor="mm", stroke_width=2, stroke_fill="white")
    image.alpha_composite(sheet)


def _is_word(label):
    return label["cls"] not in ("x", "y", "z", "tick")


@cache
def _font(size):
    """DejaVu Sans, which comes with matplotlib (found without importing it); else Pillow's own font."""
    found = importlib.util.find_spec("matplotlib")
    path = Path(found.origin).parent / "mpl-data/fonts/ttf/DejaVuSans-Bold.ttf" if found else None
    return ImageFont.truetype(str(path), size) if path and path.is_file() else ImageFont.load_default(size)
