"""Notebook 06: the student's frames along the path, their attitudes, limits and speed."""

import numpy as np

from coursekit.kinematics import lie, path, rotations
from coursekit.view import text
from coursekit.view.chain import hinges
from coursekit.view.controls import Action
from coursekit.view.explorers import Explorer
from coursekit.view.sketch import COLOR, ZERO, Trouble, apart, gap, size

FRAMES = 13  # of the path that are drawn
SAMPLES = 51  # attitudes that are made again
BACK = 1e-7  # rad; of a turn near 0 half the digits are lost


class Path(Explorer):
    """Notebook 06: the student's frames along the path, their attitudes, limits and speed."""

    def _more(self):
        self.speed = None
        wanted = "largest_speed" in self.mine.functions
        return [Action("mine", "play at your speed", self._play)] if wanted else []

    def _is_ready(self, _name):
        return self.speed is not None

    def _tool_frames(self, sketch, _values):
        right = path.frames(self.points)
        mine = self.mine.ask("tool_frames", self.points, path.SPHERE_CENTER)
        if mine.shape != right.shape:
            raise Trouble(f"it returns {len(mine)} frames for {len(right)} points")
        distance, angle = apart(mine, right)
        some = np.linspace(0, len(mine) - 1, FRAMES).round().astype(int)
        drawn = [T for T in mine[some] if sketch.near(T[:3, 3]) and np.abs(T[:3, :3]).max() < 2]
        axes = 0.06 * self.scene.size * np.array([T[:3, :3].T for T in drawn]).reshape(-1, 3)
        origins = np.repeat([T[:3, 3] for T in drawn], 3, axis=0).reshape(-1, 3)
        self.scene.normals(f"{sketch.path}/frames", origins, axes, COLOR)
        off = np.flatnonzero(~((distance <= ZERO) & (angle <= ZERO)))
        if not off.size:
            return "every frame agrees, below 1e-9"
        k = off[0]
        first = f"the first is at point {k + 1}, by {gap(distance[k], angle[k])}"
        return f"{off.size} of {len(mine)} frames are off; {first}"

    def _zyx(self, sketch, _values):
        return self._attitudes(sketch, "zyx", rotations.from_zyx)

    def _angle_axis(self, sketch, _values):
        return self._attitudes(sketch, "angle_axis", lie.exp3)

    def _quaternion(self, sketch, _values):
        lengths = []

        def turn(q):
            lengths.append(np.linalg.norm(q))
            if lengths[-1] < 1e-9:
                raise Trouble("its quaternion has length 0")
            return rotations.from_quaternion(q / lengths[-1])

        told = self._attitudes(sketch, "quaternion", turn)
        long = next((x for x in lengths if abs(x - 1) > ZERO), None)
        return told if long is None else f"{told}; the length of a quaternion is {size(long)}, not 1"

    def _attitudes(self, sketch, name, back):
        """Attitudes along the path, made again from the student's numbers; that of this point is drawn."""
        right = path.frames(self.points)
        some = np.unique([*np.linspace(0, len(right) - 1, SAMPLES).round().astype(int), self.place])
        made = right[some].copy()
        for T in made:
            T[:3, :3] = back(self.mine.ask(name, T[:3, :3].copy()))
        angle, here = apart(made, right[some])[1], int(np.searchsorted(some, self.place))
        sketch.frame("attitude", made[here], self._label(sketch, angle[here] <= BACK))
        off = np.flatnonzero(angle > BACK)
        if not off.size:
            return "every attitude made again from your numbers: below 1e-7"
        at = here if here in off else off[0]
        told = f"at point {some[at] + 1} by {gap(0, angle[at])}"
        return f"{off.size} of {len(some)} attitudes made again from your numbers are off, {told}"

    def _label(self, sketch, agrees):
        """The name of an attitude. Those that agree lie upon each other and share one tick."""
        ticked = "yours \N{CHECK MARK}"
        named = [x["path"] for x in self.scene.labels if x["text"] == ticked]
        if agrees and any(not path.startswith(f"{sketch.path}/") for path in named):
            return ""
        return ticked if agrees else sketch.label

    def _slerp(self, sketch, _values):
        """Attitudes between those of the two ends; the one of this share of the way stands at this point."""
        frames = path.frames(self.points)
        first, last, here = frames[0, :3, :3], frames[-1, :3, :3], frames[self.place].copy()
        shares = np.append(np.linspace(0, 1, FRAMES), self.place / (len(frames) - 1))
        mine = np.array([self.mine.ask("slerp", first.copy(), last.copy(), float(t)) for t in shares])
        angle = np.linalg.norm(lie.log3(np.swapaxes(mine, -1, -2) @ lie.slerp(first, last, shares)), axis=-1)
        if np.abs(np.swapaxes(mine, -1, -2) @ mine - np.eye(3)).max() > 1e-6:
            raise Trouble("its columns are not three of length 1 at right angles")
        here[:3, :3] = mine[-1]
        sketch.frame("between", here, self._label(sketch, angle[-1] <= BACK))
        worst = int(angle.argmax())
        if angle[worst] <= BACK:
            return "every attitude between the two ends agrees, below 1e-7"
        return f"off by up to {gap(0, angle[worst])}, at t = {text.number(shares[worst], 2)}"

    def _next_on_branch(self, sketch, _values):
        """The student's steps along this way, begun some turns away, among all ways within half a turn."""
        turning = hinges(self.robot)
        turns = 2 * np.pi * np.resize([0, 1, -2], self.robot.n) * turning
        right = self.q[self.branch, : self.reached[self.branch]] + turns
        solutions = np.where(turning, np.angle(np.exp(1j * self.q)), self.q).swapaxes(0, 1)
        mine = right.copy()
        for i in range(1, len(mine)):
            mine[i] = self.mine.ask("next_on_branch", mine[i - 1].copy(), solutions[i].copy())
        off = np.flatnonzero(~(np.abs(mine - right) <= BACK).all(axis=1))
        sketch.marks("left", self.points[off])
        if not off.size:
            return f"your {len(mine) - 1} steps, begun whole turns away, keep to this way, below 1e-7"
        k = off[0]
        leap = np.abs(mine[k] - right[k])
        return f"at point {k + 1} you leave this way: joint {leap.argmax() + 1} leaps by {gap(0, leap.max())}"

    def _inside(self, sketch, _values):
        lower, upper = self.robot.q_min, self.robot.q_max
        if not np.isfinite([lower, upper]).all():
            raise Trouble(f"{self.robot.name} has a joint without limits")
        ways = np.flatnonzero(self.reached == len(self.points))
        q = self.q[ways].reshape(-1, self.robot.n)
        mine, right = self.mine.ask("inside", q, lower, upper), self.robot.within_limits(q)
        if mine.shape != right.shape:
            raise Trouble(f"it returns {len(mine)} verdicts for {len(right)} configurations")
        off = (mine != right).reshape(len(ways), -1)
        here = np.flatnonzero(off[list(ways).index(self.branch)]) if self.branch in ways else []
        sketch.marks("off", self.points[here])
        if not off.any():
            return f"all {len(q)} configurations of all ways judged rightly"
        which = ", ".join(self.names[ways[k]] for k in np.flatnonzero(off.any(axis=1))[:3])
        return f"{off.sum()} of {len(q)} configurations of all ways are off, first of: {which}"

    def _largest_speed(self, sketch, _values):
        self.speed, k = None, self.branch
        mine = float(self.mine.ask("largest_speed", self.q[k], self.points, self.bounds))
        right = self.limit.speed[k]
        if not mine > 0:
            raise Trouble(f"a speed of {mine:g} m/s leads nowhere")
        self.speed = mine
        self.scene.remove(f"{sketch.path}/worst")
        if abs(mine - right) <= ZERO * right:
            return f"{text.number(mine, 4)} m/s, below 1e-9 of the right one"
        if mine < right:
            return f"{text.number(mine, 4)} m/s: slower than the arm can, {text.number(right, 4)} m/s"
        joint, i = int(self.limit.joint[k]), int(self.limit.index[k])
        sketch.mark("worst", self.points[i], f"{sketch.label}: joint {joint + 1} too fast")
        times = text.number(mine / right, 2)
        return f"{text.number(mine, 4)} m/s: joint {joint + 1} turns {times} times too fast at point {i + 1}"

    def _play(self):
        share = 100 * np.abs(path.joint_rates(self.q[self.branch], self.points, self.speed) / self.bounds)
        texts = []
        for i in self.shown:
            use = share[min(i, len(share) - 1)]
            worst = f"joint {use.argmax() + 1} at {text.number(use.max(), 0)} percent of its bound"
            texts.append(f"point {i + 1} at your speed: {worst}")
        self._play_at(self.speed, texts)
