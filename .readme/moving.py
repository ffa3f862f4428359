"""The picture that moves in the README: the explorer of notebook 03, its target on a circle.

    .venv/bin/python .readme/moving.py      (some minutes: every frame is drawn in software)

The solutions come from `ik.analytic`, the frames from `view.png`: nothing in it is staged.
"""

import io
from pathlib import Path

import numpy as np
from PIL import Image

from coursekit import robots, rotations, view

FRAMES, SIZE, SECONDS = 36, (640, 400), 4.0

robot = robots.kuka_kr6()
panel = view.explore_inverse(robot)
T = robot.fk(np.radians([0, -80, 110, 25, 45, 0]))  # in front of the arm, where the solutions stand apart
start = np.concatenate([T[:3, 3], rotations.zyx(T[:3, :3])])
pictures = []
for a in np.linspace(0, 2 * np.pi, FRAMES, endpoint=False):
    pose = start.copy()
    pose[1] += 0.18 * np.sin(a)
    pose[2] += 0.12 * np.cos(a)
    panel.set(pose=pose)
    pictures.append(Image.open(io.BytesIO(view.png(panel.scene, *SIZE))).convert("RGB"))
pictures[0].save(
    Path(__file__).with_name("moving.webp"),
    save_all=True,
    append_images=pictures[1:],
    duration=round(1000 * SECONDS / FRAMES),
    loop=0,
    quality=70,
    method=6,
)
